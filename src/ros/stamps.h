#pragma once
/// Stamps in ROS time, for a node that does not publish /clock.

#include <ros/time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace flexarm::node {

/// If a step keeps pace with the wall clock, its stamp is the time at which it was due. So stamps are as evenly spaced
/// as simulated time, even if a step or a message is late. Otherwise the stamp is the present ROS time. Each stamp is
/// later than the one before, unless ROS time was set back.
class Stamps {
 public:
  /// Largest difference between a due time and the present ROS time [s]. A backlog of steps makes less. If the
  /// difference is larger, somebody has set the clock, forward or back.
  static constexpr double kLargestError = 1;

  /// @param period  wall time from one step to the next [s]
  explicit Stamps(double period) : period_(period) {}

  /// Computes the stamp of a state.
  /// @param now           ROS time
  /// @param steps         steps made and dropped since the start
  /// @param since_due     for a step that keeps pace: how long ago it was due to begin [s]
  /// @param largest_lead  if the last stamp is farther ahead of `now`, somebody has set ROS time back [s]
  /// @returns false if somebody has set ROS time back, and the stamp with it
  [[nodiscard]] bool advance(const ros::Time& now, std::uint64_t steps, std::optional<double> since_due,
                             double largest_lead) {
    const ros::Time present = since_due ? now - ros::Duration(*since_due) : now;
    const ros::Time soonest = stamp_ + ros::Duration(0, 1);
    const bool is_set_back = (stamp_ - now).toSec() > largest_lead;
    if (since_due && is_mapped_) {
      const ros::Time due = origin_ + ros::Duration(static_cast<double>(steps - origin_steps_) * period_);
      if (due >= soonest && std::abs((due - present).toSec()) < kLargestError) {
        stamp_ = due;
        return true;
      }
    }
    origin_ = present;
    origin_steps_ = steps;
    is_mapped_ = since_due.has_value();
    stamp_ = is_set_back ? present : std::max(present, soonest);
    return !is_set_back;
  }
  /// The last stamp; zero if there is none yet.
  const ros::Time& last() const { return stamp_; }
  /// The count of due steps begins with the next step.
  void restart() { is_mapped_ = false; }
  /// Sets the wall time from one step to the next [s].
  void set_period(double period) {
    period_ = period;
    restart();
  }

 private:
  double period_;
  ros::Time stamp_, origin_;  // the last stamp; the stamp from which due steps are counted
  std::uint64_t origin_steps_ = 0;
  bool is_mapped_ = false;
};

}  // namespace flexarm::node
