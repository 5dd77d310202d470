#include "ros_control/ros_control_node.h"

#include <ros/console.h>
#include <ros/init.h>
#include <std_srvs/Empty.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace flexarm::ros_control {
namespace {

/// Longest wait before ros::ok() is checked again [s].
constexpr double kLongestPause = 0.1;
constexpr double kPeriodOfComplaints = 10;  ///< of warnings, wall time [s]

constexpr const char* kStepsPerCycle = "steps_per_cycle";

int read_steps_per_cycle(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue value(1);
  private_node.getParam(kStepsPerCycle, value);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt && static_cast<int>(value) >= 1) return static_cast<int>(value);
  throw node::ParameterError("parameters that cannot be used:\n" + private_node.resolveName(kStepsPerCycle) +
                             ": must be a whole number >= 1, got " + value.toXml());
}

SimulationOptions options_by(const node::Parameters& parameters) {
  SimulationOptions options;
  options.recovery_wall_time = parameters.recovery_wall_time;
  return options;
}

}  // namespace

RosControlNode::RosControlNode()
    : parameters_(node::read_parameters(private_node_)),
      steps_per_cycle_(read_steps_per_cycle(private_node_)),
      simulation_(node::read_scene(node_, private_node_), options_by(parameters_)),
      clock_(node_, run_, true, parameters_.clock_rate, simulation_.step_size(), 0),
      robot_(simulation_),
      manager_(&robot_, node_),
      loop_(robot_, steps_per_cycle_,
            [this](const ros::Time& time, const ros::Duration& period, bool restart) {
              manager_.update(time, period, restart);
            }),
      pacer_(loop_.period(), parameters_.real_time_factor, parameters_.max_catch_up) {
  run_.paused = parameters_.paused;
  node::warn_of_unknown_parameters(private_node_, {kStepsPerCycle});
  for (const scene::Diagnostic& warning : simulation_.start_warnings()) ROS_WARN_STREAM(warning.text());
  ROS_INFO("scene '%s': %zu joint coordinates; scheme %s, step %g s, control at %g Hz%s",
           simulation_.scene().name.c_str(), simulation_.coordinate_names().size(), simulation_.scheme().c_str(),
           simulation_.step_size(), 1 / loop_.period(), run_.paused ? "; paused" : "");
  advertise_services();
  clock_.publish_now();
}

void RosControlNode::advertise_services() {
  using Empty = std_srvs::Empty;
  ros::NodeHandle node("~");
  node.setCallbackQueue(&own_queue_);
  const auto advertise = [&](const char* name, const std::function<void()>& act) {
    services_.push_back(
        node.advertiseService<Empty::Request, Empty::Response>(name, [act](Empty::Request&, Empty::Response&) {
          act();
          return true;
        }));
  };
  advertise("pause", [this] {
    run_.paused = true;
    clock_.publish_now();
  });
  advertise("resume", [this] { resume(); });
  advertise("reset", [this] {
    loop_.reset();
    run_.failure.clear();
    ROS_INFO("reset");
  });
}

void RosControlNode::run() {
  last_look_ = std::chrono::steady_clock::now();
  double wait = 0;
  while (ros::ok()) {
    own_queue_.callAvailable(ros::WallDuration(wait));
    wait = cycle_if_due();
  }
}

double RosControlNode::cycle_if_due() {
  const auto now = std::chrono::steady_clock::now();
  const double passed = std::chrono::duration<double>(now - std::exchange(last_look_, now)).count();
  if (run_.paused) return kLongestPause;
  pacer_.elapse(passed);
  if (!pacer_.step_due()) return std::clamp(-pacer_.lateness(), 0.0, kLongestPause);
  if (pacer_.overruns() > run_.overruns)
    ROS_WARN_THROTTLE(kPeriodOfComplaints,
                      "slower than real_time_factor: %llu cycles dropped, simulated time lags behind",
                      static_cast<unsigned long long>(pacer_.overruns()));
  run_.overruns = pacer_.overruns();
  cycle();
  return 0;
}

void RosControlNode::cycle() {
  const StepResult result = loop_.cycle(*clock_.stamp());
  pacer_.step_done();
  if (loop_.steps_made() > 0 && !clock_.advance(static_cast<std::uint64_t>(loop_.steps_made()), 0, std::nullopt))
    ROS_WARN("ROS time was set back");
  if (!result.converged) fail(result);
}

void RosControlNode::fail(const StepResult& result) {
  run_.paused = true;
  run_.failure = "step from t = " + std::to_string(simulation_.time()) + " s failed: " + simulation_.explain(result);
  ROS_ERROR_STREAM(run_.failure << "; paused at the last good state: " << private_node_.resolveName("resume")
                                << " goes on from it, " << private_node_.resolveName("reset") << " starts again");
  clock_.publish_now();
}

void RosControlNode::resume() {
  if (!run_.paused) return;
  const bool has_failed = run_.failed();
  run_.paused = false;
  run_.failure.clear();
  pacer_.clear_backlog();
  if (!has_failed) return;
  // After a failure, the caller must learn whether a cycle succeeds this time.
  cycle();
  if (run_.failed()) throw std::runtime_error("not resumed: " + run_.failure);
}

}  // namespace flexarm::ros_control
