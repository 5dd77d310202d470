#include "command_interface.h"

#include <ros/console.h>
#include <ros/names.h>

#include <optional>
#include <stdexcept>

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kWarningPeriod(1);
constexpr int kQueueSize = 10;

CommandedQuantity efforts_of(Simulation& simulation) {
  return {"effort",
          [&simulation](std::size_t coordinate) {
            return simulation.is_commandable(coordinate)
                       ? std::string()
                       : "the motion of '" + simulation.coordinate_names()[coordinate] + "' is prescribed";
          },
          [&simulation](std::size_t coordinate, double effort) { simulation.command_effort(coordinate, effort); },
          [](std::size_t) { return true; }};
}

std::optional<ServoMode> mode_called(const std::string& name) {
  if (name == "effort") return ServoMode::Effort;
  if (name == "velocity") return ServoMode::Velocity;
  if (name == "position") return ServoMode::Position;
  return std::nullopt;
}

/// A position's servo holds its last set point; one of velocity or effort that hears nothing any more stops.
CommandedQuantity set_points_of(Simulation& simulation, Trajectories& trajectories) {
  return {"set point",
          [&simulation](std::size_t coordinate) {
            return simulation.has_servo(coordinate)
                       ? std::string()
                       : "'" + simulation.coordinate_names()[coordinate] + "' has no servo";
          },
          [&](std::size_t coordinate, double value) {
            trajectories.release(coordinate, "another set point was commanded");
            simulation.command_set_point(coordinate, value);
          },
          [&simulation](std::size_t coordinate) { return simulation.servo_mode(coordinate) != ServoMode::Position; }};
}

}  // namespace

CommandInterface::CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, Simulation& simulation,
                                   const CommandTimes& times)
    : simulation_(simulation),
      now_(times.now),
      trajectories_(node, simulation,
                    {times.now, times.time_of, [this] { return refusal(); },
                     [this](const std::string& fault) { warn("joint_trajectory", fault); },
                     [this](std::size_t coordinate) { set_points_.forget(coordinate); }},
                    times.stop_duration),
      efforts_(simulation, efforts_of(simulation), times.timeout),
      set_points_(simulation, set_points_of(simulation, trajectories_), times.timeout),
      last_warning_(std::chrono::steady_clock::now() - kWarningPeriod) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(
      node.subscribe("joint_force_command", kQueueSize, &CommandInterface::receive_force_command, this, hints));
  subscribers_.push_back(
      node.subscribe("joint_command", kQueueSize, &CommandInterface::receive_joint_state, this, hints));
  subscribers_.push_back(
      node.subscribe("joint_set_points", kQueueSize, &CommandInterface::receive_set_points, this, hints));
  subscribers_.push_back(
      private_node.subscribe("emergency_stop", kQueueSize, &CommandInterface::receive_emergency_stop, this, hints));
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    const std::string& name = simulation.coordinate_names()[i];
    subscribe_to(node, name, "command", efforts_);
    if (simulation.has_servo(i)) subscribe_to(node, name, "set_point", set_points_);
  }
}

void CommandInterface::subscribe_to(ros::NodeHandle& node, const std::string& name, const std::string& suffix,
                                    TimedCommands& commands) {
  const std::string topic = name + "/" + suffix;
  std::string fault;
  if (!ros::names::validate(topic, fault)) {
    ROS_WARN_STREAM("joint '" << name << "' has no topic '" << suffix << "' of its own: " << fault);
    return;
  }
  const boost::function<void(const std_msgs::Float64ConstPtr&)> receive =
      [this, name, topic, &commands](const std_msgs::Float64ConstPtr& message) {
        command(commands, topic, {name}, {message->data});
      };
  subscribers_.push_back(node.subscribe<std_msgs::Float64>(topic, kQueueSize, receive, ros::VoidConstPtr(),
                                                           ros::TransportHints().tcpNoDelay()));
}

void CommandInterface::begin_step() {
  efforts_.expire(now_());
  set_points_.expire(now_());
  trajectories_.command();
}

void CommandInterface::end_step() {
  trajectories_.judge();
}

void CommandInterface::forget_commands() {
  efforts_.forget();
  set_points_.forget();
  trajectories_.release_all("the simulation was put into another state");
  if (stopped_)
    stop();
  else
    switch_servos(true);  // a state that was loaded may have been saved during a stop
}

void CommandInterface::receive_force_command(const JointForceCommand& message) {
  command(efforts_, "joint_force_command", message.names, message.efforts, message.duration.toSec());
}

void CommandInterface::receive_joint_state(const sensor_msgs::JointState& message) {
  const bool has_set_points = !message.position.empty() || !message.velocity.empty();
  if (has_set_points && message.effort.empty())
    command_set_points("joint_command", message);
  else
    command(efforts_, "joint_command", message.name, message.effort);
}

void CommandInterface::receive_set_points(const sensor_msgs::JointState& message) {
  command_set_points("joint_set_points", message);
}

void CommandInterface::command_set_points(const std::string& topic, const sensor_msgs::JointState& message) {
  std::vector<double> values;
  for (const std::string& name : message.name) {
    const std::optional<std::size_t> coordinate = simulation_.find_coordinate(name);
    if (!coordinate || !simulation_.has_servo(*coordinate)) {
      values.push_back(0);  // whatever it is: the command is refused for the name
      continue;
    }
    const ServoMode mode = simulation_.servo_mode(*coordinate);
    const bool is_position = mode == ServoMode::Position, is_velocity = mode == ServoMode::Velocity;
    const std::vector<double>& of_mode = is_position   ? message.position
                                         : is_velocity ? message.velocity
                                                       : message.effort;
    if (of_mode.size() != message.name.size()) {
      const char* what = is_position ? " positions" : is_velocity ? " velocities" : " efforts";
      return warn(topic, "it has " + std::to_string(message.name.size()) + " names, but " +
                             std::to_string(of_mode.size()) + what + ", which the servo of '" + name + "' takes");
    }
    values.push_back(of_mode[values.size()]);
  }
  command(set_points_, topic, message.name, values);
}

std::string CommandInterface::switch_mode(const std::vector<std::string>& names,
                                          const std::vector<std::string>& modes) {
  if (const std::string refusal = this->refusal(); !refusal.empty()) return refusal;
  if (names.size() != modes.size())
    return std::to_string(names.size()) + " names, but " + std::to_string(modes.size()) + " modes";
  const Snapshot before = simulation_.snapshot();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = simulation_.find_coordinate(names[i]);
    const std::optional<ServoMode> mode = mode_called(modes[i]);
    std::string fault = !coordinate ? "there is no joint coordinate '" + names[i] + "'"
                        : !mode     ? "mode must be 'effort', 'velocity' or 'position', got '" + modes[i] + "'"
                                    : std::string();
    try {
      if (fault.empty()) simulation_.switch_mode(*coordinate, *mode);
    } catch (const std::invalid_argument& error) {
      fault = error.what();
    }
    if (fault.empty()) continue;
    simulation_.restore(before);
    return fault;
  }
  for (const std::string& name : names) {
    const std::size_t coordinate = *simulation_.find_coordinate(name);
    set_points_.forget(coordinate);
    if (simulation_.servo_mode(coordinate) != ServoMode::Position)
      trajectories_.release(coordinate, "the servo of '" + name + "' was switched to another mode");
  }
  return {};
}

std::string CommandInterface::refusal() const {
  return stopped_ ? "the emergency stop is on" : "";
}

void CommandInterface::receive_emergency_stop(const std_msgs::Bool& message) {
  if (message.data == static_cast<unsigned char>(stopped_)) return;
  stopped_ = message.data;
  if (stopped_) {
    ROS_WARN("emergency stop: all efforts are zero, servos are off, commands are refused until it is released");
    trajectories_.release_all("the emergency stop is on");
    forget_commands();
  } else {
    ROS_INFO("emergency stop released: the scene's efforts and servos act again, commands are accepted");
    release();
  }
}

void CommandInterface::command(TimedCommands& commands, const std::string& topic, const std::vector<std::string>& names,
                               const std::vector<double>& values, double duration) {
  std::string fault = refusal();
  if (fault.empty()) fault = commands.command(names, values, duration);
  if (!fault.empty()) warn(topic, fault);
}

void CommandInterface::warn(const std::string& topic, const std::string& fault) {
  // Not ROS_WARN_THROTTLE: it counts in ROS time, which stands still while a simulation that is the clock is paused.
  const auto now = std::chrono::steady_clock::now();
  if (now - last_warning_ < kWarningPeriod) {
    ++unreported_;
    return;
  }
  const std::string others = unreported_ > 0 ? " (" + std::to_string(unreported_) + " more refused before)" : "";
  ROS_WARN_STREAM("command on " << topic << " refused: " << fault << others);
  last_warning_ = now;
  unreported_ = 0;
}

void CommandInterface::stop() {
  for (std::size_t i = 0; i < simulation_.coordinate_names().size(); ++i) {
    if (simulation_.is_commandable(i)) simulation_.command_effort(i, 0);
  }
  switch_servos(false);
}

void CommandInterface::release() {
  for (std::size_t i = 0; i < simulation_.coordinate_names().size(); ++i) {
    simulation_.release_command(i);
    simulation_.release_set_point(i);
  }
  switch_servos(true);
}

void CommandInterface::switch_servos(bool on) {
  for (std::size_t i = 0; i < simulation_.coordinate_names().size(); ++i) {
    if (simulation_.has_servo(i)) simulation_.switch_servo(i, on);
  }
}

}  // namespace flexarm::node
