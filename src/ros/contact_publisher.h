#pragma once
/// Publishes the topics ~contacts and ~contacts_state: which links touch each other, where, and with what force.

#include <flexarm/ContactArray.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Has topics only if the scene has contacts. Computes and publishes only while a topic has subscribers.
/// ~contacts_state has the same content in the format of Gazebo; it exists if the node was built with gazebo_msgs.
class ContactPublisher {
 public:
  ContactPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run, double rate,
                   const std::string& frame_prefix);
  ContactPublisher(const ContactPublisher&) = delete;
  ContactPublisher& operator=(const ContactPublisher&) = delete;

  /// To be called after the simulation has got another scene.
  void adopt_scene();
  /// Sets the rate [Hz] and restarts the schedule: the next message may have any stamp, even an earlier one.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  void publish(const ros::Time& stamp, bool force);

 private:
  ContactArray make_message() const;

  ros::NodeHandle node_;
  const Simulation& simulation_;
  const RunState& run_;
  PublicationSchedule schedule_;
  std::string frame_prefix_;
  ros::Time stamp_;  ///< of the current state
  ros::Publisher publisher_, gazebo_publisher_;
};

}  // namespace flexarm::node
