#include "pictures/bare_links.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace flexarm::pictures {

std::optional<MassBall> mass_ball(const scene::LinkDescription& link) {
  if (!link.inertial || !(link.inertial->mass > 0)) return std::nullopt;
  // A ball has the moment 2/5 m r^2 about each axis.
  const double mean_moment = link.inertial->inertia.trace() / 3;
  return MassBall{link.inertial->center_of_mass, std::sqrt(std::max(2.5 * mean_moment / link.inertial->mass, 0.0))};
}

double shown_radius(const MassBall& ball, double scene_radius) {
  constexpr double kSmallest = 0.02, kLargest = 0.06;
  return std::clamp(ball.radius, kSmallest * scene_radius, kLargest * scene_radius);
}

std::vector<std::vector<Vector3>> carried_places(const Simulation& simulation) {
  const scene::SceneDescription& scene = simulation.scene();
  std::map<std::string, std::size_t> links;
  for (std::size_t i = 0; i < scene.links.size(); ++i) links[scene.links[i].name] = i;
  std::vector<std::vector<Vector3>> places(scene.links.size());
  for (const scene::JointDescription& joint : scene.joints) {
    if (joint.kind == scene::JointKind::Floating || joint.kind == scene::JointKind::Planar) continue;
    const std::size_t parent = links.at(joint.parent), child = links.at(joint.child);
    places[parent].push_back(simulation.link_pose(parent).inverse() * simulation.link_pose(child).position);
  }
  return places;
}

}  // namespace flexarm::pictures
