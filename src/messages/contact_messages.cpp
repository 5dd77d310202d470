#include "messages/contact_messages.h"

#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::messages {

ContactArray contact_message(const Simulation& simulation, const ros::Time& stamp, const std::string& frame_prefix) {
  ContactArray message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_prefix + simulation.scene().root_link;
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  for (const ActingContact& contact : contacts) {
    Contact& out = message.contacts.emplace_back();
    out.first = contact.first;
    out.second = contact.second;
    out.position = to_point(contact.position);
    out.normal = to_vector3(contact.normal);
    out.force = to_vector3(contact.force);
    out.penetration = contact.penetration;
  }
  return message;
}

}  // namespace flexarm::messages
