#pragma once
/// Makes the stamps of all messages, and publishes /clock.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <cstdint>
#include <optional>

#include "publication_schedule.h"
#include "run_state.h"
#include "stamps.h"
#include "stepping/stepped_time.h"

namespace flexarm::node {

/// The source of stamps. There are three cases:
/// - If this node publishes /clock, stamps are simulated time. It starts at one step, because zero means "no time yet"
///   in ROS, and continues across resets.
/// - Else, if steps keep pace with the wall clock, a stamp is the ROS time at which the step was due. So stamps are as
///   evenly spaced as simulated time, even if a message is late.
/// - Else (no pace, or another node publishes /clock), a stamp is the present ROS time.
class ClockPublisher {
 public:
  using WallTime = std::chrono::steady_clock::time_point;

  /// @param publish  whether this node publishes /clock
  /// @param rate     of /clock, in simulated time [Hz]
  /// @param step     length of a step, simulated time [s]
  /// @param period   wall time from one step to the next [s]
  ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step, double period);
  ClockPublisher(const ClockPublisher&) = delete;
  ClockPublisher& operator=(const ClockPublisher&) = delete;

  /// Moves the stamp on after `steps` steps; publishes /clock if it is due.
  /// @param overruns  steps dropped since the node started
  /// @param due       when the last step was due to begin, if steps keep pace with the wall clock
  /// @returns false if somebody has set ROS time back, which sets the stamps back, too
  [[nodiscard]] bool advance(std::uint64_t steps, std::uint64_t overruns, std::optional<WallTime> due);
  /// Publishes the present /clock, unless it was already published.
  void publish_now();
  /// Stamp of the current state; empty while ROS has no time yet.
  std::optional<ros::Time> stamp() const;
  /// To be called when the simulation is resumed: the count of due steps begins with the next step.
  void restart() { stamps_.restart(); }
  /// Sets `step` and `period` of the constructor for the steps to come [s].
  void set_pace(double step, double period);
  bool is_clock() const { return is_clock_; }
  /// Simulated time starts again at one step, so /clock jumps back.
  void begin_anew();
  /// Warns once if /use_sim_time is set but nobody publishes /clock, since then the node publishes nothing.
  void warn_if_missing();

 private:
  void publish(bool force);
  rosgraph_msgs::Clock make_message() const;
  /// Moves stamps_ on by ROS time. @returns false if somebody has set ROS time back
  bool move_stamp(std::uint64_t overruns, std::optional<WallTime> due);
  ros::Time simulated_time() const { return ros::Time(time_.seconds()); }

  bool is_clock_;
  double rate_, step_;
  std::uint64_t ticks_ = 1;  ///< number of steps, plus one
  SteppedTime time_;         ///< simulated time of ticks_ steps
  Stamps stamps_;            ///< used if this node does not publish /clock
  PublicationSchedule schedule_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool warned_ = false;
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
