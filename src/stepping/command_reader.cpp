#include "command_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "flexarm/simulation/command_refusal.h"

namespace flexarm::node {
namespace {

const char* name_of(Commanded quantity) {
  return quantity == Commanded::Effort ? "effort" : "set point";
}

}  // namespace

std::string CommandReader::read_force_command(const JointForceCommand& message, std::vector<Command>& commands) const {
  return read(Commanded::Effort, message.names, message.efforts, message.duration.toSec(), commands);
}

std::string CommandReader::read_joint_command(const sensor_msgs::JointState& message,
                                              std::vector<Command>& commands) const {
  const bool has_set_points = !message.position.empty() || !message.velocity.empty();
  if (has_set_points && message.effort.empty()) return read_set_points(message, commands);
  return read(Commanded::Effort, message.name, message.effort, 0, commands);
}

std::string CommandReader::read_set_points(const sensor_msgs::JointState& message,
                                           std::vector<Command>& commands) const {
  std::vector<double> values;
  for (const std::string& name : message.name) {
    const std::optional<std::size_t> coordinate = shown_.find_coordinate(name);
    if (!coordinate || !shown_.has_servo(*coordinate)) {
      values.push_back(0);  // any value: read() refuses the command because of the name
      continue;
    }
    const ServoMode mode = shown_.servo_mode(*coordinate);
    const bool is_position = mode == ServoMode::Position, is_velocity = mode == ServoMode::Velocity;
    const std::vector<double>& of_mode = is_position   ? message.position
                                         : is_velocity ? message.velocity
                                                       : message.effort;
    if (of_mode.size() != message.name.size()) {
      const char* what = is_position ? " positions" : is_velocity ? " velocities" : " efforts";
      return "it has " + std::to_string(message.name.size()) + " names, but " + std::to_string(of_mode.size()) + what +
             ", which the servo of '" + name + "' takes";
    }
    values.push_back(of_mode[values.size()]);
  }
  return read(Commanded::SetPoint, message.name, values, 0, commands);
}

std::string CommandReader::read_one(Commanded quantity, const std::string& name, double value,
                                    std::vector<Command>& commands) const {
  return read(quantity, {name}, {value}, 0, commands);
}

std::string CommandReader::read(Commanded quantity, const std::vector<std::string>& names,
                                const std::vector<double>& values, double duration,
                                std::vector<Command>& commands) const {
  const std::string what = name_of(quantity);
  if (names.empty()) return "it names no joint";
  if (names.size() != values.size())
    return "it has " + std::to_string(names.size()) + " names, but " + std::to_string(values.size()) + " " + what + "s";
  if (duration < 0) return "its duration is negative";
  const double lifetime = duration > 0 ? duration : timeout_ > 0 ? timeout_ : Command::kForEver;
  commands.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = shown_.find_coordinate(names[i]);
    if (!coordinate) return unknown_coordinate(shown_, names[i]);
    if (!std::isfinite(values[i])) return "the " + what + " of '" + names[i] + "' is not finite";
    const std::string fault = find_fault(quantity, *coordinate);
    if (!fault.empty()) return fault;
    const auto is_same = [&](const Command& other) { return other.coordinate == *coordinate; };
    if (std::any_of(commands.begin(), commands.end(), is_same)) return "'" + names[i] + "' is named twice";
    // When a command expires, a servo in mode position keeps its last set point; one in another mode gets the set point
    // zero.
    const bool holds = quantity == Commanded::SetPoint && shown_.servo_mode(*coordinate) == ServoMode::Position;
    commands.push_back({quantity, *coordinate, values[i], holds ? Command::kForEver : lifetime});
  }
  return {};
}

std::string CommandReader::find_fault(Commanded quantity, std::size_t coordinate) const {
  return quantity == Commanded::SetPoint ? refusal_of_set_points(shown_, coordinate)
                                         : refusal_of_commands(shown_, coordinate);
}

std::string read_trajectory_joints(const Simulation& shown, const std::vector<std::string>& names,
                                   std::vector<std::size_t>& joints) {
  for (const std::string& name : names) {
    const std::optional<std::size_t> joint = shown.find_coordinate(name);
    if (!joint) return unknown_coordinate(shown, name);
    if (const std::string refusal = refusal_of_set_points(shown, *joint); !refusal.empty()) return refusal;
    if (shown.servo_mode(*joint) != ServoMode::Position) return "the servo of '" + name + "' is not in mode 'position'";
    joints.push_back(*joint);
  }
  return {};
}

JointTrajectory trajectory_of(const trajectory_msgs::JointTrajectory& message, std::vector<std::size_t> joints) {
  JointTrajectory out{std::move(joints), 0, {}};
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points)
    out.points.push_back({point.time_from_start.toSec(), point.positions, point.velocities, point.accelerations});
  return out;
}

}  // namespace flexarm::node
