#pragma once
/// Joint efforts from topics.

#include <flexarm/JointForceCommand.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::node {

/// Hands commanded efforts to the simulation: joint_force_command, joint_command, COORDINATE/command and
/// ~emergency_stop. A command is taken whole or refused whole. Efforts expire in simulated time.
class CommandInterface {
 public:
  /// @param timeout  an effort returns to zero this long after its command, unless that names a duration [s]; 0: never
  CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, Simulation& simulation, double timeout);
  CommandInterface(const CommandInterface&) = delete;
  CommandInterface& operator=(const CommandInterface&) = delete;

  /// Before each step: zeroes the efforts that expired. `time`: simulated time that no reset sets back [s].
  void expire(double time);
  /// After a reset: no command is in force; an emergency stop still is.
  void forget_commands();

 private:
  void receive_force_command(const JointForceCommand& message);
  void receive_joint_state(const sensor_msgs::JointState& message);
  void receive_emergency_stop(const std_msgs::Bool& message);
  void subscribe_to_coordinates(ros::NodeHandle& node);

  /// Checks a command and carries it out, or warns. @param duration  [s]; 0: the timeout counts
  void command(const std::string& topic, const std::vector<std::string>& names, const std::vector<double>& efforts,
               double duration);
  /// What is wrong with a command, empty if nothing is; on success the coordinates are in `commanded_`.
  std::string find_fault(const std::vector<std::string>& names, const std::vector<double>& efforts, double duration);
  void warn(const std::string& topic, const std::string& fault);
  /// While the emergency stop is on, no effort acts, be it commanded or the scene's own.
  void zero_efforts();
  void release_efforts();

  Simulation& simulation_;
  double timeout_;
  double time_ = 0;                     ///< simulated, see expire()
  bool stopped_ = false;                ///< by ~emergency_stop
  std::vector<double> expiry_;          ///< of every coordinate's effort, simulated time [s]; infinite: never
  double next_expiry_;                  ///< smallest of expiry_
  std::vector<std::size_t> commanded_;  ///< scratch: coordinates of the command at hand
  std::chrono::steady_clock::time_point last_warning_;
  int unreported_ = 0;  ///< refused commands since the last warning
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace flexarm::node
