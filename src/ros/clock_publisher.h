#pragma once
/// The time that goes on every message, and /clock.

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

/// The source of stamps. Where this node publishes /clock, they are simulated time, which starts at one step, because
/// zero means "no time yet" in ROS, and goes on across resets. Else steps that keep pace with the wall clock are when
/// they were due by it, in ROS time: as even as simulated time is, whatever delays a message. Others, and those of who
/// follows another clock, are the present.
class ClockPublisher {
 public:
  using WallTime = std::chrono::steady_clock::time_point;

  /// @param publish  whether this node is the clock
  /// @param rate     of /clock, in simulated time [Hz]
  /// @param step     [s]
  /// @param period   of steps by the wall clock [s]
  ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step, double period);
  ClockPublisher(const ClockPublisher&) = delete;
  ClockPublisher& operator=(const ClockPublisher&) = delete;

  /// Steps were made; publishes /clock where it is due. `due`: when the last one was to begin, if they keep pace with
  /// the wall clock, which has left out `overruns` since the beginning. @returns false if somebody has set ROS time
  /// back, and stamps with it
  [[nodiscard]] bool advance(std::uint64_t steps, std::uint64_t overruns, std::optional<WallTime> due);
  /// Publishes /clock as it is, unless that was done already.
  void publish_now();
  /// Stamp of the current state; empty as long as ROS has no time.
  std::optional<ros::Time> stamp() const;
  /// The simulation was resumed: due steps are counted from the next one on.
  void restart() { stamps_.restart(); }
  /// Of the steps to come, as of the constructor [s].
  void set_pace(double step, double period);
  bool is_clock() const { return is_clock_; }
  /// Simulated time starts again at one step; /clock jumps back.
  void begin_anew();
  /// Warns once of a clock that does not come: without it, nothing is published.
  void warn_if_missing();

 private:
  void publish(bool force);
  rosgraph_msgs::Clock make_message() const;
  /// The next stamp, or false.
  bool move_stamp(std::uint64_t overruns, std::optional<WallTime> due);
  ros::Time simulated_time() const { return ros::Time(time_.seconds()); }

  bool is_clock_;
  double rate_, step_;
  std::uint64_t ticks_ = 1;  ///< steps
  SteppedTime time_;         ///< the same
  Stamps stamps_;            ///< where this node is not the clock
  PublicationSchedule schedule_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool warned_ = false;
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
