// A flexible link tends to the rigid one as its stiffness grows.
#include <cstdio>
#include <vector>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kLength = 1.2, kMassPerLength = 0.8, kRotary = 2e-3;
constexpr double kStep = 0.005;
constexpr int kSteps = 300;

/// A double pendulum whose upper link is a beam of `stiffness` times a base value, or (infinite) a rigid body of the
/// same mass.
SceneBuilder pendulum(double stiffness) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};
  const double mass = kMassPerLength * kLength;
  if (std::isinf(stiffness)) {
    const double j = mass * kLength * kLength / 12 + kRotary * kLength;
    b.body("upper", mass, {0, 0, -0.5 * kLength}, Vector3(j, j, 2 * kRotary * kLength).asDiagonal());
  } else {
    b.beam("upper", {{0, 0, -kLength}},
           scene::DirectSection{1e4 * stiffness, 5e3 * stiffness, 5e3 * stiffness, 10 * stiffness, 10 * stiffness,
                                10 * stiffness, kMassPerLength, 2 * kRotary, kRotary, kRotary},
           2, 2);
  }
  b.body("lower", 0.5, {0.1, 0.05, -0.3}, Vector3(0.02, 0.03, 0.01).asDiagonal());
  b.joint("first", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  b.joint("second", JointKind::Revolute, "upper", "lower", {0, 0, -kLength}, {0, 0.6, 0.8});
  initial_joint(b, "first", 1.0, 0.0);
  initial_joint(b, "second", 0.5, 0.0);
  b.probe("tip", "lower", {0.1, 0, -0.5});
  return b;
}

std::vector<Vector3> tip_path(double stiffness, const std::string& scheme) {
  Simulation simulation(pendulum(stiffness).scene, options(scheme, kStep, 1e-11));
  std::vector<Vector3> path;
  run(simulation, kSteps, [&] { path.push_back(simulation.probe(0).pose.position); });
  return path;
}

double largest_distance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

class RigidLimit : public ::testing::TestWithParam<std::string> {};

TEST_P(RigidLimit, DifferenceFallsWithTheCompliance) {
  const std::vector<Vector3> rigid = tip_path(INFINITY, GetParam());
  const double soft = largest_distance(tip_path(1e2, GetParam()), rigid);
  const double medium = largest_distance(tip_path(1e4, GetParam()), rigid);
  const double stiff = largest_distance(tip_path(1e6, GetParam()), rigid);
  // What is left at the stiff end is that the two links discretise time differently, at second order.
  Simulation fine(pendulum(INFINITY).scene, options(GetParam(), kStep / 8, 1e-11));
  double step_error = 0;
  for (const Vector3& point : rigid) {
    run(fine, 8);
    step_error = std::max(step_error, (fine.probe(0).pose.position - point).norm());
  }
  std::printf("%s: differences %.2e %.2e %.2e, step's error %.2e\n", GetParam().c_str(), soft, medium, stiff,
              step_error);
  EXPECT_GT(soft, 1e-4) << "the test must see the compliance";
  EXPECT_LT(medium, std::max(0.03 * soft, 2 * step_error)) << "a hundredth, but for the phase of vibrations";
  EXPECT_LT(stiff, std::max(3e-4 * soft, 2 * step_error));
}
INSTANTIATE_TEST_SUITE_P(Schemes, RigidLimit, ::testing::Values("em", "m1"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace flexarm::test
