#pragma once
/// Decides when a topic is due.

#include <ros/time.h>

namespace flexarm::node {

/// Limits publications to a rate, measured by the stamps, and never lets a stamp pass twice.
class PublicationSchedule {
 public:
  explicit PublicationSchedule(double rate) : period_(1 / rate) {}

  /// True if a message with this stamp should be sent. With `force` the rate does not matter, but the stamp must be
  /// new.
  bool due(const ros::Time& stamp, bool force = false) {
    if (stamp <= last_ || (stamp + kRoundOff < next_ && !force)) return false;
    last_ = stamp;
    // After a gap, after a forced message, or for round-off: the next period begins at this stamp.
    const bool is_early = stamp < next_;
    next_ += period_;
    if (is_early || next_ <= stamp) next_ = stamp + period_;
    return true;
  }
  const ros::Time& last() const { return last_; }

 private:
  // Stamps and periods are whole nanoseconds.
  static inline const ros::Duration kRoundOff{0, 10};

  ros::Duration period_;
  ros::Time last_, next_;
};

}  // namespace flexarm::node
