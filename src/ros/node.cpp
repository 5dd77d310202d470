#include "node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "flexarm/simulation/checkpoint.h"
#include "messages/scene_extent.h"

namespace flexarm::node {
namespace {

using SteadyClock = std::chrono::steady_clock;

const ros::WallDuration kTickPeriod(0.001);
/// A tick ends after this wall time even if more steps are due, so that commands and services get their turn.
constexpr std::chrono::milliseconds kTickBudget(10);
constexpr double kWarningPeriod = 10;  ///< of what goes on and on, wall time [s]

SimulationOptions simulation_options(const Parameters& parameters) {
  SimulationOptions options;
  options.recovery_wall_time = parameters.recovery_wall_time;
  return options;
}

}  // namespace

Node::Node()
    : parameters_(read_parameters(private_node_)),
      simulation_(read_scene(node_, private_node_), simulation_options(parameters_)),
      pacer_(simulation_.step_size(), parameters_.real_time_factor, parameters_.max_catch_up),
      last_tick_(SteadyClock::now()),
      clock_publisher_(node_, run_, parameters_.publish_clock, parameters_.clock_rate, simulation_.step_size()),
      state_publisher_(node_, simulation_, run_, parameters_.publish_rate, parameters_.frame_prefix),
      beam_state_publisher_(node_, simulation_, run_, parameters_.publish_rate, root_frame()),
      marker_publisher_(node_, simulation_, run_, parameters_.marker_rate, root_frame()),
      sensor_publisher_(node_, simulation_, run_, parameters_.frame_prefix),
      status_publisher_(private_node_, simulation_, run_, parameters_.status_rate, root_frame()),
      diagnostics_(node_, private_node_, simulation_, run_),
      command_interface_(
          node_, private_node_, simulation_,
          {[this] { return run_.simulated_time; }, [this](const ros::Time& stamp) { return simulated_time(stamp); },
           parameters_.command_timeout, parameters_.stop_duration}),
      wrenches_(simulation_),
      frame_watch_(node_, state_publisher_.frames()),
      services_(private_node_, *this) {
  for (const scene::Diagnostic& warning : simulation_.start_warnings()) ROS_WARN_STREAM(warning.text());
  run_.paused = parameters_.paused;
  ROS_INFO("scene '%s': %zu links, %zu joint coordinates, %zu degrees of freedom; scheme %s, step %g s%s",
           simulation_.scene().name.c_str(), simulation_.link_names().size(), simulation_.coordinate_names().size(),
           simulation_.degrees_of_freedom(), simulation_.scheme().c_str(), simulation_.step_size(),
           run_.paused ? "; paused" : "");
  describe_view();
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
    warn_if_slow();
  }
  diagnostics_.publish(false);
  clock_publisher_.warn_if_missing();
}

bool Node::advance() {
  command_interface_.begin_step();
  wrenches_.update(run_.simulated_time);
  const SteadyClock::time_point start = SteadyClock::now();
  const StepResult result = simulation_.step();
  slowest_step_.note(std::chrono::duration<double>(SteadyClock::now() - start).count(), simulation_.time(), result);
  run_.last_step = result;
  run_.counts.add(result);
  if (!result.converged) {
    fail(result);
    return false;
  }
  if (result.is_dissipated)
    ROS_WARN_THROTTLE(kWarningPeriod,
                      "the step to t = %g s was done by edmc2, as on_failure allows: %s could not do it",
                      simulation_.time(), simulation_.scheme().c_str());
  run_.failure.clear();
  ++run_.steps;
  run_.simulated_time = static_cast<double>(run_.steps) * simulation_.step_size();
  command_interface_.end_step();
  clock_publisher_.advance();
  publish(false);
  return true;
}

void Node::SlowestStep::note(double new_seconds, double new_time, const StepResult& result) {
  if (new_seconds <= seconds) return;
  seconds = new_seconds;
  time = new_time;
  counts = {};
  counts.add(result);
}

void Node::warn_if_slow() {
  if (run_.overruns == warned_overruns_) return;
  const SteadyClock::time_point now = SteadyClock::now();
  if (warned_overruns_ > 0 && std::chrono::duration<double>(now - last_warning_).count() < kWarningPeriod) return;
  const std::string recoveries = recoveries_text(slowest_step_.counts);
  ROS_WARN(
      "slower than asked for, simulated time lags: %lu steps of %g s dropped; the slowest one took %.2g s, to "
      "t = %g s: %s",
      run_.overruns - warned_overruns_, simulation_.step_size(), slowest_step_.seconds, slowest_step_.time,
      recoveries.empty() ? "the scene is too large, or the processor busy" : recoveries.c_str());
  warned_overruns_ = run_.overruns;
  last_warning_ = now;
  slowest_step_ = {};
}

void Node::fail(const StepResult& result) {
  run_.paused = true;
  run_.failure = "step from t = " + std::to_string(simulation_.time()) + " s failed: " + simulation_.explain(result);
  ROS_ERROR_STREAM(run_.failure << "; paused at the last good state: " << private_node_.resolveName("resume")
                                << " goes on from it, " << private_node_.resolveName("reset") << " starts again");
  clock_publisher_.advance();  // the last good sub-step may be news, and news need a stamp of their own
  publish(true);
  diagnostics_.publish(true);
}

void Node::describe_view() const {
  const messages::SceneExtent extent = messages::scene_extent(simulation_);
  private_node_.setParam("view/frame", root_frame());
  private_node_.setParam("view/center", std::vector<double>{extent.center.x(), extent.center.y(), extent.center.z()});
  private_node_.setParam("view/radius", extent.radius);
}

void Node::publish(bool force) {
  if (force) clock_publisher_.publish_now();
  const std::optional<ros::Time> stamp = clock_publisher_.stamp();
  if (!stamp) return;
  state_publisher_.publish(*stamp, force);
  beam_state_publisher_.publish(*stamp, force);
  marker_publisher_.publish(*stamp, force);
  sensor_publisher_.publish(*stamp);
  status_publisher_.publish(*stamp, force);
}

void Node::pause() {
  if (run_.paused) return;
  run_.paused = true;
  ROS_INFO("paused at t = %g s", simulation_.time());
  publish(true);
}

bool Node::resume() {
  if (!run_.paused) return true;
  // Who resumes after a failure is told whether the step works now.
  if (run_.failed() && !advance()) return false;
  run_.paused = false;
  pacer_.clear_backlog();
  ROS_INFO("resumed at t = %g s", simulation_.time());
  publish(true);
  return true;
}

void Node::reset() {
  simulation_.reset();
  ROS_INFO("reset");
  begin_anew();
}

void Node::load_state(const std::string& file) {
  read_checkpoint(simulation_, file);
  ROS_INFO("at t = %g s, from '%s'", simulation_.time(), file.c_str());
  begin_anew();
}

void Node::set_joint_state(const std::vector<CoordinateState>& coordinates) {
  simulation_.set_joint_state(coordinates);
  show_new_state();
}

void Node::begin_anew() {
  command_interface_.forget_commands();
  wrenches_.clear();
  marker_publisher_.forget_largest_strain();
  show_new_state();
}

void Node::show_new_state() {
  run_.failure.clear();
  run_.last_step = {};
  pacer_.clear_backlog();
  clock_publisher_.advance();  // the new state is news, too
  publish(true);
}

double Node::simulated_time(const ros::Time& stamp) const {
  return run_.simulated_time + (stamp - clock_publisher_.stamp().value_or(stamp)).toSec();
}

void Node::apply_wrench(const AppliedWrench& wrench, const ros::Time& start, double duration) {
  if (duration == 0) return;
  const double begin = std::max(simulated_time(start), run_.simulated_time);
  const double end =
      duration < 0 ? std::numeric_limits<double>::infinity() : begin + std::max(duration, simulation_.step_size());
  wrenches_.add(wrench, begin, end);
}

bool Node::step(std::uint32_t steps) {
  for (std::uint32_t made = 0; made < steps && ros::ok(); ++made) {
    if (!advance()) return false;
  }
  publish(true);
  return true;
}

}  // namespace flexarm::node
