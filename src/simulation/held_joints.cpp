#include "simulation/inside.h"

#include <set>

namespace flexarm {

scene::Diagnostics Simulation::held_joints() const {
  const scene::SceneDescription& scene = this->scene();
  std::set<std::string> driven;
  for (const scene::PrescribedMotion& motion : scene.motions) driven.insert(motion.coordinate);
  std::set<std::string> held;
  for (const Coordinate& coordinate : model_of(*this).coordinates)
    if (coordinate.motion >= 0 && driven.count(coordinate.name) == 0) held.insert(coordinate.name);
  scene::Diagnostics findings;
  for (const scene::JointDescription& joint : scene.joints)
    for (const std::string& suffix : scene::coordinate_suffixes(joint))
      if (held.count(joint.name + suffix) > 0)
        findings.push_back({scene::Diagnostic::Severity::Warning, joint.location.file, joint.location.line,
                            "<joint> '" + joint.name + suffix + "'", "",
                            "is held where it starts, since it moves nothing that has inertia"});
  return findings;
}

}  // namespace flexarm
