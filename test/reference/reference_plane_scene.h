#pragma once
/// Scenes whose slowest motions are those of a plane beam.

#include <vector>

#include "reference_spectrum.h"
#include "support/scene_builder.h"

namespace flexarm::test {

/// Mass [kg] and inertia [kg m^2] of the body that replaces the ground at a pinned tip. It changes frequencies by the
/// ratio of the beam's mass to its own.
constexpr double kGround = 1e10;

/// A link "arm" along x that bends in the x-y plane according to `beam`. Bending in the other plane, torsion and
/// extension are so stiff that their frequencies lie above the first five plane ones. A tension of the beam is a dead
/// force at its end.
SceneBuilder plane_scene(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip, int elements,
                         int order);

/// Circular frequencies [rad/s] of the lowest `count` modes faster than `slowest` [rad/s] about the static equilibrium.
/// @throws std::runtime_error if there is no equilibrium or too few modes.
std::vector<double> computed_frequencies(const SceneBuilder& scene, int count, double slowest = 0);

/// The same for plane_scene(), without the slow motions of the body that replaces the ground.
std::vector<double> computed_frequencies(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                         int elements, int order, int count);

}  // namespace flexarm::test
