// Cantilevers with a load at the tip; see reference_cantilever.h.
#include "reference_cantilever.h"

#include <stdexcept>

namespace flexarm::test {

scene::CentrelinePiece line(const Vector3& to, double twist) {
  scene::CentrelinePiece piece;
  piece.to = to;
  piece.twist = twist;
  return piece;
}

scene::CentrelinePiece arc(const Vector3& to, const Vector3& center, double twist) {
  scene::CentrelinePiece piece = line(to, twist);
  piece.kind = scene::CentrelinePiece::Kind::Arc;
  piece.center = center;
  return piece;
}

SceneBuilder cantilever_scene(const Cantilever& cantilever, int elements, int order) {
  SceneBuilder builder;
  builder.beam("arm", {}, cantilever.section, elements, order).centreline = cantilever.pieces;
  builder.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  builder.load("arm", cantilever.tip(), cantilever.force, cantilever.moment);
  builder.probe("tip", "arm", cantilever.tip());
  builder.scene.integrator.tolerance = 1e-10;
  return builder;
}

Pose static_tip(const Cantilever& cantilever, int elements, int order, int load_steps) {
  Simulation simulation(cantilever_scene(cantilever, elements, order).scene);
  const StepResult result = simulation.solve_static(load_steps);
  if (!result.converged) throw std::runtime_error(std::string("no equilibrium: ") + to_string(result.reason));
  return simulation.probe(0).pose;
}

}  // namespace flexarm::test
