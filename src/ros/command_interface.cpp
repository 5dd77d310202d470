#include "command_interface.h"

#include <ros/console.h>
#include <ros/names.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "flexarm/simulation/command_refusal.h"

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kWarningPeriod(1);
constexpr int kQueueSize = 10;

}  // namespace

CommandInterface::CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown,
                                   SteppingThread& stepping, const CommandTimes& times)
    : node_(node),
      shown_(shown),
      stepping_(stepping),
      reader_(shown, times.timeout),
      controllers_(node, private_node, shown, stepping,
                   {times.time_of, [this] { return refusal(); }, times.stop_duration},
                   [this](const std::string& fault) { warn("joint_trajectory", fault); }),
      limit_watch_(shown),
      last_warning_(std::chrono::steady_clock::now() - kWarningPeriod) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(
      node.subscribe("joint_force_command", kQueueSize, &CommandInterface::receive_force_command, this, hints));
  subscribers_.push_back(
      node.subscribe("joint_command", kQueueSize, &CommandInterface::receive_joint_command, this, hints));
  subscribers_.push_back(
      node.subscribe("joint_set_points", kQueueSize, &CommandInterface::receive_set_points, this, hints));
  subscribers_.push_back(
      private_node.subscribe("emergency_stop", kQueueSize, &CommandInterface::receive_emergency_stop, this, hints));
  adopt_scene();
}

void CommandInterface::adopt_scene() {
  controllers_.adopt_scene();
  const std::map<std::string, ros::Subscriber> before = std::exchange(joint_subscribers_, {});
  const auto subscribe = [&](const std::string& name, const std::string& suffix, Commanded quantity) {
    const auto same = before.find(name + "/" + suffix);
    joint_subscribers_[name + "/" + suffix] =
        same != before.end() ? same->second : subscribe_to(name, suffix, quantity);
  };
  for (std::size_t i = 0; i < shown_.coordinate_names().size(); ++i) {
    const std::string& name = shown_.coordinate_names()[i];
    subscribe(name, "command", Commanded::Effort);
    if (shown_.has_servo(i)) subscribe(name, "set_point", Commanded::SetPoint);
  }
  if (stopped_) stop(stepping_.simulation());  // what is new obeys, too
}

ros::Subscriber CommandInterface::subscribe_to(const std::string& name, const std::string& suffix, Commanded quantity) {
  const std::string topic = name + "/" + suffix;
  std::string fault;
  if (!ros::names::validate(topic, fault)) {
    ROS_WARN_STREAM("joint '" << name << "' has no topic '" << suffix << "' of its own: " << fault);
    return {};
  }
  const boost::function<void(const std_msgs::Float64ConstPtr&)> receive =
      [this, name, topic, quantity](const std_msgs::Float64ConstPtr& message) {
        command(topic, [&] { return reader_.read_one(quantity, name, message->data, message_); });
      };
  return node_.subscribe<std_msgs::Float64>(topic, kQueueSize, receive, ros::VoidConstPtr(),
                                            ros::TransportHints().tcpNoDelay());
}

void CommandInterface::forget_commands() {
  stepping_.forget_commands();
  controllers_.release_all(stopped_ ? refusal() : "the simulation was set to another state");
  if (stopped_)
    stop(stepping_.simulation());
  else
    switch_servos(stepping_.simulation(), true);  // a loaded state may have been saved during a stop
}

void CommandInterface::receive_force_command(const JointForceCommand& message) {
  command("joint_force_command", [&] { return reader_.read_force_command(message, message_); });
}

void CommandInterface::receive_joint_command(const sensor_msgs::JointState& message) {
  command("joint_command", [&] { return reader_.read_joint_command(message, message_); });
}

void CommandInterface::receive_set_points(const sensor_msgs::JointState& message) {
  command("joint_set_points", [&] { return reader_.read_set_points(message, message_); });
}

std::string CommandInterface::switch_mode(Simulation& simulation, const std::vector<std::string>& names,
                                          const std::vector<std::string>& modes) {
  if (const std::string refusal = this->refusal(); !refusal.empty()) return refusal;
  if (names.size() != modes.size())
    return std::to_string(names.size()) + " names, but " + std::to_string(modes.size()) + " modes";
  const Snapshot before = simulation.snapshot();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = simulation.find_coordinate(names[i]);
    const std::optional<ServoMode> mode = servo_mode_called(modes[i]);
    std::string fault = !coordinate ? unknown_coordinate(simulation, names[i])
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
      controllers_.release(coordinate, "the servo of '" + name + "' was switched to another mode");
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

void CommandInterface::note_set_point(const Command& command) {
  controllers_.release(command.coordinate, "another set point was commanded");
  if (shown_.servo_mode(command.coordinate) == ServoMode::Position)
    limit_watch_.look(command.coordinate, command.value);
}

template <class Read>
void CommandInterface::command(const std::string& topic, const Read& read) {
  std::string fault = refusal();
  if (fault.empty()) fault = read();
  if (fault.empty())
    for (const Command& one : message_)
      if (one.quantity == Commanded::SetPoint) note_set_point(one);
  if (fault.empty() && !stepping_.command(message_)) fault = "too many commands are waiting already";
  if (!fault.empty()) warn(topic, fault);
}

void CommandInterface::warn(const std::string& topic, const std::string& fault) {
  // Not ROS_WARN_THROTTLE, which uses ROS time: it stands still if this node publishes /clock and is paused.
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
