#include "node.h"

#include <ros/console.h>
#include <ros/init.h>

namespace flexarm::node {
namespace {

using SteadyClock = std::chrono::steady_clock;

const ros::WallDuration kTickPeriod(0.001);
/// A tick ends after this wall time even if more steps are due, so that commands and services get their turn.
constexpr std::chrono::milliseconds kTickBudget(10);

}  // namespace

Node::Node()
    : parameters_(read_parameters(private_node_)),
      simulation_(read_scene(node_, private_node_)),
      pacer_(simulation_.step_size(), parameters_.real_time_factor, parameters_.max_catch_up),
      last_tick_(SteadyClock::now()),
      clock_publisher_(node_, run_, parameters_.publish_clock, parameters_.clock_rate, simulation_.step_size()),
      state_publisher_(node_, simulation_, run_, parameters_.publish_rate),
      beam_state_publisher_(node_, simulation_, run_, parameters_.publish_rate),
      marker_publisher_(node_, simulation_, run_, parameters_.marker_rate),
      status_publisher_(private_node_, simulation_, run_, parameters_.status_rate),
      diagnostics_(node_, private_node_, simulation_, run_),
      command_interface_(node_, private_node_, simulation_, parameters_.command_timeout),
      services_(private_node_, *this) {
  run_.paused = parameters_.paused;
  ROS_INFO("scene '%s': %zu links, %zu joint coordinates, %zu degrees of freedom; scheme %s, step %g s%s",
           simulation_.scene().name.c_str(), simulation_.link_names().size(), simulation_.coordinate_names().size(),
           simulation_.degrees_of_freedom(), simulation_.scheme().c_str(), simulation_.step_size(),
           run_.paused ? "; paused" : "");
  publish(true);
  timer_ = node_.createSteadyTimer(kTickPeriod, [this](const ros::SteadyTimerEvent&) { tick(); });
}

void Node::tick() {
  const SteadyClock::time_point now = SteadyClock::now();
  const double elapsed = std::chrono::duration<double>(now - last_tick_).count();
  last_tick_ = now;
  if (!run_.paused) {
    pacer_.elapse(elapsed);
    run_.overruns = pacer_.overruns();
    while (pacer_.step_due() && SteadyClock::now() - now < kTickBudget) {
      if (!advance()) break;
      pacer_.step_done();
    }
  }
  diagnostics_.publish(false);
}

bool Node::advance() {
  command_interface_.expire(run_.simulated_time);
  const StepResult result = simulation_.step();
  run_.last_step = result;
  if (!result.converged) {
    fail(result);
    return false;
  }
  ++run_.steps;
  run_.halvings += static_cast<std::uint64_t>(result.halvings);
  run_.simulated_time = static_cast<double>(run_.steps) * simulation_.step_size();
  clock_publisher_.advance();
  publish(false);
  return true;
}

void Node::fail(const StepResult& result) {
  run_.paused = true;
  run_.failure = "step from t = " + std::to_string(simulation_.time()) + " s failed: " + to_string(result.reason) +
                 " after " + std::to_string(result.iterations) + " iterations and " + std::to_string(result.halvings) +
                 " halvings";
  ROS_ERROR_STREAM(run_.failure << "; paused, the last good state is kept; " << private_node_.resolveName("reset")
                                << " starts again");
  publish(true);
  diagnostics_.publish(true);
}

void Node::publish(bool force) {
  if (force) clock_publisher_.publish_now();
  const std::optional<ros::Time> stamp = clock_publisher_.stamp();
  if (!stamp) return;
  state_publisher_.publish(*stamp, force);
  beam_state_publisher_.publish(*stamp, force);
  marker_publisher_.publish(*stamp, force);
  status_publisher_.publish(*stamp, force);
}

void Node::pause() {
  if (run_.paused) return;
  run_.paused = true;
  ROS_INFO("paused at t = %g s", simulation_.time());
  publish(true);
}

bool Node::resume() {
  if (run_.failed()) {
    ROS_WARN_STREAM("not resumed: " << run_.failure << "; call " << private_node_.resolveName("reset") << " first");
    return false;
  }
  if (!run_.paused) return true;
  run_.paused = false;
  pacer_.clear_backlog();
  ROS_INFO("resumed at t = %g s", simulation_.time());
  publish(true);
  return true;
}

void Node::reset() {
  simulation_.reset();
  command_interface_.forget_commands();
  run_.failure.clear();
  run_.last_step = {};
  pacer_.clear_backlog();
  ROS_INFO("reset");
  clock_publisher_.advance();  // the initial state is news, and news need a stamp of their own
  publish(true);
}

bool Node::step(std::uint32_t steps) {
  if (run_.failed()) return false;
  for (std::uint32_t made = 0; made < steps && ros::ok(); ++made) {
    if (!advance()) return false;
  }
  publish(true);
  return true;
}

}  // namespace flexarm::node
