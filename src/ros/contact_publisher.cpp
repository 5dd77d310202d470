#include "contact_publisher.h"

#ifdef FLEXARM_HAS_GAZEBO_MSGS
#include <gazebo_msgs/ContactsState.h>
#endif

#include "advertise.h"
#include "flexarm/scene/scene_description.h"
#include "messages/contact_messages.h"

namespace flexarm::node {

ContactPublisher::ContactPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run,
                                   double rate, const std::string& frame_prefix)
    : node_(private_node), simulation_(simulation), run_(run), schedule_(rate), frame_prefix_(frame_prefix) {
  adopt_scene();
}

void ContactPublisher::adopt_scene() {
  if (simulation_.scene().contacts.empty()) {
    publisher_ = gazebo_publisher_ = {};
    return;
  }
  if (publisher_) return;
  publisher_ = advertise<ContactArray>(node_, "contacts", 10, run_, [this] { return make_message(); });
#ifdef FLEXARM_HAS_GAZEBO_MSGS
  gazebo_publisher_ = advertise<gazebo_msgs::ContactsState>(node_, "contacts_state", 10, run_, [this] {
    return messages::gazebo_message<gazebo_msgs::ContactsState>(make_message());
  });
#endif
}

void ContactPublisher::publish(const ros::Time& stamp, bool force) {
  if (!publisher_ || !schedule_.due(stamp, force)) return;
  stamp_ = stamp;
  publish_to_listeners(publisher_, [this] { return make_message(); });
#ifdef FLEXARM_HAS_GAZEBO_MSGS
  publish_to_listeners(gazebo_publisher_,
                       [this] { return messages::gazebo_message<gazebo_msgs::ContactsState>(make_message()); });
#endif
}

ContactArray ContactPublisher::make_message() const {
  return messages::contact_message(simulation_, stamp_, frame_prefix_);
}

}  // namespace flexarm::node
