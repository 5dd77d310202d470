#include "services.h"

#include <stdexcept>

#include "node.h"

namespace flexarm::node {

constexpr std::uint32_t kMostSteps = 1000000;  ///< of one call: nothing else is served meanwhile

Services::Services(ros::NodeHandle& private_node, Node& simulator) : simulator_(simulator) {
  pause_server_ = private_node.advertiseService("pause", &Services::pause, this);
  resume_server_ = private_node.advertiseService("resume", &Services::resume, this);
  reset_server_ = private_node.advertiseService("reset", &Services::reset, this);
  step_server_ = private_node.advertiseService("step", &Services::step, this);
}

bool Services::pause(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator_.pause();
  return true;
}

bool Services::resume(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  // An exception's text reaches the caller, an answer without fields has no place for it.
  if (!simulator_.resume()) throw std::runtime_error("not resumed: " + simulator_.run().failure);
  return true;
}

bool Services::reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&) {
  simulator_.reset();
  return true;
}

bool Services::step(Step::Request& request, Step::Response& response) {
  if (!simulator_.run().paused) {
    response.message = "the simulation runs; pause it first";
  } else if (request.steps > kMostSteps) {
    response.message = "more than " + std::to_string(kMostSteps) + " steps at once";
  } else {
    response.success = simulator_.step(request.steps);
    if (!response.success) response.message = simulator_.run().failure;
  }
  response.time = simulator_.simulation().time();
  return true;
}

}  // namespace flexarm::node
