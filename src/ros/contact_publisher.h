#pragma once
/// ~contacts: what touches what.

#include <flexarm/ContactArray.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Has topics where the scene has contacts; computes and publishes only while somebody subscribes. Where gazebo_msgs
/// was there at build time, ~contacts_state has the same in the form that programs for Gazebo look for.
class ContactPublisher {
 public:
  ContactPublisher(ros::NodeHandle& private_node, const Simulation& simulation, const RunState& run, double rate,
                   const std::string& frame_prefix);
  ContactPublisher(const ContactPublisher&) = delete;
  ContactPublisher& operator=(const ContactPublisher&) = delete;

  /// The simulation is of another scene now.
  void adopt_scene();
  /// Begins anew at a rate [Hz], with any stamp.
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
