#include "command_interface.h"

#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm::node {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr std::chrono::seconds kWarningPeriod(1);
constexpr int kQueueSize = 10;

}  // namespace

CommandInterface::CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, Simulation& simulation,
                                   double timeout)
    : simulation_(simulation),
      timeout_(timeout),
      expiry_(simulation.coordinate_names().size(), kNever),
      next_expiry_(kNever),
      last_warning_(std::chrono::steady_clock::now() - kWarningPeriod) {
  commanded_.reserve(expiry_.size());
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(
      node.subscribe("joint_force_command", kQueueSize, &CommandInterface::receive_force_command, this, hints));
  subscribers_.push_back(
      node.subscribe("joint_command", kQueueSize, &CommandInterface::receive_joint_state, this, hints));
  subscribers_.push_back(
      private_node.subscribe("emergency_stop", kQueueSize, &CommandInterface::receive_emergency_stop, this, hints));
  subscribe_to_coordinates(node);
}

void CommandInterface::subscribe_to_coordinates(ros::NodeHandle& node) {
  for (const std::string& name : simulation_.coordinate_names()) {
    const std::string topic = name + "/command";
    std::string fault;
    if (!ros::names::validate(topic, fault)) {
      ROS_WARN_STREAM("joint '" << name << "' has no topic for commands of its own: " << fault);
      continue;
    }
    const boost::function<void(const std_msgs::Float64ConstPtr&)> receive =
        [this, name, topic](const std_msgs::Float64ConstPtr& message) { command(topic, {name}, {message->data}, 0); };
    subscribers_.push_back(node.subscribe<std_msgs::Float64>(topic, kQueueSize, receive, ros::VoidConstPtr(),
                                                             ros::TransportHints().tcpNoDelay()));
  }
}

void CommandInterface::expire(double time) {
  time_ = time;
  if (time_ < next_expiry_) return;
  for (std::size_t coordinate = 0; coordinate < expiry_.size(); ++coordinate) {
    if (time_ < expiry_[coordinate]) continue;
    simulation_.command_effort(coordinate, 0);
    expiry_[coordinate] = kNever;
  }
  next_expiry_ = *std::min_element(expiry_.begin(), expiry_.end());
}

void CommandInterface::forget_commands() {
  std::fill(expiry_.begin(), expiry_.end(), kNever);
  next_expiry_ = kNever;
  if (stopped_) zero_efforts();
}

void CommandInterface::receive_force_command(const JointForceCommand& message) {
  command("joint_force_command", message.names, message.efforts, message.duration.toSec());
}

void CommandInterface::receive_joint_state(const sensor_msgs::JointState& message) {
  command("joint_command", message.name, message.effort, 0);
}

void CommandInterface::receive_emergency_stop(const std_msgs::Bool& message) {
  if (message.data == static_cast<unsigned char>(stopped_)) return;
  stopped_ = message.data;
  if (stopped_) {
    ROS_WARN("emergency stop: all efforts are zero, commands are refused until it is released");
    forget_commands();
  } else {
    ROS_INFO("emergency stop released: the scene's efforts act again, commands are accepted");
    release_efforts();
  }
}

void CommandInterface::command(const std::string& topic, const std::vector<std::string>& names,
                               const std::vector<double>& efforts, double duration) {
  const std::string fault = find_fault(names, efforts, duration);
  if (!fault.empty()) return warn(topic, fault);

  const double lifetime = duration > 0 ? duration : timeout_ > 0 ? timeout_ : kNever;
  for (std::size_t i = 0; i < commanded_.size(); ++i) {
    simulation_.command_effort(commanded_[i], efforts[i]);
    expiry_[commanded_[i]] = time_ + lifetime;
  }
  next_expiry_ = *std::min_element(expiry_.begin(), expiry_.end());
}

std::string CommandInterface::find_fault(const std::vector<std::string>& names, const std::vector<double>& efforts,
                                         double duration) {
  if (stopped_) return "the emergency stop is on";
  if (names.empty()) return "it names no joint";
  if (names.size() != efforts.size()) {
    return "it has " + std::to_string(names.size()) + " names, but " + std::to_string(efforts.size()) + " efforts";
  }
  if (duration < 0) return "its duration is negative";
  commanded_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> coordinate = simulation_.find_coordinate(names[i]);
    if (!coordinate) return "there is no joint coordinate '" + names[i] + "'";
    if (!std::isfinite(efforts[i])) return "the effort of '" + names[i] + "' is not finite";
    if (!simulation_.is_commandable(*coordinate)) return "the motion of '" + names[i] + "' is prescribed";
    if (std::find(commanded_.begin(), commanded_.end(), *coordinate) != commanded_.end()) {
      return "'" + names[i] + "' is named twice";
    }
    commanded_.push_back(*coordinate);
  }
  return {};
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

void CommandInterface::zero_efforts() {
  for (std::size_t coordinate = 0; coordinate < expiry_.size(); ++coordinate) {
    if (simulation_.is_commandable(coordinate)) simulation_.command_effort(coordinate, 0);
  }
}

void CommandInterface::release_efforts() {
  for (std::size_t coordinate = 0; coordinate < expiry_.size(); ++coordinate) simulation_.release_command(coordinate);
}

}  // namespace flexarm::node
