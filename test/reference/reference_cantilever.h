#pragma once
/// Cantilevers with a load at the tip, the structure of most static reference cases.

#include <vector>

#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {

/// A flexible link clamped to the world at the origin, with a dead force [N] and moment [N m] (world axes) at its end.
struct Cantilever {
  std::vector<scene::CentrelinePiece> pieces;
  scene::Section section;
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();

  /// End of the undeformed centreline [m].
  Vector3 tip() const { return pieces.back().to; }
};

scene::CentrelinePiece line(const Vector3& to, double twist = 0);
scene::CentrelinePiece arc(const Vector3& to, const Vector3& center, double twist = 0);

/// The scene of a cantilever: beam "arm", probe 0 at its tip, Newton tolerance 1e-10.
SceneBuilder cantilever_scene(const Cantilever& cantilever, int elements, int order);

/// Pose of the tip section under the load.
/// @throws std::runtime_error if Newton's method fails.
Pose static_tip(const Cantilever& cantilever, int elements, int order, int load_steps = 1);

/// Tolerance of observed orders. For errors with even powers of h, the observed order tends to the theoretical one with
/// an error of order h^2. The tolerance allows for this on the meshes used here, and is a fraction of the distance to
/// the next possible order.
constexpr double kOrderTolerance = 0.25;

}  // namespace flexarm::test
