// Tests that the number of Newton iterations does not depend on a beam's stiffness against stretch and shear
// (docs/notes/newton.md).
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "flexarm/simulation/simulation.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// Bound of the mean number of iterations per step, for any stiffness: two or three for quadratic convergence from an
/// extrapolated guess to round-off, and as many again for the first steps after the load begins.
constexpr double kMostIterations = 6;

double iterations_per_step(const SceneBuilder& builder, const SimulationOptions& options, int steps) {
  Simulation simulation(builder.scene, options);
  int iterations = 0, factorisations = 0;
  for (int k = 0; k < steps; ++k) {
    const StepResult result = simulation.step();
    EXPECT_TRUE(result.converged) << to_string(result.reason) << " in step " << k;
    EXPECT_EQ(result.halvings, 0) << "in step " << k;
    iterations += result.iterations;
    factorisations += result.factorisations;
  }
  const double per_step = static_cast<double>(iterations) / steps;
  std::printf("%s: %.2f iterations and %.2f factorisations a step\n", options.scheme->c_str(), per_step,
              static_cast<double>(factorisations) / steps);
  return per_step;
}

double iterations_per_step(const SceneBuilder& builder, const std::string& scheme, double step, int steps) {
  return iterations_per_step(builder, options(scheme, step), steps);
}

class Stiffness : public ::testing::TestWithParam<const char*> {};

// A cantilever with EI = L = mass = 1, bent by a force at its tip.
TEST_P(Stiffness, OfStretchAndShearCostsNoIterations) {
  for (const double stretch : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12}) {
    SCOPED_TRACE(fmt::format("EA = {}", stretch));
    SceneBuilder b;
    const double rotary = std::min(2 / stretch, 2e-3);
    b.beam("beam", {{1, 0, 0}}, section(stretch, stretch / 2.6, 0.8, 1, 1, rotary, rotary / 2), 8, 2);
    b.joint("clamp", scene::JointKind::Fixed, "world", "beam", Vector3::Zero());
    b.scene.gravity.setZero();
    b.load("beam", {1, 0, 0}, {0, 0, -1});
    EXPECT_LE(iterations_per_step(b, GetParam(), 0.02, 30), kMostIterations);
  }
}

// Falling rods of the radius 1/slenderness.
TEST_P(Stiffness, OfSlenderRodsCostsNoIterations) {
  for (const double slenderness : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    SCOPED_TRACE(fmt::format("slenderness {}", slenderness));
    SceneBuilder b;
    const double radius = 1 / slenderness, area = M_PI * radius * radius, bending = 0.25 * area * radius * radius;
    b.beam("rod", {{1, 0, 0}},
           section(70e9 * area, 0.9 * 26e9 * area, 52e9 * bending, 70e9 * bending, 2700 * area, 5400 * bending,
                   2700 * bending),
           10, 2);
    b.joint("clamp", scene::JointKind::Fixed, "world", "rod", Vector3::Zero());
    EXPECT_LE(iterations_per_step(b, GetParam(), 0.005, 30), kMostIterations);
  }
}

/// A beam with EI = L = mass = 1, EA proportional to GA, and the rotary inertia of a rod with this EA.
scene::BeamDescription& unit_beam(SceneBuilder& b, const std::string& name, double stretch) {
  const double rotary = 2 / stretch;
  return b.beam(name, {{1, 0, 0}}, section(stretch, stretch / 2.6, 0.8, 1, 1, rotary, rotary / 2), 8, 2);
}

/// A cantilever that falls from the horizontal and swings.
SceneBuilder swinging_cantilever(double stretch) {
  SceneBuilder b;
  unit_beam(b, "beam", stretch);
  b.joint("clamp", scene::JointKind::Fixed, "world", "beam");
  b.scene.gravity = {0, 0.3, -3};
  return b;
}

SceneBuilder double_pendulum(double stretch) {
  SceneBuilder b;
  unit_beam(b, "upper", stretch);
  unit_beam(b, "lower", stretch);
  b.joint("first", scene::JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("second", scene::JointKind::Revolute, "upper", "lower", {1, 0, 0}, {0, 0.6, 0.8});
  b.scene.gravity = {0, 0, -2};
  return b;
}

/// A beam whose hub is accelerated to about one turn per second.
SceneBuilder spin_up(double stretch) {
  SceneBuilder b;
  unit_beam(b, "beam", stretch);
  b.joint("hub", scene::JointKind::Revolute, "world", "beam", {0, 0, 0}, {0, 0, 1});
  b.scene.motions.push_back(
      {"hub", TimeFunction::parse("t < 3 ? 2*(t^2/2 + (3/(2*_pi))^2*(cos(2*_pi*t/3) - 1)) : 6*t - 9"), {}});
  return b;
}

class UnfeltStiffness : public ::testing::TestWithParam<const char*> {};

// A beam that is 1e3 or 1e8 times stiffer against stretch and shear than against bending moves alike. So the iterations
// should be the same, whatever the stiffness. One step in fifty may need one more, because it is just above the
// tolerance. docs/notes/newton.md lists the schemes for which this does not hold.
TEST_P(UnfeltStiffness, CostsNoIterations) {
  const SimulationOptions options = full_newton(test::options(GetParam(), 0.02));
  struct Case {
    const char* name;
    SceneBuilder (*scene)(double stretch);
  };
  for (const auto& [name, scene] :
       {Case{"cantilever", swinging_cantilever}, Case{"double pendulum", double_pendulum}, Case{"spin-up", spin_up}}) {
    SCOPED_TRACE(name);
    std::printf("%s, ", name);
    const double soft = iterations_per_step(scene(1e3), options, 200);
    std::printf("%s, ", name);
    const double stiff = iterations_per_step(scene(1e8), options, 200);
    EXPECT_LE(stiff, 1.02 * soft);
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, UnfeltStiffness, ::testing::Values("em", "em0", "m1", "m2", "hht2"),
                         [](const auto& info) { return std::string(info.param); });

INSTANTIATE_TEST_SUITE_P(Schemes, Stiffness, ::testing::Values("em", "em0", "edmc2", "m1", "newmark", "hht2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace flexarm::test
