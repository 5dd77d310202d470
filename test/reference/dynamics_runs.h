#pragma once
/// What the dynamic reference tests share: constants, and starts of scenes.

#include <limits>

#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kGravity = 9.81;  // m/s^2
/// Axis of hinges whose links move in the x-z plane.
const Vector3 kAcross(0, 1, 0);

inline void initial_field(SceneBuilder& builder, const std::string& link, const Vector3& linear,
                          const Vector3& angular) {
  builder.scene.initial_links.push_back({link, linear, angular, {}});
}
inline void initial_joint(SceneBuilder& builder, const std::string& coordinate, double position, double velocity) {
  builder.scene.initial_joints.push_back({coordinate, position, velocity, {}});
}

/// Changes the velocity of the first initial field such that the centre of mass moves with `drift`. Near the origin,
/// the angular momentum has no round-off of large distances.
inline void set_drift(SceneBuilder& builder, const Vector3& drift) {
  const Simulation simulation(builder.scene);
  builder.scene.initial_links.front().linear += drift - simulation.momentum() / total_mass(simulation);
}

}  // namespace flexarm::test
