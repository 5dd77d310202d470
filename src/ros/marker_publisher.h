#pragma once
/// Publishes the topic beam_markers: deformed beams, arrows, trails and text for rviz.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>

#include "flexarm/simulation/simulation.h"
#include "messages/marker_messages.h"
#include "publication_schedule.h"
#include "real_time_factor.h"
#include "run_state.h"

namespace flexarm::node {

/// Computes and publishes messages only while the topic has subscribers.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                  const std::string& frame_prefix, const messages::MarkerChoice& choice);
  MarkerPublisher(const MarkerPublisher&) = delete;
  MarkerPublisher& operator=(const MarkerPublisher&) = delete;

  /// To be called after the simulation has got another scene: the markers of the old scene are deleted.
  void adopt_scene();
  /// Sets the rate [Hz] and restarts the schedule: the next message may have any stamp, even an earlier one.
  void set_rate(double rate) { schedule_ = PublicationSchedule(rate); }
  void publish(const ros::Time& stamp, bool force);
  /// To be called after a reset: scales are chosen again, and trails start empty.
  void begin_anew() { messages_->begin_anew(); }

 private:
  visualization_msgs::MarkerArray make_message();

  const Simulation& simulation_;
  const RunState& run_;
  std::string frame_prefix_;
  messages::MarkerChoice choice_;
  PublicationSchedule schedule_;
  std::optional<messages::MarkerMessages> messages_;
  RealTimeFactor real_time_factor_{RealTimeFactor::Clock::now()};
  ros::Time stamp_;  ///< of the current state
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
