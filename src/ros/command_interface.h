#pragma once
/// Joint efforts, set points of servos and trajectories from topics, and the modes of servos.

#include <flexarm/JointForceCommand.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "timed_commands.h"
#include "trajectories.h"

namespace flexarm::node {

/// What commands are told of time. Simulated times are those that no reset sets back [s].
struct CommandTimes {
  std::function<double()> now;                      ///< simulated
  std::function<double(const ros::Time&)> time_of;  ///< that belongs to a stamp
  double timeout = 0;        ///< a command expires after it, unless that names a duration [s]; 0: never
  double stop_duration = 0;  ///< in which joints on trajectories decelerate that are to stop [s]; 0: at once
};

/// Hands commands to the simulation: efforts of joint_force_command, joint_command and COORDINATE/command, set points
/// of joint_set_points, joint_command and COORDINATE/set_point; trajectories; and ~emergency_stop.
class CommandInterface {
 public:
  CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, Simulation& simulation,
                   const CommandTimes& times);
  CommandInterface(const CommandInterface&) = delete;
  CommandInterface& operator=(const CommandInterface&) = delete;

  /// Before each step: zeroes what expired, and moves on trajectories.
  void begin_step();
  /// After each step: judges what a trajectory has come to.
  void end_step();
  /// Switches the modes of servos, all or none. @returns why not, or nothing
  std::string switch_mode(const std::vector<std::string>& names, const std::vector<std::string>& modes);
  /// After a reset, or where another state was loaded: no command expires; an emergency stop, or none, still is in
  /// force.
  void forget_commands();

 private:
  void receive_force_command(const JointForceCommand& message);
  void receive_joint_state(const sensor_msgs::JointState& message);
  void receive_set_points(const sensor_msgs::JointState& message);
  void receive_emergency_stop(const std_msgs::Bool& message);
  void command_set_points(const std::string& topic, const sensor_msgs::JointState& message);
  /// Why nothing may be commanded now, or nothing.
  std::string refusal() const;
  /// COORDINATE/`suffix`, each message of which goes to `commands`.
  void subscribe_to(ros::NodeHandle& node, const std::string& coordinate, const std::string& suffix,
                    TimedCommands& commands);

  /// Carries a command out or warns. @param duration  [s]; 0: the timeout counts
  void command(TimedCommands& commands, const std::string& topic, const std::vector<std::string>& names,
               const std::vector<double>& values, double duration = 0);
  void warn(const std::string& topic, const std::string& fault);
  /// While the emergency stop is on, no effort acts, be it commanded, the scene's own or a servo's.
  void stop();
  void release();
  void switch_servos(bool on);

  Simulation& simulation_;
  std::function<double()> now_;  ///< simulated time that no reset sets back [s]
  Trajectories trajectories_;
  TimedCommands efforts_, set_points_;
  bool stopped_ = false;  ///< by ~emergency_stop
  std::chrono::steady_clock::time_point last_warning_;
  int unreported_ = 0;  ///< refused commands since the last warning
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace flexarm::node
