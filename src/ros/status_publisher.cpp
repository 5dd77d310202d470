#include "status_publisher.h"

#include <algorithm>
#include <cmath>

#include "advertise.h"
#include "flexarm/scene/scene_description.h"
#include "messages/conversions.h"

namespace flexarm::node {
namespace {

DurationStatistics statistics_of(const DurationHistogram& histogram) {
  DurationStatistics statistics;
  statistics.count = histogram.count();
  statistics.median = histogram.quantile(0.5);
  statistics.p99 = histogram.quantile(0.99);
  statistics.p999 = histogram.quantile(0.999);
  statistics.max = histogram.largest();
  return statistics;
}

}  // namespace

StatusPublisher::StatusPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run,
                                 double rate, const std::string& frame_prefix)
    : simulation_(simulation), run_(run), schedule_(rate), frame_prefix_(frame_prefix) {
  publisher_ = advertise<SimulatorStatus>(private_node, "status", 10, run, [this] { return make_message(); });
}

void StatusPublisher::publish(ros::Time stamp, bool force) {
  if (force) stamp = std::max(stamp, schedule_.last() + ros::Duration(0, 1));
  if (!schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  factor_ = real_time_factor_.measure(run_.simulated_time, RealTimeFactor::Clock::now(), run_.paused);
  publish_to_listeners(publisher_, [this] { return make_message(); });
}

SimulatorStatus StatusPublisher::make_message() const {
  const Energies energies = simulation_.energies();
  SimulatorStatus message;
  message.header.stamp = stamp_;
  message.header.frame_id = frame_prefix_ + simulation_.scene().root_link;
  message.time = simulation_.time();
  message.step = simulation_.step_size();
  message.steps = run_.steps;
  message.paused = run_.paused;
  message.failed = run_.failed();
  message.message = run_.failure;
  message.real_time_factor = factor_;
  message.overruns = run_.overruns;
  message.missed = run_.missed;
  message.step_time = statistics_of(run_.step_times);
  message.lateness = statistics_of(run_.lateness);
  message.scheme = simulation_.scheme();
  message.iterations = run_.last_step.iterations;
  const double estimate = run_.last_step.error_estimate;
  message.error_estimate = std::isnan(estimate) ? -1 : estimate;
  message.halvings = run_.counts.halvings;
  message.deepest_halving = run_.counts.deepest_halving;
  message.other_guesses = run_.counts.other_guesses;
  message.dissipated_steps = run_.counts.dissipated_steps;
  message.kinetic_energy = energies.kinetic;
  message.strain_energy = energies.strain;
  message.potential_energy = energies.potential;
  message.total_energy = energies.total();
  message.work = energies.work;
  message.dissipated = energies.dissipated;
  message.momentum = messages::to_vector3(simulation_.momentum());
  message.angular_momentum = messages::to_vector3(simulation_.angular_momentum());
  return message;
}

}  // namespace flexarm::node
