#include "clock_publisher.h"

#include <ros/console.h>
#include <rosgraph_msgs/Clock.h>

namespace flexarm::node {

ClockPublisher::ClockPublisher(ros::NodeHandle& node, bool publish, double rate, double step)
    : is_clock_(publish), step_(step), schedule_(rate) {
  if (!is_clock_) return;
  publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10, true);
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
  rosgraph_msgs::Clock message;
  message.clock = simulated_time();
  publisher_.publish(message);
}

std::optional<ros::Time> ClockPublisher::stamp() const {
  const ros::Time now = is_clock_ ? simulated_time() : ros::Time::now();
  if (now.isZero()) return std::nullopt;
  return now;
}

}  // namespace flexarm::node
