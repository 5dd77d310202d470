#pragma once
/// Helpers to publish topics: late subscribers are served, and messages are made only for topics with subscribers.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <cstdint>
#include <string>

#include "run_state.h"

namespace flexarm::node {

/// Advertises a topic. While the simulation is paused, or waits for a command in lock step, a new subscriber gets
/// `make_message()` at once, since no regular message may come for long. The topic is not latched, because a latched
/// message may reach a subscriber twice if it connects just after the message was sent, and each stamp must be sent
/// only once.
template <typename Message, typename MakeMessage>
ros::Publisher advertise(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue_size, const RunState& run,
                         MakeMessage make_message) {
  return node.advertise<Message>(topic, queue_size,
                                 [&run, make_message](const ros::SingleSubscriberPublisher& subscriber) {
                                   if (run.waits()) subscriber.publish(make_message());
                                 });
}

/// Makes a message with `make_message()` and publishes it, but only if the topic has subscribers.
template <typename MakeMessage>
void publish_to_listeners(const ros::Publisher& publisher, const MakeMessage& make_message) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(make_message());
}

}  // namespace flexarm::node
