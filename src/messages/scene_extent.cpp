#include "messages/scene_extent.h"

#include <Eigen/Geometry>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::messages {

SceneExtent scene_extent(const Simulation& simulation) {
  Eigen::AlignedBox3d box;
  std::vector<BeamPoint> points;
  for (std::size_t link = 0; link < simulation.link_names().size(); ++link) {
    const Pose frame = simulation.link_pose(link);
    box.extend(frame.position);
    const scene::LinkDescription& description = simulation.scene().links[link];
    if (description.beam)
      simulation.beam_points(link, 0, points);
    else if (description.inertial)
      box.extend(frame * description.inertial->center_of_mass);
  }
  for (const BeamPoint& point : points) box.extend(point.pose.position);
  const double radius = 0.5 * box.diagonal().norm();
  return {box.center(), radius > 0 ? radius : 1};
}

}  // namespace flexarm::messages
