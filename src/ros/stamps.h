#pragma once
/// Stamps in ROS time, where this node is not the clock.

#include <ros/time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace flexarm::node {

/// Steps that keep pace with the wall clock are when they were due by it: as even as simulated time is, whatever delays
/// a step or a message. Others are the present. Each stamp is later than the one before.
class Stamps {
 public:
  /// By which stamps and ROS time may come apart [s]: a backlog that is made up makes less; more, that somebody has set
  /// the clock, forth or back.
  static constexpr double kLargestError = 1;

  /// @param period  of steps by the wall clock [s]
  explicit Stamps(double period) : period_(period) {}

  /// The stamp of a state. `now`: in ROS time. `steps`: those made and those dropped, since the beginning. `since_due`:
  /// where the step keeps pace, how long ago it was to begin [s]. `largest_lead`: farther than this the last stamp is
  /// not ahead of `now`, unless somebody has set ROS time back [s].
  /// @returns false if he has, and stamps with it
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
  /// Zero: there is none yet.
  const ros::Time& last() const { return stamp_; }
  /// Steps are counted anew, from the next one on.
  void restart() { is_mapped_ = false; }
  /// Of the steps to come [s].
  void set_period(double period) {
    period_ = period;
    restart();
  }

 private:
  double period_;
  ros::Time stamp_, origin_;  // the last one, and the one from which due steps are counted
  std::uint64_t origin_steps_ = 0;
  bool is_mapped_ = false;
};

}  // namespace flexarm::node
