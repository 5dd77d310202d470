// Tests beams that bend, twist and grow by prestrain, e.g. by heat, tendons or shape memory.
#include <cmath>

#include "math/pi.h"
#include "reference/dynamics_runs.h"
#include "reference/reference_cantilever.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

constexpr scene::DirectSection kSection{4e3, 1e3, 1e3, 6, 8, 12, 1, 0.01, 0.004, 0.006};

/// A cantilever along x, 1 m long.
SceneBuilder cantilever(int elements, int order) {
  SceneBuilder b = cantilever_scene({{line({1, 0, 0})}, kSection}, elements, order);
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

TimeFunction function(const std::string& text) {
  return TimeFunction::parse(text);
}

scene::BeamDescription& arm(SceneBuilder& b) {
  return *b.scene.links[1].beam;
}

Pose equilibrium_tip(const SceneBuilder& b) {
  Simulation simulation(b.scene);
  EXPECT_TRUE(simulation.solve_static(4).converged);
  return simulation.probe(0).pose;
}

// ---------------------------------------------------------------- statics

constexpr double kCurvature = 2;

/// Tip of a strip that heat from one side bends to an arc of 2 rad.
Pose heated_strip(int elements, int order) {
  SceneBuilder b = cantilever(elements, order);
  arm(b).prestrain[kBendingZ] = TimeFunction(kCurvature);
  return equilibrium_tip(b);
}

const Vector3 kArcEnd = Vector3(std::sin(kCurvature), 1 - std::cos(kCurvature), 0) / kCurvature;

TEST(Prestrain, ThermalArc) {
  const Pose tip = heated_strip(32, 4);
  EXPECT_LT((tip.position - kArcEnd).norm(), 1e-10);
  EXPECT_LT(so3::log(tip.orientation * so3::exp_quaternion(Vector3(0, 0, -kCurvature))).norm(), 1e-10);
  for (int order = 1; order <= 3; ++order) {
    const int elements = order == 1 ? 16 : 4;
    const double coarse = (heated_strip(elements, order).position - kArcEnd).norm(),
                 fine = (heated_strip(2 * elements, order).position - kArcEnd).norm();
    EXPECT_NEAR(observed_order(coarse, fine), 2 * order, kOrderTolerance) << "order " << order;
  }
}

// Any mesh represents exactly the strains that leave a straight line straight.
TEST(Prestrain, GrowsShearsAndTwistsExactly) {
  constexpr double kTolerance = 1e-12;  // Newton's tolerance
  SceneBuilder b = cantilever(1, 1);
  arm(b).prestrain[kAxial] = TimeFunction(0.02);
  arm(b).prestrain[kShearY] = TimeFunction(-0.03);
  arm(b).prestrain[kShearZ] = TimeFunction(0.01);
  EXPECT_LT((equilibrium_tip(b).position - Vector3(1.02, -0.03, 0.01)).norm(), kTolerance);
  SceneBuilder twisted = cantilever(3, 2);
  arm(twisted).prestrain[kTorsion] = TimeFunction(1.5);
  const Pose tip = equilibrium_tip(twisted);
  EXPECT_LT((tip.position - Vector3(1, 0, 0)).norm(), kTolerance);
  EXPECT_LT(so3::log(tip.orientation * so3::exp_quaternion(Vector3(-1.5, 0, 0))).norm(), kTolerance);
}

// Heat presses a rod between two walls by EA alpha T. Its published strain is zero, and its stress belongs to the
// prestrain.
TEST(Prestrain, HeldRodIsPressed) {
  SceneBuilder b = cantilever(4, 2);
  close_loop(b, "wall", scene::JointKind::Fixed, "world", "arm", {1, 0, 0});
  arm(b).prestrain[kAxial] = TimeFunction(1e-3);
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1, Equilibrium::UnderTheLoads).converged);
  std::vector<BeamPoint> points;
  simulation.beam_points(1, 0, points);
  for (const BeamPoint& point : points) {
    EXPECT_NEAR(point.resultant[0], -1e-3 * kSection.ea, 1e-10 * kSection.ea);
    EXPECT_LT(point.strain.norm(), 1e-10);
  }
  EXPECT_NEAR(simulation.energies().strain, 0.5 * kSection.ea * 1e-6, 1e-10 * kSection.ea * 1e-3);
}

// Prestrains belong to the reference line, also if the mass centre is elsewhere in the section.
TEST(Prestrain, IsOfTheReferenceLine) {
  SceneBuilder b = cantilever(16, 4);
  scene::MatrixSection section;
  section.stiffness = (Vector6() << 4e3, 1e3, 1e3, 6, 8, 12).finished().asDiagonal();
  const Matrix3 offset = so3::hat(Vector3(0, 0.05, -0.08));
  section.inertia << Matrix3::Identity(), -offset, offset, 0.1 * Matrix3::Identity() - offset * offset;
  arm(b).section = section;
  Vector6 strains;
  strains << 0.02, -0.01, 0.03, 0.7, -0.5, 1.1;
  for (int i = 0; i < 6; ++i) arm(b).prestrain[i] = TimeFunction(strains[i]);
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(4).converged);
  std::vector<BeamPoint> points;
  simulation.beam_points(1, 0, points);
  // The error is of order 8 in (curvature times the element's length): (1.4 / 16)^8 = 3e-9.
  for (const BeamPoint& point : points) EXPECT_LT((point.strain - strains).norm(), 1e-8);
}

// ---------------------------------------------------------------- dynamics

/// Two welded beams on a hinge, whose tendons pull all the time. The pull starts smoothly, so that it excites no waves
/// that steps do not resolve.
SceneBuilder muscles(const std::string& damping = "") {
  SceneBuilder b;
  for (const char* name : {"upper", "lower"}) {
    scene::BeamDescription& beam = b.beam(name, {{0.5, 0, 0}}, kSection, 2, 2);
    if (!damping.empty()) beam.stiffness_proportional_damping = std::stod(damping);
  }
  b.scene.links[1].beam->prestrain[kBendingZ] = function("0.4*(1-cos(9*t))^2");
  b.scene.links[2].beam->prestrain[kBendingY] = function("-0.3*(1-cos(12*t))^2");
  b.scene.links[2].beam->prestrain[kTorsion] = function("(1-cos(5*t))^2");
  b.scene.links[2].beam->prestrain[kAxial] = function("0.01*(1-cos(8*t))^2");
  b.joint("hinge", scene::JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 0, 1});
  b.joint("weld", scene::JointKind::Fixed, "upper", "lower", {0.5, 0, 0});
  b.probe("tip", "lower", {0.5, 0, 0});
  return b;
}

class PrestrainBy : public ::testing::TestWithParam<const char*> {};

// Changing prestrains do work, which is part of the energy account. The account closes.
TEST_P(PrestrainBy, ClosesTheEnergysAccount) {
  for (const char* damping : {"", "1e-3"}) {
    SceneBuilder b = muscles(damping);
    Simulation simulation(b.scene, options(GetParam(), 2e-3, 1e-12));
    const double start = energy_account(simulation);
    double scale = 0;
    for (int n = 0; n < 300; ++n) {
      ASSERT_TRUE(simulation.step().converged) << n;
      scale = std::max(scale, std::abs(simulation.energies().work));
      ASSERT_NEAR(energy_account(simulation), start, 1e-10 * std::max(scale, 0.1)) << n << " " << damping;
    }
    EXPECT_GT(scale, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(ConservingSchemes, PrestrainBy,
                         ::testing::Values("em", "em_symmetric", "em4", "std", "beta1", "edmc2"));

/// Position of the tip after 0.3 s.
Vector3 tip_after(const std::string& scheme, int steps) {
  Simulation simulation(muscles().scene, options(scheme, 0.3 / steps, 1e-12));
  for (int n = 0; n < steps; ++n) EXPECT_TRUE(simulation.step().converged);
  return simulation.probe(0).pose.position;
}

// In every family, the motion has the order of the scheme.
TEST(Prestrain, KeepsTheOrderOfSchemes) {
  for (const auto& [scheme, order] : {std::pair<const char*, int>{"em", 2},
                                      {"em4", 4},
                                      {"m1", 2},
                                      {"newmark", 2},
                                      {"hht1", 2},
                                      {"hht2", 2},
                                      {"hht3", 2}}) {
    const int steps = order == 4 ? 75 : 300;  // with more steps, order 4 would be near round-off
    const Vector3 coarse = tip_after(scheme, steps), middle = tip_after(scheme, 2 * steps),
                  fine = tip_after(scheme, 4 * steps);
    const double observed = observed_order((coarse - middle).norm(), (middle - fine).norm());
    if (order == 2) {
      EXPECT_NEAR(observed, order, kOrderTolerance) << scheme;
    }
    // Symmetric steps have errors of even order. With means over the parts of a step, the error of order 4 is smaller
    // than that of order 6 down to round-off.
    if (order == 4) {
      EXPECT_GT(observed, order - kOrderTolerance) << scheme;
    }
  }
}

// Families differ in mesh errors and in the location of rotary inertia. For a growing straight rod, all give the same.
// Its motion is linear, so that Newmark's trapezoidal rule conserves energy, too.
TEST(Prestrain, FamiliesAgreeOnAGrowingRod) {
  SceneBuilder b = cantilever(4, 2);
  arm(b).prestrain[kAxial] = function("0.01*(1-cos(8*t))^2");
  const auto growth = [&](const char* scheme, int steps, double& gap) {
    Simulation simulation(b.scene, options(scheme, 0.3 / steps, 1e-12));
    for (int n = 0; n < steps; ++n) EXPECT_TRUE(simulation.step().converged);
    gap = std::abs(energy_account(simulation) / simulation.energies().work);
    return simulation.probe(0).pose.position[0] - 1;
  };
  double gap;
  const double exact = growth("em4", 1000, gap);
  EXPECT_GT(exact, 1e-3);
  for (const char* scheme : {"em", "m1", "newmark", "hht2", "hht3"}) {
    const double coarse = std::abs(growth(scheme, 500, gap) - exact),
                 fine = std::abs(growth(scheme, 1000, gap) - exact);
    EXPECT_NEAR(observed_order(coarse, fine), 2, kOrderTolerance) << scheme;
    if (scheme[0] != 'h') {
      // Strains of 1e-3 have round-off of 2e-13, which adds up over 1000 steps.
      EXPECT_LT(gap, 1000 * 2e-13) << scheme;
    }
  }
}

// Prestrains are internal forces, so they do not change momenta.
TEST(Prestrain, KeepsMomenta) {
  SceneBuilder b;
  b.beam("eel", {{1, 0, 0}}, kSection, 4, 2);
  b.scene.links[1].beam->prestrain[kBendingZ] = function("3*sin(12*t)");
  b.scene.links[1].beam->prestrain[kTorsion] = function("sin(7*t)");
  b.joint("water", scene::JointKind::Floating, "world", "eel");
  for (const char* scheme : {"em", "m1", "std"}) {
    Simulation simulation(b.scene, options(scheme, 2e-3, 1e-12));
    for (int n = 0; n < 300; ++n) ASSERT_TRUE(simulation.step().converged);
    // Tolerance: round-off of 300 steps with forces near EA, or Newton's tolerance, relative to momenta of order 1.
    EXPECT_LT(simulation.momentum().norm(), 1e-9) << scheme;
    EXPECT_LT(simulation.angular_momentum().norm(), 1e-9) << scheme;
  }
}

// The beam is at rest in its bent shape, which has no stress.
TEST(Prestrain, StartsInEquilibrium) {
  SceneBuilder b = cantilever(8, 2);
  arm(b).prestrain[kBendingZ] = TimeFunction(kCurvature);
  b.scene.starts_in_equilibrium = true;
  Simulation simulation(b.scene, options("em", 1e-3, 1e-10));
  const Vector3 start = simulation.probe(0).pose.position;
  for (int n = 0; n < 200; ++n) ASSERT_TRUE(simulation.step().converged);
  EXPECT_LT((simulation.probe(0).pose.position - start).norm(), 1e-9);
}

}  // namespace
}  // namespace flexarm::test
