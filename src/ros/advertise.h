#pragma once
/// Topics that also serve who comes late.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>

#include <cstdint>
#include <string>

#include "run_state.h"

namespace flexarm::node {

/// Advertises a topic on which a new subscriber gets `make_message()` at once while the simulation is paused, or waits
/// for a command, when nothing is sent that it could wait for. This is not latching: latched messages may reach a
/// subscriber a second time if it connects just after they were sent, and no stamp is to be sent twice.
template <typename Message, typename MakeMessage>
ros::Publisher advertise(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue_size, const RunState& run,
                         MakeMessage make_message) {
  return node.advertise<Message>(topic, queue_size,
                                 [&run, make_message](const ros::SingleSubscriberPublisher& subscriber) {
                                   if (run.waits()) subscriber.publish(make_message());
                                 });
}

/// Publishes what `make_message()` gives, which is made only where somebody listens.
template <typename MakeMessage>
void publish_to_listeners(const ros::Publisher& publisher, const MakeMessage& make_message) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(make_message());
}

}  // namespace flexarm::node
