#pragma once
/// Makes markers for rviz of links that have neither `<visual>` nor beam: the shapes of their `<collision>`, or else
/// balls at centres of mass, and lines to them and to the links that they carry.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <vector>

#include "flexarm/scene/visual_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

class BareLinkMarkers {
 public:
  /// The simulation must outlive this object. @param scene_radius  to which sizes are relative [m]
  BareLinkMarkers(const Simulation& simulation, double scene_radius);
  /// Adds markers of the namespace `masses`: each shape, each ball, and one marker for all lines.
  void add_to(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) const;

 private:
  struct BareLink {
    std::size_t link;
    std::vector<scene::VisualDescription> shapes;  ///< no meshes
    std::vector<Vector3> ends;                     ///< of lines from the link's origin, in its frame
  };

  const Simulation& simulation_;
  double stick_width_;  ///< [m]
  std::vector<BareLink> links_;
};

}  // namespace flexarm::messages
