#pragma once
/// The deformed beams of a simulation as tubes for rviz.

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "messages/scene_extent.h"

namespace flexarm::messages {

/// One tube per flexible link, in the root frame, coloured from blue (unloaded) over green to red by the strain at the
/// edge of the section, and a legend. One scale serves all links: red is the largest strain that was shown since the
/// start or the last reset.
class MarkerMessages {
 public:
  /// The simulation must outlive this.
  MarkerMessages(const Simulation& simulation, const std::string& root_frame);

  visualization_msgs::MarkerArray make(const ros::Time& stamp);
  /// After a reset: the scale of the colours begins anew.
  void forget_largest_strain() { largest_strain_ = 0; }

 private:
  void draw_beam(std::size_t link, visualization_msgs::Marker& marker) const;

  const Simulation& simulation_;
  std::string root_frame_;
  SceneExtent extent_;                          ///< of the initial configuration
  std::vector<std::vector<BeamPoint>> points_;  ///< of every link; scratch
  double largest_strain_ = 0;
};

}  // namespace flexarm::messages
