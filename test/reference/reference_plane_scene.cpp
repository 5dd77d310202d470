// Scenes of plane beams; see reference_plane_scene.h.
#include "reference_plane_scene.h"

#include <cmath>
#include <stdexcept>

namespace flexarm::test {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;

bool has_body(const EndCondition& end) {
  return end.mass > 0 || end.inertia > 0;
}
bool is_pinned(const EndCondition& end) {
  return !end.translates && end.rotates;
}

}  // namespace

SceneBuilder plane_scene(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip, int elements,
                         int order) {
  constexpr double kStiff = 1e4;
  const double ga = 1 / beam.shear_compliance, j = beam.rotary_inertia;
  scene::DirectSection s;
  s.ea = beam.axial_compliance > 0 ? 1 / beam.axial_compliance
                                   : 1e5 * beam.bending_stiffness / (beam.length * beam.length);
  s.ga2 = ga;
  s.ga3 = kStiff * ga;
  s.ei3 = beam.bending_stiffness;
  s.ei2 = kStiff * s.ei3;
  s.mass = beam.mass;
  s.j1 = 2 * j;
  s.j2 = s.j3 = j;
  s.gj = s.ea * s.j1 / s.mass;

  SceneBuilder builder;
  builder.scene.integrator.tolerance = 1e-10;
  const Vector3 end(beam.length, 0, 0);
  builder.beam("arm", {end}, s, elements, order);
  std::string ground = "world";
  if (has_body(root)) {
    builder.body("hub", std::max(root.mass, 1.0), Vector3::Zero(), root.inertia * Matrix3::Identity());
    builder.joint("hinge", scene::JointKind::Revolute, "world", "hub");
    builder.joint("weld", scene::JointKind::Fixed, "hub", "arm");
  } else {
    const auto kind = root.translates ? scene::JointKind::Floating
                      : root.rotates  ? scene::JointKind::Revolute
                                      : scene::JointKind::Fixed;
    builder.joint("root", kind, "world", "arm");
  }
  if (is_pinned(tip)) {
    // The body's inertia about the hinge is small: a large one would cost digits of the beam's rotation, and has no
    // effect.
    builder.body("ground", kGround, Vector3::Zero(), Vector3(kGround, kGround, 1e-8 * kGround).asDiagonal());
    builder.joint("tip", scene::JointKind::Revolute, "arm", "ground", end);
  } else if (has_body(tip)) {
    // The inertia out of the plane is small. Otherwise torsion and bending out of the plane would have slow modes, too.
    builder.body("tip", tip.mass, Vector3::Zero(), Vector3(1e-9, 1e-9, tip.inertia).asDiagonal());
    builder.joint("tip", scene::JointKind::Fixed, "arm", "tip", end);
  }
  if (beam.axial_force != 0) builder.load("arm", end, {beam.axial_force, 0, 0});
  return builder;
}

std::vector<double> computed_frequencies(const SceneBuilder& scene, int count, double slowest) {
  Simulation simulation(scene.scene);
  if (!scene.scene.loads.empty() && !simulation.solve_static(1).converged) throw std::runtime_error("no equilibrium");
  std::vector<double> frequencies;
  for (const Mode& mode : simulation.natural_modes(count + 10)) {
    const double omega = kTwoPi * mode.frequency;
    if (omega > slowest && static_cast<int>(frequencies.size()) < count) frequencies.push_back(omega);
  }
  if (static_cast<int>(frequencies.size()) < count) throw std::runtime_error("too few modes");
  return frequencies;
}

std::vector<double> computed_frequencies(const PlaneBeam& beam, const EndCondition& root, const EndCondition& tip,
                                         int elements, int order, int count) {
  const double unit = std::sqrt(beam.bending_stiffness / beam.mass) / (beam.length * beam.length);
  return computed_frequencies(plane_scene(beam, root, tip, elements, order), count, is_pinned(tip) ? 0.1 * unit : 0);
}

}  // namespace flexarm::test
