#include "clock_publisher.h"

#include <ros/console.h>

#include "advertise.h"

namespace flexarm::node {
namespace {

constexpr std::chrono::seconds kPatience(3);

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node, const RunState& run, bool publish, double rate, double step)
    : is_clock_(publish), step_(step), schedule_(rate) {
  if (!is_clock_) return;
  publisher_ = advertise<rosgraph_msgs::Clock>(node, "/clock", 10, run, [this] { return make_message(); });
  if (!ros::Time::isSimTime())
    ROS_WARN("publishing /clock, but /use_sim_time is not set: other nodes will not follow it");
}

void ClockPublisher::advance() {
  ++ticks_;
  publish(false);
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
  const ros::Time now = is_clock_ ? simulated_time() : ros::Time::now();
  if (now.isZero()) return std::nullopt;
  return now;
}

void ClockPublisher::warn_if_missing() {
  if (warned_ || stamp() || std::chrono::steady_clock::now() - start_ < kPatience) return;
  warned_ = true;
  ROS_WARN("/use_sim_time is set, but nobody publishes /clock: nothing is published until somebody does");
}

}  // namespace flexarm::node
