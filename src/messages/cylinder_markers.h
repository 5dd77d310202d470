#pragma once
/// Makes markers for rviz of cylinders, whose parts are not in the robot description that rviz shows.

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flexarm/scene/visual_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

class CylinderMarkers {
 public:
  /// The simulation must outlive this object.
  explicit CylinderMarkers(const Simulation& simulation);
  /// Adds a marker for each barrel and rod; the namespace is the link's name.
  void add_to(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) const;

 private:
  struct Part {
    std::size_t link;
    scene::VisualDescription visual;
  };
  void add_parts(const std::string& link);

  const Simulation& simulation_;
  std::vector<Part> parts_;
};

}  // namespace flexarm::messages
