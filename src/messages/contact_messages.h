#pragma once
/// Makes messages of contacts.

#include <flexarm/ContactArray.h>
#include <ros/time.h>

#include <string>

#include "flexarm/simulation/simulation.h"
#include "messages/conversions.h"

namespace flexarm::messages {

/// All present contact points, in the root link's frame.
ContactArray contact_message(const Simulation& simulation, const ros::Time& stamp, const std::string& frame_prefix);

/// The same as a gazebo_msgs/ContactsState or another type with its fields: one state for each pair that touches.
/// Wrenches act on the first body of a pair. Each point's wrench has only a force. The total wrench refers to the
/// origin of the frame.
template <class ContactsState>
ContactsState gazebo_message(const ContactArray& contacts) {
  ContactsState message;
  message.header = contacts.header;
  for (const Contact& contact : contacts.contacts) {
    auto& states = message.states;
    if (states.empty() || states.back().collision1_name != contact.first ||
        states.back().collision2_name != contact.second) {
      states.emplace_back();
      states.back().collision1_name = contact.first;
      states.back().collision2_name = contact.second;
    }
    auto& state = states.back();
    const Vector3 place = to_vector(contact.position), force = to_vector(contact.force);
    state.contact_positions.push_back(to_vector3(place));
    state.contact_normals.push_back(contact.normal);
    state.depths.push_back(contact.penetration);
    state.wrenches.emplace_back();
    state.wrenches.back().force = contact.force;
    state.total_wrench.force = to_vector3(to_vector(state.total_wrench.force) + force);
    state.total_wrench.torque = to_vector3(to_vector(state.total_wrench.torque) + place.cross(force));
  }
  return message;
}

}  // namespace flexarm::messages
