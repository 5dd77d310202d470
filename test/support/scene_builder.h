#pragma once
/// Scenes made in code, for tests.

#include "flexarm/simulation/simulation.h"
#include "scene/scene_builder.h"

namespace flexarm::test {

/// Starts with an empty scene, for the conserving scheme.
struct SceneBuilder : scene::SceneBuilder {
  SceneBuilder() : scene::SceneBuilder("test") { scene.integrator.scheme = "em"; }
};

/// Section with the given stiffnesses and inertias; 1 = tangent, 2 = y, 3 = z.
inline scene::DirectSection section(double ea, double ga, double gj, double ei, double mass, double j1, double j2) {
  return {ea, ga, ga, gj, ei, ei, mass, j1, j2, j2};
}

}  // namespace flexarm::test
