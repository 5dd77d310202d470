// Compares estimates of the longest step of explicit schemes with closed forms, and with runs that grow or decay.
#include "integrators/explicit_limit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/inside.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Where steps of y' = z y begin to grow: on the negative real axis and on the imaginary axis. Those of rk4 follow from
/// its stability polynomial of degree 4 (Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, IV.2),
/// those of dop853 are of scipy's coefficients. The estimate refines them to 0.01.
struct Reach {
  const char* scheme;
  double decay, oscillation;
};
constexpr Reach kReaches[] = {{"rk4", 2.78529, 2.82843}, {"dop853", 6.39, 5.96}};
constexpr double kRefinement = 0.015;

SceneBuilder wheel(double inertia) {
  SceneBuilder b;
  b.body("wheel", 1, Vector3::Zero(), inertia * Matrix3::Identity());
  b.joint("axle", JointKind::Continuous, "world", "wheel", Vector3::Zero(), {0, 1, 0});
  return b;
}

ExplicitLimit limit_of(const SceneBuilder& b, const std::string& scheme) {
  SimulationOptions options;
  options.scheme = scheme;
  const Simulation simulation(b.scene, options);
  return explicit_limit(model_of(simulation), scheme_of(simulation), state_of(simulation), 1e-3);
}

TEST(ExplicitLimit, OfADamperASpringAServoAndAGear) {
  for (const Reach& reach : kReaches) {
    SCOPED_TRACE(reach.scheme);
    const auto expect = [&](const SceneBuilder& b, const std::string& cause, double rate, double of) {
      const ExplicitLimit limit = limit_of(b, reach.scheme);
      EXPECT_EQ(limit.coordinate, 0);
      EXPECT_EQ(limit.cause, cause);
      EXPECT_NEAR(limit.step * rate, of, kRefinement);
    };
    EXPECT_EQ(limit_of(wheel(0.1), reach.scheme).coordinate, -1);
    SceneBuilder damped = wheel(0.1);
    damped.scene.joints[0].damping = 500;
    expect(damped, "damping", 500 / 0.1, reach.decay);
    SceneBuilder sprung = wheel(0.1);
    sprung.scene.springs.push_back({"axle", 4000, 0, {}, 0});
    expect(sprung, "spring", std::sqrt(4000 / 0.1), reach.oscillation);
    SceneBuilder controlled = wheel(0.1);
    controlled.servo("axle", 100, 50);
    expect(controlled, "servo", 50 / 0.1, reach.decay);
    SceneBuilder geared = wheel(0.1);
    geared.drive("axle", 10, 2e-4).stiffness = 4000;  // the rotor counts as 100 times its inertia
    expect(geared, "gear", std::sqrt(4000 * (1 / 0.1 + 1 / 0.02)), reach.oscillation);
  }
}

// A cart of mass M carries one of mass m, with a damper each: the rates are the eigenvalues of
// [1/M, -1/M; -1/M, 1/M + 1/m] diag(c, d).
TEST(ExplicitLimit, OfDampersTogether) {
  const double M = 3, m = 0.2, c = 40, d = 30;
  SceneBuilder b;
  b.body("cart", M, Vector3::Zero(), Matrix3::Identity());
  b.body("load", m, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "cart").damping = c;
  b.scene.joints.back().axis = {1, 0, 0};
  b.joint("bed", JointKind::Prismatic, "cart", "load").damping = d;
  b.scene.joints.back().axis = {1, 0, 0};
  const double trace = c / M + d * (1 / M + 1 / m), determinant = c * d / (M * m);
  const double rate = 0.5 * (trace + std::sqrt(trace * trace - 4 * determinant));
  const ExplicitLimit limit = limit_of(b, "rk4");
  EXPECT_EQ(limit.coordinate, 1);
  EXPECT_NEAR(limit.step * rate, kReaches[0].decay, kRefinement);
}

// Of a wheel whose twin mimics it with the ratio 2, dampers see J + 4 J and c + 4 c.
TEST(ExplicitLimit, OfWhatMovesWithAFollower) {
  SceneBuilder b = wheel(0.1);
  b.body("twin", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
  b.joint("follower", JointKind::Continuous, "world", "twin", Vector3::Zero(), {0, 1, 0}).mimic =
      scene::Mimic{"axle", 2, 0};
  for (scene::JointDescription& joint : b.scene.joints) joint.damping = 7;
  EXPECT_NEAR(limit_of(b, "rk4").step * 7 / 0.1, kReaches[0].decay, kRefinement);
}

TEST(ExplicitLimit, IsWhereMotionsBeginToGrow) {
  for (const Reach& reach : kReaches)
    for (const double part : {0.95, 1.05}) {
      SceneBuilder b = wheel(0.1);
      b.scene.joints[0].damping = 500;
      b.scene.initial_joints.push_back({"axle", 0, 1, {}, true});
      SimulationOptions options;
      options.scheme = reach.scheme;
      options.step = part * limit_of(b, reach.scheme).step;
      Simulation simulation(b.scene, options);
      for (int i = 0; i < 100; ++i) ASSERT_TRUE(simulation.step().converged);
      const double position = std::abs(simulation.position(0) - 0.1 / 500);  // it comes to rest at J v / c
      if (part < 1)
        EXPECT_LT(position, 1e-2 * 0.1 / 500) << reach.scheme;
      else
        EXPECT_GT(position, 1e2 * 0.1 / 500) << reach.scheme;
    }
}

TEST(ExplicitLimit, IsNamedInTheFailure) {
  // Halved steps could recover if nothing grew with the square of the rate.
  SceneBuilder b = wheel(0.1);
  b.scene.links.back().inertial->center_of_mass = {0.1, 0, 0};
  b.scene.joints[0].damping = 500;
  b.scene.initial_joints.push_back({"axle", 0, 1, {}, true});
  SimulationOptions options;
  options.scheme = "rk4";
  options.step = 2e-3;
  Simulation simulation(b.scene, options);
  StepResult result = simulation.step();
  while (result.converged && simulation.time() < 10) result = simulation.step();
  ASSERT_FALSE(result.converged);
  const std::string text = simulation.explain(result);
  EXPECT_EQ(
      text.find("the step is too long for an explicit scheme, so that the motion grows (a quantity is not finite): "
                "damping of joint coordinate 'axle' needs steps below 0.00061 s"),
      0u)
      << text;
  EXPECT_NE(text.find("What usually helps: such a step, or an implicit scheme, such as em"), std::string::npos) << text;
}

}  // namespace
}  // namespace flexarm::test
