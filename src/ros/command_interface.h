#pragma once
/// Joint efforts and set points of servos from topics.

#include <flexarm/JointForceCommand.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>

#include <chrono>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "stepping_thread.h"

namespace flexarm::node {

/// Hands commands to the thread that steps: efforts of joint_force_command, joint_command and COORDINATE/command, set
/// points of joint_set_points and COORDINATE/set_point; and ~emergency_stop.
class CommandInterface {
 public:
  /// @param scene    of what is stepped
  /// @param timeout  a command expires after it, unless that names a duration [s]; 0: never
  CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& scene,
                   SteppingThread& stepping, double timeout);
  CommandInterface(const CommandInterface&) = delete;
  CommandInterface& operator=(const CommandInterface&) = delete;

  /// Between two steps, after a reset, or where another state was loaded: no command expires; an emergency stop, or
  /// none, still is in force.
  void forget_commands();

 private:
  void receive_force_command(const JointForceCommand& message);
  void receive_joint_state(const sensor_msgs::JointState& message);
  void receive_set_points(const sensor_msgs::JointState& message);
  void receive_emergency_stop(const std_msgs::Bool& message);
  /// COORDINATE/`suffix`, each message of which commands that quantity.
  void subscribe_to(ros::NodeHandle& node, const std::string& coordinate, const std::string& suffix,
                    Commanded quantity);

  /// Hands a command over, whole, or warns. @param duration  [s]; 0: the timeout counts
  void command(Commanded quantity, const std::string& topic, const std::vector<std::string>& names,
               const std::vector<double>& values, double duration = 0);
  /// Empty if nothing is wrong; then the command is in `message_`.
  std::string find_fault(Commanded quantity, const std::vector<std::string>& names, const std::vector<double>& values,
                         double duration);
  std::string find_fault(Commanded quantity, std::size_t coordinate) const;
  void warn(const std::string& topic, const std::string& fault);
  /// While the emergency stop is on, no effort acts, be it commanded, the scene's own or a servo's.
  void stop(Simulation& simulation);
  void release(Simulation& simulation);
  void switch_servos(Simulation& simulation, bool on);

  const Simulation& scene_;
  SteppingThread& stepping_;
  double timeout_;                ///< [s]; 0: none
  std::vector<Command> message_;  ///< the one at hand
  bool stopped_ = false;          ///< by ~emergency_stop
  std::chrono::steady_clock::time_point last_warning_;
  int unreported_ = 0;  ///< refused commands since the last warning
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace flexarm::node
