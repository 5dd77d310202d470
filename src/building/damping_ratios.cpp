#include "building/damping_ratios.h"

#include <algorithm>
#include <cmath>

#include "building/articulated_inertia.h"
#include "building/scene_plan.h"
#include "flexarm/model/model_error.h"

namespace flexarm {
namespace {

/// The coordinate's actuator, which it has.
Actuator& actuator_of(const std::string& coordinate, Model& model) {
  const auto is_its = [&](const Actuator& actuator) {
    return model.coordinates[actuator.coordinate].name == coordinate;
  };
  return *std::find_if(model.actuators.begin(), model.actuators.end(), is_its);
}

/// `where`: begins the message if the inertia is not known.
double damper(double ratio, double stiffness, double inertia, const std::string& where) {
  if (inertia > 0) return 2 * ratio * std::sqrt(stiffness * inertia);
  throw ModelError(
      where +
      "damping_ratio needs the inertia that the joint moves, which is not known in mechanisms with loops, on "
      "slides, and where other joints follow it; give the damping itself, that of the joint's <dynamics> or "
      "of the gear");
}

}  // namespace

void set_damping_ratios(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model) {
  const auto has_ratio = [](const auto& description) { return description.damping_ratio > 0; };
  if (std::none_of(scene.springs.begin(), scene.springs.end(), has_ratio) &&
      std::none_of(scene.drives.begin(), scene.drives.end(), has_ratio))
    return;
  const std::vector<double> inertias = articulated_inertias(node_parents, model);
  const auto set = [&](const auto& description, Elasticity& elasticity, int coordinate, const char* element) {
    elasticity.damping = damper(description.damping_ratio, elasticity.stiffness, inertias[coordinate],
                                at(description.location, element));
  };
  for (const scene::SpringDescription& spring : scene.springs) {
    Actuator& actuator = actuator_of(spring.coordinate, model);
    if (has_ratio(spring)) set(spring, actuator.spring->elasticity, actuator.coordinate, "<spring>");
  }
  for (const scene::DriveDescription& drive : scene.drives) {
    Actuator& actuator = actuator_of(drive.coordinate, model);
    if (has_ratio(drive)) set(drive, *actuator.drive.gear, actuator.coordinate, "<drive>");
  }
}

}  // namespace flexarm
