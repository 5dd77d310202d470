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

namespace flexarm::node {

/// The source of stamps: simulated time where this node publishes /clock, ROS time otherwise.
/// Simulated time starts at one step, because zero means "no time yet" in ROS, and goes on across resets.
class ClockPublisher {
 public:
  /// @param publish  whether this node is the clock
  /// @param rate     of /clock, in simulated time [Hz]
  /// @param step     [s]
  ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step);
  ClockPublisher(const ClockPublisher&) = delete;
  ClockPublisher& operator=(const ClockPublisher&) = delete;

  /// One step was made; publishes /clock where it is due.
  void advance();
  /// Publishes /clock as it is, unless that was done already.
  void publish_now();
  /// Stamp of the current state; empty as long as ROS has no time.
  std::optional<ros::Time> stamp() const;
  /// Warns once of a clock that does not come: without it, nothing is published.
  void warn_if_missing();

 private:
  void publish(bool force);
  rosgraph_msgs::Clock make_message() const;
  ros::Time simulated_time() const { return ros::Time(static_cast<double>(ticks_) * step_); }

  bool is_clock_;
  double step_;
  std::uint64_t ticks_ = 1;  ///< steps, counted as an integer so that no rounding accumulates
  PublicationSchedule schedule_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool warned_ = false;
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
