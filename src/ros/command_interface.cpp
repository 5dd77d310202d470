#include "command_interface.h"

#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kWarningPeriod(1);
constexpr int kQueueSize = 10;

std::optional<ServoMode> mode_called(const std::string& name) {
  for (const ServoMode mode : {ServoMode::Effort, ServoMode::Velocity, ServoMode::Position})
    if (name == to_string(mode)) return mode;
  return std::nullopt;
}

const char* name_of(Commanded quantity) {
  return quantity == Commanded::Effort ? "effort" : "set point";
}

}  // namespace

CommandInterface::CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown,
                                   SteppingThread& stepping, CommandTimes times)
    : shown_(shown),
      stepping_(stepping),
      times_(std::move(times)),
      trajectories_(node, shown, stepping,
                    {times_.time_of, [this] { return refusal(); },
                     [this](const std::string& fault) { warn("joint_trajectory", fault); }},
                    times_.stop_duration),
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
  for (std::size_t i = 0; i < shown.coordinate_names().size(); ++i) {
    const std::string& name = shown.coordinate_names()[i];
    subscribe_to(node, name, "command", Commanded::Effort);
    if (shown.has_servo(i)) subscribe_to(node, name, "set_point", Commanded::SetPoint);
  }
}

void CommandInterface::subscribe_to(ros::NodeHandle& node, const std::string& name, const std::string& suffix,
                                    Commanded quantity) {
  const std::string topic = name + "/" + suffix;
  std::string fault;
  if (!ros::names::validate(topic, fault)) {
    ROS_WARN_STREAM("joint '" << name << "' has no topic '" << suffix << "' of its own: " << fault);
    return;
  }
  const boost::function<void(const std_msgs::Float64ConstPtr&)> receive =
      [this, name, topic, quantity](const std_msgs::Float64ConstPtr& message) {
        command(quantity, topic, {name}, {message->data});
      };
  subscribers_.push_back(node.subscribe<std_msgs::Float64>(topic, kQueueSize, receive, ros::VoidConstPtr(),
                                                           ros::TransportHints().tcpNoDelay()));
}

void CommandInterface::forget_commands() {
  stepping_.forget_commands();
  trajectories_.release_all(stopped_ ? refusal() : "the simulation was put into another state");
  if (stopped_)
    stop(stepping_.simulation());
  else
    switch_servos(stepping_.simulation(), true);  // a state that was loaded may have been saved during a stop
}

void CommandInterface::receive_force_command(const JointForceCommand& message) {
  command(Commanded::Effort, "joint_force_command", message.names, message.efforts, message.duration.toSec());
}

void CommandInterface::receive_joint_state(const sensor_msgs::JointState& message) {
  const bool has_set_points = !message.position.empty() || !message.velocity.empty();
  if (has_set_points && message.effort.empty())
    command_set_points("joint_command", message);
  else
    command(Commanded::Effort, "joint_command", message.name, message.effort);
}

void CommandInterface::receive_set_points(const sensor_msgs::JointState& message) {
  command_set_points("joint_set_points", message);
}

void CommandInterface::command_set_points(const std::string& topic, const sensor_msgs::JointState& message) {
  std::vector<double> values;
  for (const std::string& name : message.name) {
    const std::optional<std::size_t> coordinate = shown_.find_coordinate(name);
    if (!coordinate || !shown_.has_servo(*coordinate)) {
      values.push_back(0);  // whatever it is: the command is refused for the name
      continue;
    }
    const ServoMode mode = shown_.servo_mode(*coordinate);
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
  command(Commanded::SetPoint, topic, message.name, values);
}

std::string CommandInterface::switch_mode(Simulation& simulation, const std::vector<std::string>& names,
                                          const std::vector<std::string>& modes) {
  if (const std::string refusal = this->refusal(); !refusal.empty()) return refusal;
  if (names.size() != modes.size())
    return std::to_string(names.size()) + " names, but " + std::to_string(modes.size()) + " modes";
  const Snapshot before = simulation.snapshot();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = simulation.find_coordinate(names[i]);
    const std::optional<ServoMode> mode = mode_called(modes[i]);
    std::string fault = !coordinate ? "there is no joint coordinate '" + names[i] + "'"
                        : !mode     ? "mode must be 'effort', 'velocity' or 'position', got '" + modes[i] + "'"
                                    : std::string();
    try {
      if (fault.empty()) simulation.switch_mode(*coordinate, *mode);
    } catch (const std::invalid_argument& error) {
      fault = error.what();
    }
    if (fault.empty()) continue;
    simulation.restore(before);
    return fault;
  }
  for (const std::string& name : names) {
    const std::size_t coordinate = *simulation.find_coordinate(name);
    stepping_.forget_set_point(coordinate);
    if (simulation.servo_mode(coordinate) != ServoMode::Position)
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
    stepping_.between_steps([this](Simulation&) { forget_commands(); });
  } else {
    ROS_INFO("emergency stop released: the scene's efforts and servos act again, commands are accepted");
    stepping_.between_steps([this](Simulation& simulation) { release(simulation); });
  }
}

void CommandInterface::command(Commanded quantity, const std::string& topic, const std::vector<std::string>& names,
                               const std::vector<double>& values, double duration) {
  std::string fault = refusal();
  if (fault.empty()) fault = find_fault(quantity, names, values, duration);
  if (fault.empty() && quantity == Commanded::SetPoint)
    for (const Command& one : message_) trajectories_.release(one.coordinate, "another set point was commanded");
  if (fault.empty() && !stepping_.command(message_)) fault = "more wait already than steps can take";
  if (!fault.empty()) warn(topic, fault);
}

std::string CommandInterface::find_fault(Commanded quantity, const std::vector<std::string>& names,
                                         const std::vector<double>& values, double duration) {
  const std::string what = name_of(quantity);
  if (names.empty()) return "it names no joint";
  if (names.size() != values.size())
    return "it has " + std::to_string(names.size()) + " names, but " + std::to_string(values.size()) + " " + what + "s";
  if (duration < 0) return "its duration is negative";
  const double lifetime = duration > 0 ? duration : times_.timeout > 0 ? times_.timeout : Command::kForEver;
  message_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = shown_.find_coordinate(names[i]);
    if (!coordinate) return "there is no joint coordinate '" + names[i] + "'";
    if (!std::isfinite(values[i])) return "the " + what + " of '" + names[i] + "' is not finite";
    const std::string fault = find_fault(quantity, *coordinate);
    if (!fault.empty()) return fault;
    const auto is_same = [&](const Command& other) { return other.coordinate == *coordinate; };
    if (std::any_of(message_.begin(), message_.end(), is_same)) return "'" + names[i] + "' is named twice";
    // A position's servo holds its last set point; one of velocity or effort that hears nothing any more stops.
    const bool holds = quantity == Commanded::SetPoint && shown_.servo_mode(*coordinate) == ServoMode::Position;
    message_.push_back({quantity, *coordinate, values[i], holds ? Command::kForEver : lifetime});
  }
  return {};
}

std::string CommandInterface::find_fault(Commanded quantity, std::size_t coordinate) const {
  const std::string& name = shown_.coordinate_names()[coordinate];
  if (quantity == Commanded::SetPoint) return shown_.has_servo(coordinate) ? "" : "'" + name + "' has no servo";
  return shown_.is_commandable(coordinate) ? "" : "the motion of '" + name + "' is prescribed";
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

void CommandInterface::stop(Simulation& simulation) {
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    if (simulation.is_commandable(i)) simulation.command_effort(i, 0);
  }
  switch_servos(simulation, false);
}

void CommandInterface::release(Simulation& simulation) {
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    simulation.release_command(i);
    simulation.release_set_point(i);
  }
  switch_servos(simulation, true);
}

void CommandInterface::switch_servos(Simulation& simulation, bool on) {
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    if (simulation.has_servo(i)) simulation.switch_servo(i, on);
  }
}

}  // namespace flexarm::node
