// Newton's method does not feel how stiff a beam is against stretch and shear (docs/notes/newton.md).
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flexarm/simulation/simulation.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// Iterations per step that are asked for, whatever the stiffness: two or three that converge quadratically from an
/// extrapolated guess to round-off, and as many again for what the load begins with.
constexpr double kMostIterations = 6;

double iterations_per_step(const SceneBuilder& builder, const std::string& scheme, double step, int steps) {
  SimulationOptions options;
  options.scheme = scheme;
  options.step = step;
  Simulation simulation(builder.scene, options);
  int iterations = 0;
  for (int k = 0; k < steps; ++k) {
    const StepResult result = simulation.step();
    EXPECT_TRUE(result.converged) << to_string(result.reason) << " in step " << k;
    EXPECT_EQ(result.halvings, 0) << "in step " << k;
    iterations += result.iterations;
  }
  std::printf("%s: %.1f iterations a step\n", scheme.c_str(), static_cast<double>(iterations) / steps);
  return static_cast<double>(iterations) / steps;
}

class Stiffness : public ::testing::TestWithParam<const char*> {};

// A cantilever that a force at its tip bends, EI = L = mass = 1.
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

// Rods of the radius 1/slenderness that fall from the horizontal.
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

INSTANTIATE_TEST_SUITE_P(Schemes, Stiffness, ::testing::Values("em", "em0", "edmc2", "m1", "newmark", "hht2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace flexarm::test
