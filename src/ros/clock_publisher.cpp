#include "clock_publisher.h"

#include <ros/console.h>

#include <algorithm>

#include "advertise.h"

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kPatience(3);
/// If the node follows another clock, its stamps are ahead of that clock by nanoseconds at most. A larger lead means
/// that the clock was set back [s].
constexpr double kLargestLead = 1e-3;

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step,
                               double period)
    : is_clock_(publish), rate_(rate), step_(step), time_(step), stamps_(period), schedule_(rate) {
  time_.advance();
  if (!is_clock_) return;
  publisher_ = advertise<rosgraph_msgs::Clock>(node, "/clock", 10, run, [this] { return make_message(); });
  if (!ros::Time::isSimTime())
    ROS_WARN("publishing /clock, but /use_sim_time is not set: other nodes will not follow it");
}

bool ClockPublisher::advance(std::uint64_t steps, std::uint64_t overruns, std::optional<WallTime> due) {
  ticks_ += std::max<std::uint64_t>(steps, 1);
  time_.advance(std::max<std::uint64_t>(steps, 1));
  if (!is_clock_) return move_stamp(overruns, ros::Time::isSimTime() ? std::nullopt : due);
  publish(false);
  return true;
}

void ClockPublisher::set_pace(double step, double period) {
  step_ = step;
  time_.set_step(step);
  stamps_.set_period(period);
}

void ClockPublisher::begin_anew() {
  time_ = SteppedTime(step_);
  time_.advance();
  schedule_ = PublicationSchedule(rate_);
}

bool ClockPublisher::move_stamp(std::uint64_t overruns, std::optional<WallTime> due) {
  const ros::Time now = ros::Time::now();
  if (now.isZero()) return true;
  std::optional<double> since_due;
  if (due) since_due = std::chrono::duration<double>(WallTime::clock::now() - *due).count();
  return stamps_.advance(now, ticks_ + overruns, since_due,
                         ros::Time::isSimTime() ? kLargestLead : Stamps::kLargestError);
}

void ClockPublisher::publish_now() {
  publish(true);
}

void ClockPublisher::publish(bool force) {
  if (!is_clock_ || !schedule_.due(simulated_time(), force)) return;
  publisher_.publish(make_message());
}

rosgraph_msgs::Clock ClockPublisher::make_message() const {
  rosgraph_msgs::Clock message;
  message.clock = simulated_time();
  return message;
}

std::optional<ros::Time> ClockPublisher::stamp() const {
  const ros::Time stamp = is_clock_ ? simulated_time() : stamps_.last();
  if (stamp.isZero()) return std::nullopt;
  return stamp;
}

void ClockPublisher::warn_if_missing() {
  if (warned_ || stamp() || std::chrono::steady_clock::now() - start_ < kPatience) return;
  warned_ = true;
  ROS_WARN("/use_sim_time is set, but no node publishes /clock: nothing is published until one does");
}

}  // namespace flexarm::node
