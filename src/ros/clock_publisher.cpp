#include "clock_publisher.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>

#include "advertise.h"

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kPatience(3);
/// By which stamps and ROS time may come apart [s]: a backlog that is made up makes less; more, that somebody has set
/// the clock, forth or back. Stamps of who follows another clock are ahead of it by nanoseconds only.
constexpr double kLargestError = 1, kLargestLead = 1e-3;

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step,
                               double period)
    : is_clock_(publish), rate_(rate), step_(step), period_(period), time_(step), schedule_(rate) {
  time_.advance();
  if (!is_clock_) return;
  publisher_ = advertise<rosgraph_msgs::Clock>(node, "/clock", 10, run, [this] { return make_message(); });
  if (!ros::Time::isSimTime())
    ROS_WARN("publishing /clock, but /use_sim_time is not set: other nodes will not follow it");
}

bool ClockPublisher::advance(std::uint64_t steps, std::uint64_t overruns, bool is_paced) {
  ticks_ += std::max<std::uint64_t>(steps, 1);
  time_.advance(std::max<std::uint64_t>(steps, 1));
  if (!is_clock_) return move_stamp(overruns, is_paced && !ros::Time::isSimTime());
  publish(false);
  return true;
}

void ClockPublisher::set_pace(double step, double period) {
  step_ = step;
  period_ = period;
  time_.set_step(step);
  restart();
}

void ClockPublisher::begin_anew() {
  time_ = SteppedTime(step_);
  time_.advance();
  schedule_ = PublicationSchedule(rate_);
}

bool ClockPublisher::move_stamp(std::uint64_t overruns, bool is_paced) {
  const ros::Time now = ros::Time::now();
  if (now.isZero()) return true;
  const ros::Time soonest = stamp_ + ros::Duration(0, 1);
  const std::uint64_t steps = ticks_ + overruns;
  const bool is_set_back = (stamp_ - now).toSec() > (ros::Time::isSimTime() ? kLargestLead : kLargestError);
  if (is_paced && is_mapped_) {
    const ros::Time due = origin_ + ros::Duration(static_cast<double>(steps - origin_steps_) * period_);
    if (due >= soonest && std::abs((due - now).toSec()) < kLargestError) {
      stamp_ = due;
      return true;
    }
  }
  stamp_ = origin_ = is_set_back ? now : std::max(now, soonest);
  origin_steps_ = steps;
  is_mapped_ = is_paced;
  return !is_set_back;
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
  const ros::Time stamp = is_clock_ ? simulated_time() : stamp_;
  if (stamp.isZero()) return std::nullopt;
  return stamp;
}

void ClockPublisher::warn_if_missing() {
  if (warned_ || stamp() || std::chrono::steady_clock::now() - start_ < kPatience) return;
  warned_ = true;
  ROS_WARN("/use_sim_time is set, but nobody publishes /clock: nothing is published until somebody does");
}

}  // namespace flexarm::node
