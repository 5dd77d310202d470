#pragma once
/// Builds scenes in code, for tests.

#include "flexarm/simulation/simulation.h"
#include "scene/scene_builder.h"

namespace flexarm::test {

/// Starts with an empty scene and the conserving scheme.
struct SceneBuilder : scene::SceneBuilder {
  SceneBuilder() : scene::SceneBuilder("test") { scene.integrator.scheme = "em"; }
};

/// Indices of strains, in the order in which a beam's description has its data per strain.
enum Strain { kAxial, kShearY, kShearZ, kTorsion, kBendingY, kBendingZ };

/// Returns a section with the given stiffnesses and inertias. 1 is along the tangent, 2 along y, 3 along z.
inline scene::DirectSection section(double ea, double ga, double gj, double ei, double mass, double j1, double j2) {
  return {ea, ga, ga, gj, ei, ei, mass, j1, j2, j2};
}

}  // namespace flexarm::test
