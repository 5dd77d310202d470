#include "command_interface.h"

#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "flexarm/scene/scene_description.h"

namespace flexarm::node {
namespace {

using Mode = scene::ServoDescription::Mode;

constexpr std::chrono::seconds kWarningPeriod(1);
constexpr int kQueueSize = 10;

std::optional<Mode> mode_of_servo(const Simulation& simulation, const std::string& coordinate) {
  for (const scene::ServoDescription& servo : simulation.scene().servos)
    if (servo.coordinate == coordinate) return servo.mode;
  return std::nullopt;
}

const char* name_of(Commanded quantity) {
  return quantity == Commanded::Effort ? "effort" : "set point";
}

}  // namespace

CommandInterface::CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& scene,
                                   SteppingThread& stepping, double timeout)
    : scene_(scene),
      stepping_(stepping),
      timeout_(timeout),
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
  for (std::size_t i = 0; i < scene.coordinate_names().size(); ++i) {
    const std::string& name = scene.coordinate_names()[i];
    subscribe_to(node, name, "command", Commanded::Effort);
    if (scene.has_servo(i)) subscribe_to(node, name, "set_point", Commanded::SetPoint);
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
  if (stopped_)
    stop(stepping_.simulation());
  else
    switch_servos(stepping_.simulation(), true);  // a state that was loaded may have been saved during a stop
}

void CommandInterface::receive_force_command(const JointForceCommand& message) {
  command(Commanded::Effort, "joint_force_command", message.names, message.efforts, message.duration.toSec());
}

void CommandInterface::receive_joint_state(const sensor_msgs::JointState& message) {
  command(Commanded::Effort, "joint_command", message.name, message.effort);
}

void CommandInterface::receive_set_points(const sensor_msgs::JointState& message) {
  const std::string topic = "joint_set_points";
  std::vector<double> values;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    const std::optional<Mode> mode = mode_of_servo(scene_, message.name[i]);
    const bool is_position = mode == Mode::Position, is_velocity = mode == Mode::Velocity;
    const std::vector<double>& of_mode = is_position   ? message.position
                                         : is_velocity ? message.velocity
                                                       : message.effort;
    if (mode && of_mode.size() != message.name.size()) {
      const char* what = is_position ? " positions" : is_velocity ? " velocities" : " efforts";
      return warn(topic, "it has " + std::to_string(message.name.size()) + " names, but " +
                             std::to_string(of_mode.size()) + what + ", which the servo of '" + message.name[i] +
                             "' takes");
    }
    values.push_back(mode ? of_mode[i] : 0);
  }
  command(Commanded::SetPoint, topic, message.name, values);
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
  std::string fault = stopped_ ? "the emergency stop is on" : find_fault(quantity, names, values, duration);
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
  const double lifetime = duration > 0 ? duration : timeout_ > 0 ? timeout_ : Command::kForEver;
  message_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = scene_.find_coordinate(names[i]);
    if (!coordinate) return "there is no joint coordinate '" + names[i] + "'";
    if (!std::isfinite(values[i])) return "the " + what + " of '" + names[i] + "' is not finite";
    const std::string fault = find_fault(quantity, *coordinate);
    if (!fault.empty()) return fault;
    const auto is_same = [&](const Command& other) { return other.coordinate == *coordinate; };
    if (std::any_of(message_.begin(), message_.end(), is_same)) return "'" + names[i] + "' is named twice";
    // A position's servo holds its last set point; one of velocity or effort that hears nothing any more stops.
    const bool holds = quantity == Commanded::SetPoint && mode_of_servo(scene_, names[i]) == Mode::Position;
    message_.push_back({quantity, *coordinate, values[i], holds ? Command::kForEver : lifetime});
  }
  return {};
}

std::string CommandInterface::find_fault(Commanded quantity, std::size_t coordinate) const {
  const std::string& name = scene_.coordinate_names()[coordinate];
  if (quantity == Commanded::SetPoint) return scene_.has_servo(coordinate) ? "" : "'" + name + "' has no servo";
  return scene_.is_commandable(coordinate) ? "" : "the motion of '" + name + "' is prescribed";
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
