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
#include <map>
#include <string>
#include <vector>

#include "controllers.h"
#include "flexarm/simulation/simulation.h"
#include "stepping/command_reader.h"
#include "stepping/stepping_thread.h"

namespace flexarm::node {

/// What commands are told of time.
struct CommandTimes {
  std::function<double(const ros::Time&)> time_of;  ///< simulated, that no reset sets back, of a stamp [s]
  double timeout = 0;        ///< a command expires after it, unless that names a duration [s]; 0: never
  double stop_duration = 0;  ///< in which joints on trajectories decelerate that are to stop [s]; 0: at once
};

/// Hands commands to the thread that steps: efforts of joint_force_command, joint_command and COORDINATE/command, set
/// points of joint_set_points, joint_command and COORDINATE/set_point; trajectories and goals of controllers; and
/// ~emergency_stop.
class CommandInterface {
 public:
  /// @param shown  what is stepped, as reports have it
  CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown,
                   SteppingThread& stepping, const CommandTimes& times);
  CommandInterface(const CommandInterface&) = delete;
  CommandInterface& operator=(const CommandInterface&) = delete;

  /// Between two steps: the simulation is of another scene now, which may have other joints. Topics that both have
  /// stay.
  void adopt_scene();
  /// Coordinates from this one on go with the next scene, or get other places: what they follow is over.
  void let_go_from(std::size_t coordinate);
  /// Between two steps, after a reset, or where another state was loaded: no command expires; an emergency stop, or
  /// none, still is in force.
  void forget_commands();
  /// Between two steps: switches the modes of servos, all or none. @returns why not, or nothing
  std::string switch_mode(Simulation& simulation, const std::vector<std::string>& names,
                          const std::vector<std::string>& modes);
  /// After a report, of the time `now`: simulated, not set back [s].
  void judge_goals(double now) { controllers_.judge(now); }

 private:
  void receive_force_command(const JointForceCommand& message);
  void receive_joint_command(const sensor_msgs::JointState& message);
  void receive_set_points(const sensor_msgs::JointState& message);
  void receive_emergency_stop(const std_msgs::Bool& message);
  /// Why nothing may be commanded now, or nothing.
  std::string refusal() const;
  /// COORDINATE/`suffix`, each message of which commands that quantity.
  ros::Subscriber subscribe_to(const std::string& coordinate, const std::string& suffix, Commanded quantity);

  /// Hands over what `read` reads into `message_`, whole, or warns.
  template <class Read>
  void command(const std::string& topic, const Read& read);
  void warn(const std::string& topic, const std::string& fault);
  /// While the emergency stop is on, no effort acts, be it commanded, the scene's own or a servo's.
  void stop(Simulation& simulation);
  void release(Simulation& simulation);
  void switch_servos(Simulation& simulation, bool on);

  ros::NodeHandle node_;
  const Simulation& shown_;
  SteppingThread& stepping_;
  CommandReader reader_;
  Controllers controllers_;
  std::vector<Command> message_;  ///< the one at hand
  bool stopped_ = false;          ///< by ~emergency_stop
  std::chrono::steady_clock::time_point last_warning_;
  int unreported_ = 0;  ///< refused commands since the last warning
  std::vector<ros::Subscriber> subscribers_;
  std::map<std::string, ros::Subscriber> joint_subscribers_;  ///< by topic
};

}  // namespace flexarm::node
