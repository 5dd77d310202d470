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
#include "limit_watch.h"
#include "stepping/command_reader.h"
#include "stepping/stepping_thread.h"

namespace flexarm::node {

/// How commands relate to time.
struct CommandTimes {
  std::function<double(const ros::Time&)>
      time_of;               ///< converts a stamp to simulated time, which no reset sets back [s]
  double timeout = 0;        ///< a command without a duration expires after this time [s]; 0: never
  double stop_duration = 0;  ///< joints that stop following a trajectory decelerate in this time [s]; 0: at once
};

/// Subscribes to all topics of commands, and hands commands to the stepping thread:
/// - efforts: joint_force_command, joint_command, COORDINATE/command
/// - set points: joint_set_points, joint_command, COORDINATE/set_point
/// - trajectories and goals of controllers
/// - ~emergency_stop
class CommandInterface {
 public:
  /// @param shown  the node's copy of the simulation, as of the last report
  CommandInterface(ros::NodeHandle& node, ros::NodeHandle& private_node, const Simulation& shown,
                   SteppingThread& stepping, const CommandTimes& times);
  CommandInterface(const CommandInterface&) = delete;
  CommandInterface& operator=(const CommandInterface&) = delete;

  /// To be called between two steps, after the simulation has got another scene, which may have other joints. Topics of
  /// joints that exist in both scenes stay.
  void adopt_scene();
  /// To be called before links come or go.
  void renumber(const Renumbering& places) { controllers_.renumber(places); }
  /// To be called between two steps, after a reset or after another state was loaded. Drops all commands, with their
  /// expiry times. The emergency stop stays as it is, on or off.
  void forget_commands();
  /// Switches the modes of servos between two steps, of all given servos or of none. @returns an error, or ""
  std::string switch_mode(Simulation& simulation, const std::vector<std::string>& names,
                          const std::vector<std::string>& modes);
  /// Checks all goals after a report. `now`: simulated time, which no reset sets back [s].
  void judge_goals(double now) { controllers_.judge(now); }

 private:
  void receive_force_command(const JointForceCommand& message);
  void receive_joint_command(const sensor_msgs::JointState& message);
  void receive_set_points(const sensor_msgs::JointState& message);
  void receive_emergency_stop(const std_msgs::Bool& message);
  /// Why commands are refused at present, or "".
  std::string refusal() const;
  /// Subscribes to COORDINATE/`suffix`, whose messages command that quantity.
  ros::Subscriber subscribe_to(const std::string& coordinate, const std::string& suffix, Commanded quantity);

  /// Does what an accepted set point asks for beside the command.
  void note_set_point(const Command& command);
  /// Lets `read` fill `message_`, and hands it over as a whole; if it is refused, logs a warning.
  template <class Read>
  void command(const std::string& topic, const Read& read);
  void warn(const std::string& topic, const std::string& fault);
  /// Applies the emergency stop: no effort acts, neither commanded ones nor those of the scene or of servos.
  void stop(Simulation& simulation);
  void release(Simulation& simulation);
  void switch_servos(Simulation& simulation, bool on);

  ros::NodeHandle node_;
  const Simulation& shown_;
  SteppingThread& stepping_;
  CommandReader reader_;
  Controllers controllers_;
  LimitWatch limit_watch_;
  std::vector<Command> message_;  ///< commands of the message that is being read
  bool stopped_ = false;          ///< whether ~emergency_stop is on
  std::chrono::steady_clock::time_point last_warning_;
  int unreported_ = 0;  ///< refused commands since the last warning
  std::vector<ros::Subscriber> subscribers_;
  std::map<std::string, ros::Subscriber> joint_subscribers_;  ///< by the name of the topic
};

}  // namespace flexarm::node
