#pragma once
/// beam_markers: the deformed beams as tubes for rviz.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "publication_schedule.h"
#include "run_state.h"
#include "scene_extent.h"

namespace flexarm::node {

/// One tube per flexible link, in the root frame, coloured from blue (unloaded) over green to red by the strain at the
/// edge of the section, and a legend. One scale serves all links: red is the largest strain that was shown since the
/// start or the last reset. Computes and publishes only while somebody subscribes.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle& node, const Simulation& simulation, const RunState& run, double rate,
                  const std::string& root_frame);
  MarkerPublisher(const MarkerPublisher&) = delete;
  MarkerPublisher& operator=(const MarkerPublisher&) = delete;

  void publish(const ros::Time& stamp, bool force);
  /// After a reset: the scale of the colours begins anew.
  void forget_largest_strain() { largest_strain_ = 0; }

 private:
  visualization_msgs::MarkerArray make_message(const ros::Time& stamp);
  void draw_beam(std::size_t link, visualization_msgs::Marker& marker) const;

  const Simulation& simulation_;
  PublicationSchedule schedule_;
  std::string root_frame_;
  SceneExtent extent_;                          ///< of the initial configuration
  ros::Time stamp_;                             ///< of the current state
  std::vector<std::vector<BeamPoint>> points_;  ///< of every link; scratch
  double largest_strain_ = 0;
  ros::Publisher publisher_;
};

}  // namespace flexarm::node
