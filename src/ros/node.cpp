#include "node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "announcement.h"
#include "flexarm/simulation/checkpoint.h"
#include "pictures/scene_extent.h"

namespace flexarm::node {
namespace {

const ros::WallDuration kTickPeriod(0.1);
/// Wait before /clock is set back. Subscribers that clear their transforms when the clock jumps back must not get older
/// messages after that.
const ros::WallDuration kWayOfMessages(0.1);
constexpr double kWarningPeriod = 10;  ///< of warnings that repeat, wall time [s]

SimulationOptions simulation_options(const Parameters& parameters) {
  SimulationOptions options;
  options.recovery_wall_time = parameters.recovery_wall_time;
  return options;
}

Pace pace(const Parameters& parameters) {
  return {parameters.real_time_factor, parameters.max_catch_up, parameters.lock_step, parameters.realtime,
          parameters.error_window};
}

/// Wall time from one step to the next [s]; 0: steps do not follow the wall clock.
double period(double step, const Parameters& parameters) {
  return parameters.real_time_factor > 0 ? step / parameters.real_time_factor : 0;
}

}  // namespace

Node::Node()
    : parameters_(read_parameters(private_node_)),
      shown_(read_scene(node_, private_node_), simulation_options(parameters_)),
      clock_publisher_(node_, run_, parameters_.publish_clock, parameters_.clock_rate, shown_.step_size(),
                       period(shown_.step_size(), parameters_)),
      state_publisher_(node_, shown_, run_, parameters_.publish_rate, parameters_.frame_prefix),
      beam_state_publisher_(node_, shown_, run_, parameters_.publish_rate, parameters_.frame_prefix),
      contact_publisher_(private_node_, shown_, run_, parameters_.publish_rate, parameters_.frame_prefix),
      marker_publisher_(node_, shown_, run_, parameters_.marker_rate, parameters_.frame_prefix, parameters_.markers),
      sensor_publisher_(node_, shown_, run_, parameters_.frame_prefix),
      status_publisher_(private_node_, shown_, run_, parameters_.status_rate, parameters_.frame_prefix),
      diagnostics_(node_, private_node_, shown_, run_),
      bell_([this] { take_reports(); }),
      stepping_(shown_.copy(), pace(parameters_), [this] { bell_.ring(); }),
      command_interface_(node_, private_node_, shown_, stepping_,
                         {[this](const ros::Time& stamp) { return simulated_time(stamp); }, parameters_.command_timeout,
                          parameters_.stop_duration}),
      frame_watch_(node_, state_publisher_.frames()),
      handle_schedule_(parameters_.marker_rate),
      services_(private_node_, *this),
      reconfiguration_(private_node_, *this),
      master_watch_(service_names()) {
  run_.paused = parameters_.paused;
  run_.lock_step = parameters_.lock_step;
  warn_of_unknown_parameters(private_node_);
  announce();
  advise_controllers(shown_);
  if (parameters_.error_window > 0 && !stepping_.estimates_errors())
    ROS_WARN(
        "~error_window: no error is estimated, since steps of twice the length do not meet the sample times of "
        "servos");
  web_publisher_ = serve_page(shown_, parameters_, private_node_.getNamespace());
  if (parameters_.realtime) be_real_time();
  if (parameters_.interactive) be_interactive();
  describe_view();
  publish_news();
  timer_ = node_.createSteadyTimer(kTickPeriod, [this](const ros::SteadyTimerEvent&) { tick(); });
  if (!run_.paused) stepping_.run(true);
}

void Node::announce() const {
  say_what_is_simulated(shown_, run_, node_.getNamespace(), private_node_.getNamespace());
}

void Node::be_real_time() {
  const std::string refused = stepping_.make_real_time();
  if (refused.empty()) return;
  ROS_WARN_STREAM("~realtime: the system refuses " << refused << ". Steps may begin late where the processor is busy; "
                                                   << "limits 'rtprio' and 'memlock' of this user "
                                                   << "(/etc/security/limits.conf), or CAP_SYS_NICE and CAP_IPC_LOCK, "
                                                   << "allow it");
}

std::vector<std::string> Node::service_names() const {
  std::vector<std::string> names = services_.names();
  for (const char* of_roscpp : {"get_loggers", "set_logger_level"})
    names.push_back(private_node_.resolveName(of_roscpp));
  names.push_back(reconfiguration_.service());
  return names;
}

void Node::be_interactive() {
  const double mass = shown_.mass();
  // Default: the whole mass on this spring has 0.5 Hz and half of the critical damping.
  const auto given_or = [](double given, double fallback) { return given > 0 ? given : fallback; };
  const PullHandles::Spring spring{given_or(parameters_.pull_stiffness, M_PI * M_PI * mass),
                                   given_or(parameters_.pull_damping, M_PI * mass)};
  const std::string root_frame = parameters_.frame_prefix + shown_.scene().root_link;
  pull_handles_.emplace(private_node_, shown_, root_frame, spring, [this](const std::vector<AppliedWrench>& pulls) {
    try {
      stepping_.between_steps([&](Simulation&) { stepping_.wrenches().set_pulls(pulls); });
    } catch (const std::invalid_argument& error) {
      ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "cannot pull: " << error.what());
    }
  });
}

void Node::tick() {
  take_reports();
  if (web_publisher_) web_publisher_->tick();
  if (pull_handles_) pull_handles_->let_go_of_lost();
  if (!run_.paused) slowness_.warn_if_slow(shown_.step_size());
  diagnostics_.publish(false);
  clock_publisher_.warn_if_missing();
  if (master_watch_.has_come_back()) describe_view();
}

void Node::take_reports() {
  SpscRing<StepReport>& reports = stepping_.reports();
  for (std::size_t waiting = reports.size(); waiting > 0; --waiting) {
    take(reports.front());
    reports.pop();
  }
  if (!reports.empty()) bell_.ring();  // other callbacks come first
}

void Node::take(const StepReport& report) {
  shown_.restore(report.state);
  run_.last_step = report.result;
  run_.counts.add(report.result);
  run_.overruns = report.overruns;
  run_.step_times.add(report.duration);
  if (report.due) run_.lateness.add(report.lateness);
  slowness_.note(report.duration, shown_.time(), report.result);
  if (report.has_failed) return fail(report.result);
  warn_of_recoveries(report);
  run_.failure.clear();
  if (report.steps > run_.steps + 1) run_.missed += report.steps - run_.steps - 1;
  const std::uint64_t made = report.steps - run_.steps;
  run_.steps = report.steps;
  run_.simulated_time = report.time;
  command_interface_.judge_goals(run_.simulated_time);
  advance_clock(made, report.overruns, report.due);
  publish(false);
}

void Node::warn_of_recoveries(const StepReport& report) {
  if (report.result.is_dissipated)
    ROS_WARN_THROTTLE(kWarningPeriod, "the step to t = %g s was made by edmc2, as on_failure allows: scheme %s failed",
                      shown_.time(), shown_.scheme().c_str());
  if (report.result.converged) return;
  ++run_.cut;
  ROS_WARN_THROTTLE(kWarningPeriod,
                    "only a part of the step to t = %g s was made in time, and simulated time lags behind: %s",
                    shown_.time(), shown_.explain(report.result).c_str());
}

bool Node::advance() {
  const bool is_done = stepping_.advance();
  take_reports();
  return is_done;
}

void Node::fail(const StepResult& result) {
  stepping_.note_failure();
  run_.paused = true;
  run_.failure = "step from t = " + std::to_string(shown_.time()) + " s failed: " + shown_.explain(result);
  ROS_ERROR_STREAM(run_.failure << "; paused at the last good state: " << private_node_.resolveName("resume")
                                << " goes on from it, " << private_node_.resolveName("reset") << " starts again");
  publish_news();  // the failed step may have made good sub-steps, whose state is new
  diagnostics_.publish(true);
}

void Node::describe_view() const {
  const pictures::SceneExtent extent = pictures::scene_extent(shown_);
  private_node_.setParam("view/frame", parameters_.frame_prefix + shown_.scene().root_link);
  private_node_.setParam("view/center", std::vector<double>{extent.center.x(), extent.center.y(), extent.center.z()});
  private_node_.setParam("view/radius", extent.radius);
}

void Node::publish(bool force) {
  if (force) clock_publisher_.publish_now();
  const std::optional<ros::Time> stamp = clock_publisher_.stamp();
  if (!stamp) return;
  state_publisher_.publish(*stamp, force || run_.lock_step);  // in lock step the commander waits for each state
  beam_state_publisher_.publish(*stamp, force);
  contact_publisher_.publish(*stamp, force);
  marker_publisher_.publish(*stamp, force);
  if (pull_handles_ && handle_schedule_.due(*stamp, force)) pull_handles_->follow();
  sensor_publisher_.publish(*stamp);
  status_publisher_.publish(*stamp, force);
  if (web_publisher_) web_publisher_->publish();
}

void Node::advance_clock(std::uint64_t steps, std::uint64_t overruns, std::optional<ClockPublisher::WallTime> due) {
  if (clock_publisher_.advance(steps, overruns, due)) return;
  ROS_WARN("ROS time was set back, to %.9g s: stamps continue from there", clock_publisher_.stamp()->toSec());
  set_rates();
}

void Node::publish_news() {
  advance_clock(1, run_.overruns, std::nullopt);  // news need a new stamp
  publish(true);
}

void Node::set_rates() {
  state_publisher_.set_rate(parameters_.publish_rate);
  beam_state_publisher_.set_rate(parameters_.publish_rate);
  contact_publisher_.set_rate(parameters_.publish_rate);
  marker_publisher_.set_rate(parameters_.marker_rate);
  handle_schedule_ = PublicationSchedule(parameters_.marker_rate);
  status_publisher_.set_rate(parameters_.status_rate);
}

void Node::set_pace() {
  stepping_.set_pace(pace(parameters_));
  clock_publisher_.set_pace(shown_.step_size(), period(shown_.step_size(), parameters_));
}

void Node::pause() {
  ++pauses_;
  stepping_.halt();
  take_reports();
  if (run_.paused) return;
  run_.paused = true;
  ROS_INFO("paused at t = %g s", shown_.time());
  publish(true);
}

bool Node::resume() {
  if (!run_.paused) return true;
  // After a failure, the caller must learn whether the step succeeds this time.
  if (run_.failed() && !advance()) return false;
  run_.paused = false;
  run_.step_times.clear();
  run_.lateness.clear();
  clock_publisher_.restart();
  ROS_INFO("resumed at t = %g s", shown_.time());
  publish(true);
  stepping_.run(true);
  return true;
}

void Node::show() {
  stepping_.simulation().snapshot(snapshot_);
  shown_.restore(snapshot_);
}

void Node::catch_up() {
  stepping_.between_steps([this](Simulation&) {
    take_reports();
    show();
  });
}

void Node::reset() {
  stepping_.between_steps([this](Simulation& simulation) {
    take_reports();
    simulation.reset();
    ROS_INFO("reset");
    begin_anew();
  });
}

std::string Node::reset_with_clock() {
  if (!clock_publisher_.is_clock())
    return "this node cannot set ROS time back, since it does not publish /clock (~publish_clock)";
  stepping_.between_steps([this](Simulation& simulation) {
    take_reports();
    simulation.reset();
    ROS_INFO("reset, and /clock set back");
    kWayOfMessages.sleep();
    clock_publisher_.begin_anew();
    set_rates();
    begin_anew();
  });
  return {};
}

void Node::adopt_scene() {
  shown_ = stepping_.simulation().copy();
  set_pace();
  state_publisher_.adopt_scene();
  contact_publisher_.adopt_scene();
  marker_publisher_.adopt_scene();
  if (web_publisher_) web_publisher_->adopt_scene();
  sensor_publisher_.adopt_scene();
  command_interface_.adopt_scene();
  frame_watch_.watch(state_publisher_.frames());
  if (parameters_.interactive) be_interactive();
  describe_view();
}

void Node::reload() {
  Simulation other(read_scene(node_, private_node_),
                   simulation_options(parameters_));  // the old simulation goes on stepping meanwhile
  stepping_.between_steps([&](Simulation&) {
    take_reports();
    stepping_.begin_with(std::move(other));
    adopt_scene();
    announce();
    begin_anew();
  });
  advise_controllers(shown_);
  reconfiguration_.describe();
}

void Node::edit(const std::function<void(Simulation&)>& edit) {
  stepping_.between_steps([&](Simulation& running) {
    take_reports();
    Simulation edited = running.copy();
    edit(edited);
    const Renumbering places(running, edited);
    command_interface_.renumber(places);
    stepping_.go_on_with_scene(std::move(edited), places);
    adopt_scene();
    show_new_state();
  });
  announce();
  reconfiguration_.describe();
}

void Node::change(std::optional<scene::SceneDescription> scene, const Parameters& parameters) {
  std::optional<Simulation> changed;
  if (scene)
    changed.emplace(*std::move(scene),
                    simulation_options(parameters));  // the old simulation goes on stepping meanwhile
  stepping_.between_steps([&](Simulation& running) {
    take_reports();
    if (changed) {
      changed->take_over(running);
      stepping_.go_on_with(*std::move(changed));
      shown_ = running.copy();
      if (web_publisher_) web_publisher_->adopt_scene();
    }
    parameters_ = parameters;
    set_pace();
    set_rates();
    publish_news();
  });
}

void Node::load_state(const std::string& file) {
  stepping_.between_steps([&](Simulation& simulation) {
    take_reports();
    read_checkpoint(simulation, file);
    ROS_INFO("loaded the state at t = %g s from '%s'", simulation.time(), file.c_str());
    begin_anew();
  });
}

void Node::set_joint_state(const std::vector<CoordinateState>& coordinates) {
  stepping_.between_steps([&](Simulation& simulation) {
    take_reports();
    simulation.set_joint_state(coordinates);
    show_new_state();
  });
}

std::string Node::switch_mode(const std::vector<std::string>& names, const std::vector<std::string>& modes) {
  std::string fault;
  stepping_.between_steps([&](Simulation& simulation) {
    take_reports();
    fault = command_interface_.switch_mode(simulation, names, modes);
    show();
  });
  return fault;
}

void Node::begin_anew() {
  command_interface_.forget_commands();
  clear_wrenches();
  marker_publisher_.begin_anew();
  if (web_publisher_) web_publisher_->begin_anew();
  show_new_state();
}

void Node::show_new_state() {
  show();
  run_.failure.clear();
  run_.last_step = {};
  publish_news();
}

double Node::simulated_time(const ros::Time& stamp) const {
  const double ahead = (stamp - clock_publisher_.stamp().value_or(stamp)).toSec();
  return run_.simulated_time + pace(parameters_).per_stamp(clock_publisher_.is_clock()) * ahead;
}

void Node::apply_wrench(const AppliedWrench& wrench, const ros::Time& start, double duration) {
  if (duration == 0) return;
  stepping_.between_steps([&](Simulation& simulation) {
    take_reports();
    const double begin = std::max(simulated_time(start), run_.simulated_time);
    const double end =
        duration < 0 ? std::numeric_limits<double>::infinity() : begin + std::max(duration, simulation.step_size());
    stepping_.wrenches().add(wrench, begin, end);
  });
}

void Node::clear_wrenches() {
  stepping_.between_steps([this](Simulation&) { stepping_.wrenches().clear(); });
  if (pull_handles_) pull_handles_->forget();
}

}  // namespace flexarm::node
