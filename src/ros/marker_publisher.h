#pragma once
/// beam_markers: the deformed beams as tubes for rviz.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"

namespace flexarm::node {

/// One tube per flexible link, in the world frame, coloured from blue (unloaded) over green to red by the stress
/// resultant; red is the largest value of that link since the start. The measure is sqrt(|N|^2 + (|M| / radius)^2) [N].
/// Computes and publishes only while somebody subscribes.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate);
  MarkerPublisher(const MarkerPublisher&) = delete;
  MarkerPublisher& operator=(const MarkerPublisher&) = delete;

  void publish(const ros::Time& stamp, bool force);

 private:
  visualization_msgs::MarkerArray make_message(const ros::Time& stamp);
  void draw_tube(std::size_t link, visualization_msgs::Marker& marker);
  double load(std::size_t link, const BeamPoint& point) const;

  const Simulation& simulation_;
  PublicationSchedule schedule_;
  ros::Time stamp_;                   ///< of the current state
  std::vector<BeamPoint> points_;     ///< scratch
  std::vector<double> largest_load_;  ///< of every link so far [N]
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
