// Tests sliding on a flexible line: invariants across the borders of elements, closed forms, and the thesis's example
// 12.2.
#include <cmath>
#include <cstdio>

#include "reference/slide_scenes.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Parameters: the slider's kind of rotation, and whether its line is smooth.
class FreeSlide : public ::testing::TestWithParam<std::tuple<JointKind, bool>> {};

// In 4 s the slider passes most of the line, and the stop at the end throws it back.
TEST_P(FreeSlide, ConservesEnergyAndMomentaAcrossElements) {
  const auto [rotation, smooth] = GetParam();
  SceneBuilder b = runner_on_a_free_beam(rotation);
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.slide) joint.slide->smooth = smooth;
  for (const char* scheme : {"em", "std", "beta2_repaired"}) {
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-10));
    InvariantDrift drift(simulation);
    const std::size_t s = *simulation.find_coordinate(first_coordinate(rotation));
    double least = 4, most = 0;
    run(simulation, 400, [&] {
      drift.observe();
      least = std::min(least, simulation.position(s));
      most = std::max(most, simulation.position(s));
    });
    std::printf("%s: from %.2f to %.2f m, drift of energy %.1e, momentum %.1e, angular momentum %.1e\n", scheme, least,
                most, drift.energy(), drift.momentum(), drift.angular_momentum());
    EXPECT_GT(most - least, 1.0) << "it must pass two elements";
    EXPECT_LT(drift.energy(), 1e-10) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(Rotations, FreeSlide,
                         ::testing::Combine(::testing::Values(JointKind::Fixed, JointKind::Revolute,
                                                              JointKind::Universal, JointKind::Spherical,
                                                              JointKind::Screw, JointKind::RackAndPinion,
                                                              JointKind::Worm, JointKind::Cam),
                                            ::testing::Bool()));

// The arc length follows the angle in every step to round-off, in every family of schemes.
TEST(Slide, CoupledTravelFollowsItsAngle) {
  for (const JointKind kind : {JointKind::Screw, JointKind::RackAndPinion, JointKind::Worm, JointKind::Cam})
    for (const char* scheme : {"em", "m1", "m2", "newmark", "hht2"}) {
      const SceneBuilder b = runner_on_a_free_beam(kind);
      Simulation simulation(b.scene, options(scheme, 0.01));
      const std::size_t s = *simulation.find_coordinate("run/s"), angle = *simulation.find_coordinate("run/1");
      const scene::JointDescription& run = b.scene.joints[1];
      test::run(simulation, 50, [&] {
        const double u = simulation.position(angle);
        EXPECT_NEAR(simulation.position(s), 1.3 + (run.profile ? run.profile->value(u) : 0.4 * u), 1e-14);
      });
    }
}

/// A bead of mass 1 on a clamped, nearly rigid straight beam along `direction`, released at 0.2 m.
SceneBuilder bead(const Vector3& direction) {
  SceneBuilder b;
  b.beam("line", {2 * direction.normalized()}, scene::DirectSection{1e9, 1e9, 1e9, 1e9, 1e9, 1e9, 1, 0.1, 0.1, 0.1}, 6,
         2);
  b.body("bead", 1, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("clamp", JointKind::Fixed, "world", "line");
  add_slide(b, "run", "line", "bead", 0.2, JointKind::Fixed);
  return b;
}

TEST(Slide, BeadFallsDownAnInclinedLine) {
  SceneBuilder b = bead({3, 0, -4});
  b.scene.gravity = {0, 0, -10};
  Simulation simulation(b.scene, options("em", 0.005));
  run(simulation, 100);
  // The line bends by 1e-8 m; the remaining error is round-off.
  EXPECT_NEAR(simulation.position(0), 0.2 + 0.5 * 8 * 0.25, 1e-6);
  EXPECT_NEAR(simulation.velocity(0), 8 * 0.5, 1e-4);
}

/// A wheel of inertia 0.3 about the line's tangent, as the nut of a screw of 0.4 m/rad on a stiff vertical line.
TEST(Slide, ScrewUnderItsWeight) {
  SceneBuilder b = bead({0, 0, -1});
  b.scene.links.back().inertial = scene::RigidInertia{2, Vector3::Zero(), 0.3 * Matrix3::Identity()};
  scene::JointDescription& nut = b.scene.joints.back();
  nut.slide->rotation = JointKind::Screw;
  nut.ratio = 0.4;
  nut.axis = Vector3::UnitX();
  b.scene.gravity = {0, 0, -10};
  Simulation simulation(b.scene, options("em", 0.005, 1e-12));
  run(simulation, 80);
  const double acceleration = 2 * 10 * 0.4 / (0.3 + 2 * 0.4 * 0.4);
  // Rotation of the nut in a step. The error of the tangent-scaled rule is of second order in this angle.
  const double turned = 0.005 * acceleration * 0.4;
  EXPECT_NEAR(simulation.position(1), 0.5 * acceleration * 0.16, 0.08 * acceleration * turned * turned + 1e-6);
}

TEST(Slide, EndsAreStopsWithRestitution) {
  SceneBuilder b = bead({3, 0, -4});
  b.scene.gravity = {0, 0, -10};
  Simulation simulation(b.scene, options("em", 0.002));
  const double start = simulation.energies().total();
  double most = 0, rebound = 0;
  run(simulation, 1000, [&] {
    most = std::max(most, simulation.position(0));
    rebound = std::min(rebound, simulation.velocity(0));
  });
  EXPECT_LT(most, 2.03);
  EXPECT_NEAR(rebound, -0.3 * std::sqrt(2 * 8 * 1.8), 0.3);  // coefficient of restitution 0.3
  // The error of Newton's method, 1e-15 m times EA over an element, does work over 0.01 m in each of 1000 steps.
  EXPECT_NEAR(energy_account(simulation), start, 1000 * 1e-15 * 3e9 * 0.01);
}

TEST(Slide, AnErrorEndFailsAndKeepsTheState) {
  SceneBuilder b = bead({3, 0, -4});
  b.scene.joints.back().slide->on_end = scene::SlideDescription::End::Error;
  b.scene.gravity = {0, 0, -10};
  Simulation simulation(b.scene, options("em", 0.01));
  StepResult result;
  do result = simulation.step();
  while (result.converged && simulation.time() < 2);
  EXPECT_FALSE(result.converged);
  EXPECT_STREQ(to_string(result.reason), "a slider leaves its line, or passes too many elements in one step");
  EXPECT_NEAR(simulation.time(), std::sqrt(2 * 1.8 / 8), 0.05);
  EXPECT_TRUE(std::isfinite(simulation.position(0)));
}

// The angle of a joint with dependent travel is driven. The drive's work equals the change of energy.
TEST(Slide, CoupledTravelIsDrivenByItsAngle) {
  for (const JointKind kind : {JointKind::Screw, JointKind::RackAndPinion, JointKind::Worm, JointKind::Cam}) {
    SceneBuilder b = runner_on_a_free_beam(kind);
    b.scene.initial_joints.clear();
    b.scene.motions.push_back({"run/1", TimeFunction::parse("0.2+1.5*t+0.8*sin(3*t)"), {}});
    Simulation simulation(b.scene, options("em", 0.01, 1e-10));
    InvariantDrift drift(simulation);
    run(simulation, 150, [&] { drift.observe(); });
    EXPECT_GT(std::abs(simulation.energies().work), 0.1);
    EXPECT_LT(drift.energy(), 1e-10);
    EXPECT_LT(drift.momentum(), 1e-11);
    EXPECT_LT(drift.angular_momentum(), 1e-11);
  }
}

// A drive moves the slider back and forth over more than fifty borders. Its work equals the change of energy.
TEST(Slide, BackAndForthOverManyElements) {
  SceneBuilder b;
  b.beam("line", {{3, 0, 0}}, soft_section(), 12, 2);
  b.beam("arm", {{0, 0.5, 0.2}}, soft_section(), 1, 2);
  b.joint("clamp", JointKind::Fixed, "world", "line");
  add_slide(b, "run", "line", "arm", 1.5, JointKind::Fixed);
  b.scene.gravity = {0, 0, -2};
  b.scene.motions.push_back({"run", TimeFunction::parse("1.5+1.3*sin(2*t)"), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-10));
  InvariantDrift drift(simulation);
  int crossings = 0;
  double last = 1.5;
  run(simulation, 1000, [&] {
    drift.observe();
    const double now = simulation.position(0);
    crossings += std::abs(static_cast<int>(now / 0.25) - static_cast<int>(last / 0.25));
    last = now;
  });
  EXPECT_GE(crossings, 50);
  EXPECT_LT(drift.energy(), 1e-10);
  std::printf("%d borders, defect of the energy balance %.1e\n", crossings, drift.energy());
}

// Thesis 12.2, interpreted as in config/thesis/12_2_free_sliding_mass.urdf. The figures come from an independent
// program.
TEST(Slide, ThesisFreeSlidingMass) {
  scene::SlideDescription slide;
  slide.smooth = false;  // as in that program
  Simulation simulation = thesis_free_sliding_mass("em", 0.002, slide);
  InvariantDrift drift(simulation);
  EXPECT_NEAR(simulation.energies().total(), 106.4, 0.05);
  const std::size_t s = *simulation.find_coordinate("run/s");
  const std::pair<double, double> expected[] = {{0.022, -0.148}, {0.042, -0.389}, {0.062, -0.511}, {0.082, -0.715},
                                                {0.102, -0.948}, {0.122, -1.122}, {0.142, -1.321}, {0.162, -1.634}};
  std::size_t next = 0;
  run(simulation, 85, [&] {
    drift.observe();
    if (next < std::size(expected) && std::abs(simulation.time() - expected[next].first) < 1e-6) {
      EXPECT_NEAR(simulation.position(s) - kThesisLineLength, expected[next].second, 6e-4) << simulation.time();
      ++next;
    }
  });
  EXPECT_EQ(next, std::size(expected));
  const Vector3 mass = simulation.link_pose(3).position;
  EXPECT_LT((mass - Vector3(0.9395, 1.3106, -0.6671)).norm(), 5e-4);
  EXPECT_LT(drift.energy(), 1e-11);
  EXPECT_LT(drift.angular_momentum(), 1e-11);
  std::printf("energy %.1e, angular momentum %.1e\n", drift.energy(), drift.angular_momentum());
}

}  // namespace
}  // namespace flexarm::test
