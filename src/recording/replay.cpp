#include "recording/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>

#include <flexarm/JointForceCommand.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <fmt/format.h>

#include "stepping/command_reader.h"
#include "stepping/stepping_thread.h"

namespace flexarm::recording {
namespace {

using node::Command;
using node::Commanded;
using rosbag::MessageInstance;

/// Pace of the recorded run.
node::Pace pace_of(const ReplayOptions& options) {
  node::Pace pace;
  pace.lock_step = options.lock_step;
  pace.real_time_factor = options.real_time_factor;
  return pace;
}

/// For each command of a bag: by how many steps it acts later than at its recorded time. Empty: none does.
using Shifts = std::vector<int>;

/// Processes messages like the node, but without a clock: it steps to the times of the states in the bag.
class Replay {
 public:
  Replay(Simulation simulation, const ReplayOptions& options, Shifts shifts = {})
      : options_(options),
        shifts_(std::move(shifts)),
        thread_(std::move(simulation), pace_of(options), [] {}),
        reader_(thread_.simulation(), options.command_timeout) {
    for (const std::string& name : thread_.simulation().coordinate_names()) {
      report_.joints.push_back({name});
      topics_["/" + name + "/command"] = topics_["/" + name + "/set_point"] = name;
    }
  }

  ReplayReport run(const rosbag::Bag& bag) {
    std::vector<MessageInstance> commands;
    rosbag::View view(bag);
    for (const MessageInstance& message : view) {
      const std::string topic = own(message.getTopic());
      if (message.getTopic() == "/clock") has_clock_ = true;
      if (topic == "/joint_states") {
        states_.push_back(read<sensor_msgs::JointState>(message));
        arrivals_.push_back(message.getTime());
      } else if (is_command(topic))
        commands.push_back(message);
    }
    for (const MessageInstance& command : commands) command_times_.push_back(command.getTime());
    if (states_.empty()) fail("has no message on '" + options_.ns + "/joint_states'");
    find_begin();
    if (options_.lock_step)
      step_by(commands);
    else
      step_until(commands);
    report_.steps = static_cast<long>(steps_);
    return report_;
  }

  /// After run(): positions of all coordinates, for one state after the other.
  const std::vector<double>& positions() const { return positions_; }
  /// The same positions as recorded in the bag; NaN if missing.
  const std::vector<double>& recorded() const { return recorded_; }
  const std::vector<double>& times() const { return times_; }
  /// After run(): for each command, by how many steps it may have acted earlier because the run was late. The delay of
  /// a state is its arrival time minus its stamp; lateness is the delay minus the smallest delay of all states.
  std::vector<int> lateness() const {
    std::vector<double> delays;
    for (std::size_t i = 0; i < states_.size(); ++i)
      delays.push_back((arrivals_[i] - states_[i]->header.stamp).toSec());
    const double least = *std::min_element(delays.begin(), delays.end());
    if (was_paused_) delays.front() = least;
    std::vector<int> out;
    for (const ros::Time& time : command_times_) {
      const auto next = std::lower_bound(arrivals_.begin(), arrivals_.end(), time) - arrivals_.begin();
      double late = 0;
      for (auto i = std::max<std::ptrdiff_t>(next - 2, 0); i < next + 2 && i < std::ptrdiff_t(delays.size()); ++i)
        late = std::max(late, delays[static_cast<std::size_t>(i)] - least);
      out.push_back(static_cast<int>(std::ceil(std::min(late / period_, kMostLate))));
    }
    return out;
  }

 private:
  static constexpr double kMostLate = 1e6;  // steps
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("bag '" + options_.bag + "': " + what);
  }
  template <class Message>
  boost::shared_ptr<Message> read(const MessageInstance& message) const {
    const boost::shared_ptr<Message> out = message.instantiate<Message>();
    if (!out)
      fail(fmt::format("'{}' has type {}, expected {}", message.getTopic(), message.getDataType(),
                       ros::message_traits::datatype<Message>()));
    return out;
  }
  /// The topic without the namespace; empty if it is in another namespace.
  std::string own(const std::string& topic) const {
    return topic.compare(0, options_.ns.size(), options_.ns) == 0 ? topic.substr(options_.ns.size()) : "";
  }
  bool is_command(const std::string& topic) const {
    return topic == "/joint_force_command" || topic == "/joint_command" || topic == "/joint_set_points" ||
           topic == "/joint_trajectory" || topics_.count(topic) > 0;
  }

  // ---- times
  /// Finds the time of the start. If a run was paused at its start, its first state has an older stamp. When it
  /// continues, the next state is due at once, and is that after one step.
  void find_begin() {
    period_ = thread_.simulation().step_size() / pace_of(options_).per_stamp(has_clock_);
    begin_ = states_.front()->header.stamp;
    if (options_.lock_step || has_clock_ || states_.size() < 3) return;
    const ros::Time second = states_[1]->header.stamp;
    was_paused_ = (second - begin_).toSec() > 2.5 * (states_[2]->header.stamp - second).toSec();
    if (was_paused_) begin_ = second - ros::Duration(period_);
  }

  /// Replays a run in lock step: each command causes one step, and each step one state.
  void step_by(const std::vector<MessageInstance>& commands) {
    compare(*states_.front());
    for (const MessageInstance& message : commands) {
      if (!give(message)) continue;
      step();
      if (steps_ >= states_.size())
        fail(fmt::format("in lock step each command makes a state, but the bag has only {} states", states_.size()));
      compare(*states_[steps_]);
    }
    if (steps_ + 1 != states_.size())
      fail(fmt::format("in lock step each command makes a state, but it has {} states after the first, and {} commands",
                       states_.size() - 1, steps_));
  }

  /// Replays a run that was paced by a clock. The stamp of a state tells after how many steps it was. A command acts in
  /// steps that begin later than the command. With wall time, a step begins when its state is due. If the node was the
  /// clock, a step begins when the clock shows the state before.
  void step_until(const std::vector<MessageInstance>& commands) {
    const std::vector<double> due = due_times();
    std::size_t next = 0;
    if (was_paused_) compare(*states_.front());
    for (auto i = static_cast<std::size_t>(was_paused_); i < states_.size(); ++i) {
      const auto& state = states_[i];
      const double count = (state->header.stamp - begin_).toSec() / period_;
      if (count < -0.5) fail("its states go back in time: such a run cannot be replayed");
      while (static_cast<double>(steps_) < std::round(count)) {
        const double begins = static_cast<double>(has_clock_ ? steps_ : steps_ + 1) * period_;
        for (; next < commands.size() && due[next] <= begins + 1e-9; ++next) give(commands[next]);
        step();
      }
      compare(*state);
    }
  }

  /// Times at which commands act, after the first state [s]; they keep their order.
  std::vector<double> due_times() const {
    std::vector<double> due;
    for (std::size_t i = 0; i < command_times_.size(); ++i) {
      const double own = (command_times_[i] - begin_).toSec() + (shifts_.empty() ? 0 : shifts_[i] * period_);
      due.push_back(i > 0 ? std::max(own, due.back()) : own);
    }
    return due;
  }

  // ---- commands and states
  /// Gives a command to the simulation. Returns false if it is refused.
  bool give(const MessageInstance& message) {
    const std::string topic = own(message.getTopic());
    std::vector<Command> commands;
    std::string fault;
    if (topic == "/joint_force_command")
      fault = reader_.read_force_command(*read<JointForceCommand>(message), commands);
    else if (topic == "/joint_command")
      fault = reader_.read_joint_command(*read<sensor_msgs::JointState>(message), commands);
    else if (topic == "/joint_set_points")
      fault = reader_.read_set_points(*read<sensor_msgs::JointState>(message), commands);
    else if (topic == "/joint_trajectory")
      fault = follow(*read<trajectory_msgs::JointTrajectory>(message), commands);
    else
      fault = reader_.read_one(topic.substr(topic.rfind('/')) == "/command" ? Commanded::Effort : Commanded::SetPoint,
                               topics_.at(topic), read<std_msgs::Float64>(message)->data, commands);
    if (fault.empty() && !commands.empty() && !thread_.command(commands)) fault = "too many commands are waiting";
    if (fault.empty()) {
      ++report_.commands;
      return true;
    }
    if (report_.refused++ == 0) report_.first_refusal = message.getTopic() + ": " + fault;
    return false;
  }

  std::string follow(const trajectory_msgs::JointTrajectory& message, std::vector<Command>& commands) {
    const Simulation& simulation = thread_.simulation();
    node::TrajectoryFollower& follower = thread_.trajectories();
    if (options_.lock_step) commands.push_back({Commanded::Nothing});
    const double now = thread_.time();
    follower.forget_before(now);
    if (message.points.empty()) {
      for (std::size_t joint = 0; joint < follower.joint_count(); ++joint)
        if (follower.follows(joint)) follower.stop(joint, now, options_.stop_duration);
      return {};
    }
    std::vector<std::size_t> joints;
    if (const std::string fault = node::read_trajectory_joints(simulation, message.joint_names, joints); !fault.empty())
      return fault;
    std::vector<double> set_points;
    for (const std::size_t joint : joints) set_points.push_back(simulation.set_point(joint));
    node::JointTrajectory trajectory = node::trajectory_of(message, joints);
    if (const std::string fault = follower.find_fault(trajectory); !fault.empty()) return fault;
    const double ahead = (message.header.stamp - stamp()).toSec();
    trajectory.start = message.header.stamp.isZero() ? now : now + pace_of(options_).per_stamp(has_clock_) * ahead;
    if (node::TrajectoryFollower::is_over(trajectory, now)) return "its last point is past";
    follower.follow(trajectory, now, set_points);
    return {};
  }

  /// The stamp of the run's present state. In lock step it is recorded; if the node was the clock, it is computed
  /// likewise.
  ros::Time stamp() const {
    const auto steps = static_cast<double>(steps_);
    if (options_.lock_step) return states_[steps_]->header.stamp;
    if (has_clock_) return ros::Time((std::round(begin_.toSec() / period_) + steps) * period_);
    return begin_ + ros::Duration(steps * period_);
  }

  void step() {
    const bool is_done = thread_.advance();
    const StepResult result = thread_.reports().front().result;
    thread_.reports().pop();
    if (!is_done) throw std::runtime_error("the replay failed: " + thread_.simulation().explain(result));
    ++steps_;
  }

  void compare(const sensor_msgs::JointState& state) {
    const Simulation& simulation = thread_.simulation();
    if (state.position.size() != state.name.size() || state.velocity.size() != state.name.size())
      fail("a message of joint_states has not as many positions and velocities as names");
    const std::size_t row = recorded_.size();
    recorded_.resize(row + report_.joints.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> efforts(report_.joints.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t joint = 0; joint < report_.joints.size(); ++joint)
      positions_.push_back(simulation.position(joint));
    times_.push_back(simulation.time());
    for (std::size_t i = 0; i < state.name.size(); ++i) {
      const std::optional<std::size_t> joint = simulation.find_coordinate(state.name[i]);
      if (!joint) fail("its joint_states have '" + state.name[i] + "', which the scene does not");
      JointDeviation& deviation = report_.joints[*joint];
      recorded_[row + *joint] = state.position[i];
      if (state.effort.size() == state.name.size()) efforts[*joint] = state.effort[i];
      const auto note = [&](double difference, double& largest, double& time) {
        if (!(std::abs(difference) > largest)) return;
        largest = std::abs(difference);
        time = simulation.time();
      };
      note(state.position[i] - simulation.position(*joint), deviation.position, deviation.position_time);
      note(state.velocity[i] - simulation.velocity(*joint), deviation.velocity, deviation.velocity_time);
    }
    if (options_.on_state)
      options_.on_state(simulation, {{recorded_.begin() + static_cast<long>(row), recorded_.end()}, efforts});
    ++report_.states;
  }

  ReplayOptions options_;
  Shifts shifts_;
  node::SteppingThread thread_;
  node::CommandReader reader_;
  std::map<std::string, std::string> topics_;  // command topics of single joints, and their joints
  std::vector<boost::shared_ptr<sensor_msgs::JointState>> states_;
  std::vector<ros::Time> arrivals_, command_times_;  // of states and commands, at the recorder
  std::vector<double> positions_, recorded_, times_;
  bool has_clock_ = false, was_paused_ = false;
  ros::Time begin_;
  double period_ = 0;  // step size in the time of the stamps [s]
  std::size_t steps_ = 0;
  ReplayReport report_;
};

// ---------------------------------------------------------------- commands at other times

/// Variants: all commands early, all late, alternating (two variants), random (four variants).
std::vector<Shifts> other_shifts(const std::vector<int>& lateness, int timing) {
  constexpr unsigned kRandom = 4;
  std::vector<Shifts> all(4 + kRandom);
  for (std::size_t i = 0; i < lateness.size(); ++i) {
    const int early = -timing - lateness[i], late = timing;
    all[0].push_back(early);
    all[1].push_back(late);
    all[2].push_back(i % 2 == 0 ? early : late);
    all[3].push_back(i % 2 == 0 ? late : early);
  }
  for (unsigned k = 0; k < kRandom; ++k) {
    std::mt19937 random(k);
    for (const int late : lateness)
      all[4 + k].push_back(static_cast<int>(random() % static_cast<unsigned>(2 * timing + late + 1)) - timing - late);
  }
  return all;
}

/// Computes how far the other replays deviate from the first one, and how much farther the recorded run deviates.
void explain(const Replay& first, const std::vector<std::vector<double>>& others, ReplayReport& report) {
  const std::size_t count = report.joints.size();
  for (std::size_t i = 0; i < first.positions().size(); ++i) {
    JointDeviation& joint = report.joints[i % count];
    for (const std::vector<double>& positions : others)
      joint.by_times = std::max(joint.by_times, std::abs(positions[i] - first.positions()[i]));
    const double beyond = std::abs(first.recorded()[i] - first.positions()[i]) - joint.by_times;
    if (!(beyond > joint.unexplained)) continue;
    joint.unexplained = beyond;
    joint.unexplained_time = first.times()[i / count];
  }
}

}  // namespace

ReplayReport replay(Simulation simulation, const ReplayOptions& options) {
  try {
    const rosbag::Bag bag(options.bag, rosbag::bagmode::Read);
    Replay first(simulation.copy(), options);
    ReplayReport report = first.run(bag);
    std::vector<std::vector<double>> others;
    explain(first, others, report);
    if (report.agrees(options.largest) || options.lock_step || options.timing == 0 || report.commands == 0)
      return report;
    const std::vector<int> lateness = first.lateness();
    report.other_times = {0, options.timing + *std::max_element(lateness.begin(), lateness.end()), options.timing};
    ReplayOptions unwatched = options;
    unwatched.on_state = {};
    for (Shifts& shifts : other_shifts(lateness, options.timing)) {
      Replay other(simulation.copy(), unwatched, std::move(shifts));
      other.run(bag);
      others.push_back(other.positions());
      ++report.other_times.replays;
    }
    for (JointDeviation& joint : report.joints) joint.unexplained = 0;
    explain(first, others, report);
    return report;
  } catch (const rosbag::BagException& error) {
    throw std::invalid_argument("bag '" + options.bag + "': " + error.what());
  }
}

}  // namespace flexarm::recording
