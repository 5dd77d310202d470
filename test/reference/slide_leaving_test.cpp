// Tests sliders that leave their line: no quantity jumps, and the slider continues as a free body.
#include <cmath>
#include <filesystem>

#include "flexarm/simulation/checkpoint.h"
#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// An arm with a body slides along a free beam and over its end, without loads.
SceneBuilder leaving(JointKind rotation) {
  SceneBuilder b;
  b.beam("line", {{2, 0.3, 0.2}}, soft_section(), 4, 2);
  b.beam("arm", {{0, 0.8, 0.3}}, soft_section(), 1, 2);
  b.body("hand", 0.8, {0.2, 0.1, -0.1}, 0.2 * body_inertia());
  b.joint("free", JointKind::Floating, "world", "line");
  scene::JointDescription& run = b.joint("run", JointKind::Slide, "line", "arm", Vector3::Zero(), Vector3(1, 2, 2) / 3);
  run.axis2 = Vector3(0, 0.6, 0.8);
  run.ratio = 0.4;
  run.slide = scene::SlideDescription{1.3, rotation};
  run.slide->on_end = scene::SlideDescription::End::Free;
  b.joint("wrist", JointKind::Fixed, "arm", "hand", {0, 0.8, 0.3});
  initial_field(b, "line", {0.1, -0.2, 0.1}, {0.3, 0.5, 1.0});
  const bool is_coupled = scene::has_dependent_travel(rotation);
  initial_joint(b,
                is_coupled                     ? "run/1"
                : rotation == JointKind::Fixed ? "run"
                                               : "run/s",
                is_coupled ? 0.2 : 1.3,
                is_coupled                     ? 5.0
                : rotation == JointKind::Fixed ? 6.0
                                               : 2.0);
  return b;
}

class LeavingSlide : public ::testing::TestWithParam<JointKind> {};

TEST_P(LeavingSlide, KeepsEnergyAndMomenta) {
  for (const char* scheme : {"em", "std"}) {
    Simulation simulation(leaving(GetParam()).scene, options(scheme, 0.01, 1e-10));
    InvariantDrift drift(simulation);
    const std::size_t unknowns = simulation.degrees_of_freedom();
    run(simulation, 150, [&] { drift.observe(); });
    EXPECT_GT(simulation.degrees_of_freedom(), unknowns) << "it has not left";
    EXPECT_LE(simulation.position(*simulation.find_coordinate(GetParam() == JointKind::Fixed ? "run" : "run/s")),
              model_of(simulation).slide_lines[0].end() + 0.1);
    EXPECT_LT(drift.energy(), 1e-10) << scheme;
    EXPECT_LT(drift.momentum(), 1e-11) << scheme;
    EXPECT_LT(drift.angular_momentum(), 1e-11) << scheme;
  }
}
INSTANTIATE_TEST_SUITE_P(Rotations, LeavingSlide,
                         ::testing::Values(JointKind::Fixed, JointKind::Revolute, JointKind::Universal,
                                           JointKind::Spherical, JointKind::Screw));

constexpr double kStiffness = 1e13;  // of the line [N, N m^2]

/// A bead of 1 kg on a stiff, light line that it leaves.
SceneBuilder bead_on(const Vector3& line, int elements, double start, double velocity) {
  SceneBuilder b;
  const double stiff = kStiffness, light = 1e-3;
  b.beam("line", {line}, scene::DirectSection{stiff, stiff, stiff, stiff, stiff, stiff, light, light, light, light},
         elements, 2);
  b.body("bead", 1, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("clamp", JointKind::Fixed, "world", "line");
  scene::JointDescription& run = b.joint("run", JointKind::Slide, "line", "bead", Vector3::Zero());
  run.slide = scene::SlideDescription{start, JointKind::Fixed};
  run.slide->on_end = scene::SlideDescription::End::Free;
  initial_joint(b, "run", start, velocity);
  b.probe("bead", "bead", Vector3::Zero());
  b.scene.gravity = {0, 0, -10};
  return b;
}

/// The bead's largest distance from the flight of a bead that leaves a rigid line at its end, after a time `flown`.
/// `force`: of the line [N]. The line carries the bead a thousandth of the last element beyond the end (Stepper). On
/// the line the bead swings by F / k, k = 3 EI / l^3, since its weight acts suddenly.
double flight_error(double length, double element, double speed, double force, double flown) {
  const double stiffness = 3 * kStiffness / (length * length * length), late = 1e-3 * element / speed;
  return (late * force + force / std::sqrt(stiffness)) * flown + 2 * force / stiffness;
}

// A bead leaves a stiff inclined line with v = sqrt(2 g sin l) along it, and then falls freely. In the longest steps it
// passes two elements.
TEST(SlideEnd, FallsOnAParabola) {
  for (const char* scheme : {"em", "edmc2", "em4"})
    for (const double step : {0.002, 0.02, 0.1}) {
      Simulation simulation(bead_on({0.6, 0, -0.8}, 4, 0.2, 0).scene, options(scheme, step));
      const double left = std::sqrt(2 * 0.8 / 8), speed = 8 * left;
      test::run(simulation, static_cast<int>(std::lround(0.8 / step)));
      EXPECT_NEAR(simulation.time(), 0.8, 1e-15) << scheme;
      const double flown = simulation.time() - left;
      const Vector3 expected = Vector3(0.6, 0, -0.8) * (1 + speed * flown) + Vector3(0, 0, -5 * flown * flown);
      EXPECT_LT((simulation.probe(0).pose.position - expected).norm(), flight_error(1, 0.25, speed, 6, flown))
          << scheme << ", " << step;
      EXPECT_FALSE(simulation.is_commandable(0));
    }
}

// It passes up to 40 elements in a step, and falls from the height of the line.
TEST(SlideEnd, IsPassedWithinAStep) {
  for (const char* scheme : {"em", "edmc2", "em4"})
    for (const double speed : {20.0, 200.0, 400.0})
      for (const double step : {1e-3, 1e-2}) {
        Simulation simulation(bead_on({10, 0, 0}, 100, 9.05, speed).scene, options(scheme, step));
        test::run(simulation, static_cast<int>(std::lround(0.2 / step)));
        const double flown = 0.2 - 0.95 / speed;
        const Vector3 expected(9.05 + 0.2 * speed, 0, -5 * flown * flown);
        EXPECT_LT((simulation.probe(0).pose.position - expected).norm(), flight_error(10, 0.1, speed, 10, flown))
            << scheme << ", " << speed << ", " << step;
      }
}

TEST(SlideEnd, ResetRestoreAndCheckpointsKnowWhoHasLeft) {
  const SceneBuilder b = leaving(JointKind::Spherical);
  for (const char* scheme : {"em", "hht2", "newmark"}) {
    SimulationOptions bitwise = options(scheme, 0.01);
    bitwise.reuse_factorisation = false;
    Simulation simulation(b.scene, bitwise);
    const State start = state_of(simulation);
    run(simulation, 20);
    const State on_line = state_of(simulation);
    run(simulation, 80);
    const State flying = state_of(simulation);
    ASSERT_EQ(flying.left_lines.size(), 1u) << scheme;
    const std::string path =
        (std::filesystem::temp_directory_path() / ("flexarm_leaving_" + std::string(scheme))).string();
    write_checkpoint(simulation, path);
    run(simulation, 20);
    const Vector3 last = simulation.link_pose(3).position;

    restore(simulation, on_line);
    run(simulation, 100);
    EXPECT_LT((simulation.link_pose(3).position - last).norm(), 1e-6) << scheme;
    restore(simulation, flying);
    run(simulation, 20);
    EXPECT_EQ(simulation.link_pose(3).position, last) << scheme;
    simulation.reset();
    EXPECT_TRUE(state_of(simulation).left_lines.empty());
    EXPECT_EQ(state_of(simulation).nodes.size(), start.nodes.size());
    run(simulation, 120);
    EXPECT_LT((simulation.link_pose(3).position - last).norm(), 1e-6) << scheme;

    Simulation other(b.scene, bitwise);
    read_checkpoint(other, path);
    run(other, 20);
    EXPECT_EQ(other.link_pose(3).position, last) << scheme;
    State wrong = flying;
    wrong.left_lines[0] = 0;
    EXPECT_THROW(restore(simulation, wrong), std::invalid_argument);
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace flexarm::test
