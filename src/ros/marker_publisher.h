#pragma once
/// beam_markers: the deformed beams as tubes for rviz.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "messages/marker_messages.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// Computes and publishes only while somebody subscribes.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                  const std::string& frame_prefix);
  MarkerPublisher(const MarkerPublisher&) = delete;
  MarkerPublisher& operator=(const MarkerPublisher&) = delete;

  /// The simulation is of another scene now: what is drawn of the one before is taken away.
  void adopt_scene();
  /// Begins anew at a rate [Hz], with any stamp.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  void publish(const ros::Time& stamp, bool force);
  /// After a reset: the scale of the colours begins anew.
  void forget_largest_strain() { messages_->forget_largest_strain(); }

 private:
  const Simulation& simulation_;
  std::string frame_prefix_;
  PublicationSchedule schedule_;
  std::optional<messages::MarkerMessages> messages_;
  ros::Time stamp_;  ///< of the current state
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
