// Tests that a flexible link tends to the rigid one as its stiffness grows.
#include <cstdio>
#include <vector>

#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kLength = 1.2, kMassPerLength = 0.8, kRotary = 2e-3;
constexpr double kPathStep = 0.005;
constexpr int kPathSteps = 300;

/// A double pendulum. Its upper link is a beam with `stiffness` times a base value, or a rigid body of the same mass if
/// `stiffness` is infinite.
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
  Simulation simulation(pendulum(stiffness).scene, options(scheme, kPathStep, 1e-11));
  std::vector<Vector3> path;
  run(simulation, kPathSteps, [&] { path.push_back(simulation.probe(0).pose.position); });
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
  // At high stiffness, the remaining difference is that of the two links' time discretisation, of second order.
  Simulation fine(pendulum(INFINITY).scene, options(GetParam(), kPathStep / 8, 1e-11));
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

/// Equilibrium position of the pendulum, hanging and pulled aside. Its upper link has no elements if the stiffness is
/// infinite.
Vector3 place_at_rest(double stiffness) {
  SceneBuilder b = pendulum(std::isinf(stiffness) ? 1 : stiffness);
  if (std::isinf(stiffness)) b.scene.links[1].beam->elements = 0;
  b.load("lower", {0.1, 0.05, -0.3}, {0.5, 0.2, 0});
  Simulation simulation(b.scene, options("em", kPathStep, 1e-12));
  EXPECT_TRUE(simulation.solve_static(5).converged);
  return simulation.probe(0).pose.position;
}

// Flexible links tend to the link without elements like 1/stiffness. Terms of the next order are smaller by
// 1/stiffness.
TEST(RigidLimit, IsTheLinkWithoutElements) {
  const Vector3 rigid = place_at_rest(INFINITY);
  double before = (place_at_rest(1e3) - rigid).norm();
  EXPECT_GT(before, 1e-6) << "the test must see the compliance";
  for (const double stiffness : {1e4, 1e5}) {
    const double difference = (place_at_rest(stiffness) - rigid).norm();
    std::printf("stiffness %.0e: difference %.3e, slope %.5f\n", stiffness, difference,
                std::log10(difference / before));
    EXPECT_NEAR(std::log10(difference / before), -1, 0.01);
    before = difference;
  }
}

// The same in a motion that begins smoothly, so that it excites no vibrations. Only the deflection of the link differs.
TEST(RigidLimit, IsTheMotionOfTheLinkWithoutElements) {
  const auto path = [](double stiffness) {
    SceneBuilder b = pendulum(std::isinf(stiffness) ? 1 : stiffness);
    if (std::isinf(stiffness)) b.scene.links[1].beam->elements = 0;
    b.scene.gravity.setZero();
    b.load("lower", {0.1, 0, -0.3}, {1, 0.5, 0}, Vector3::Zero(), "t^4*(1 - t)");
    Simulation simulation(b.scene, options("edmc2", kPathStep, 1e-12));
    std::vector<Vector3> places;
    run(simulation, 200, [&] { places.push_back(simulation.probe(0).pose.position); });
    return places;
  };
  const std::vector<Vector3> rigid = path(INFINITY);
  double before = largest_distance(path(1e2), rigid);
  for (const double stiffness : {1e3, 1e4}) {
    const double difference = largest_distance(path(stiffness), rigid);
    std::printf("stiffness %.0e: difference %.3e, slope %.5f\n", stiffness, difference,
                std::log10(difference / before));
    EXPECT_NEAR(std::log10(difference / before), -1, 0.02);
    before = difference;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, RigidLimit, ::testing::Values("em", "m1"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace flexarm::test
