#include "diagnostics.h"

#include <diagnostic_updater/diagnostic_updater.h>

#include <utility>

namespace flexarm::node {

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const Simulation& simulation,
                         const RunState& run)
    : report_(simulation, run), updater_(std::make_unique<diagnostic_updater::Updater>(node, private_node)) {
  updater_->setHardwareID("none");
  updater_->add("simulation", [this](diagnostic_updater::DiagnosticStatusWrapper& status) { report_.write(status); });
}

Diagnostics::~Diagnostics() = default;

void Diagnostics::publish(bool force) {
  const ros::Time now = ros::Time::now();
  const bool is_set_back = now < std::exchange(last_time_, now);  // the updater would wait until it is that late again
  if (force || is_set_back) {
    updater_->force_update();
  } else {
    updater_->update();
  }
}

}  // namespace flexarm::node
