// Forces that jump within steps: they enter by their integrals, so that a jump costs no order.
#include <cmath>

#include "math/pi.h"
#include "reference/observed_order.h"
#include "reference/ode.h"
#include "reference/one_coordinate_scenes.h"
#include "reference/reference_cantilever.h"
#include "reference/strains.h"
#include "support/scheme_variants.h"

namespace flexarm::test {
namespace {

const double kJump = std::sqrt(0.1);  // s; no step ends there
const std::string kJumping = "t < sqrt(0.1) ? 3 : -3";

std::vector<std::string> schemes_of_second_order() {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes())
    if (scheme.order >= 2) names.emplace_back(scheme.name);
  return names;
}

constexpr scene::DirectSection kSection{4e3, 1e3, 1e3, 6, 8, 12, 1, 0.01, 0.004, 0.006};

/// Position of a mass that was at rest, after 1 s under a force that jumps.
double position_after_a_jump(double mass) {
  const double a = 3 / mass, rest = 1 - kJump;
  return a * (0.5 * kJump * kJump + kJump * rest - 0.5 * rest * rest);
}

double position_at_1(const SceneBuilder& builder, const std::string& scheme, int steps) {
  Simulation simulation(builder.scene, options(scheme, 1.0 / steps, 1e-12));
  run(simulation, steps);
  return simulation.position(0);
}

/// Order between steps around 1/45 s and those a fourth as long; several of each, since the error depends on where in
/// its step a jump is.
double order_of(const SceneBuilder& builder, const std::string& scheme, double exact) {
  double error[2] = {};
  for (const int steps : {40, 43, 47, 53, 59})
    for (const int i : {0, 1})
      error[i] = std::max(error[i], std::abs(position_at_1(builder, scheme, i == 0 ? steps : 4 * steps) - exact));
  return 0.5 * observed_order(error[0], error[1]);
}

class JumpBy : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Schemes, JumpBy, ::testing::ValuesIn(schemes_of_second_order()),
                         [](const auto& info) { return info.param; });

TEST_P(JumpBy, OfAnEffortKeepsSecondOrder) {
  SceneBuilder b = block_on_rail();
  b.scene.efforts.push_back({"rail", TimeFunction::parse(kJumping), {}});
  EXPECT_GT(order_of(b, GetParam(), position_after_a_jump(kBlockMass)), 1.8);
}

TEST_P(JumpBy, OfALoadKeepsSecondOrder) {
  SceneBuilder b = block_on_rail();
  b.scene.loads.push_back(
      {"block", {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, scene::LoadFrame::World, TimeFunction::parse(kJumping), {}});
  EXPECT_GT(order_of(b, GetParam(), position_after_a_jump(kBlockMass)), 1.8);
}

// Cut at its limit at each instant, not in the mean: 3 instead of 30.
TEST_P(JumpBy, BeyondALimitKeepsSecondOrder) {
  SceneBuilder b = block_on_rail();
  b.scene.joints[0].effort_limit = 3;
  b.scene.efforts.push_back({"rail", TimeFunction::parse("t < sqrt(0.1) ? 30 : -3"), {}});
  EXPECT_GT(order_of(b, GetParam(), position_after_a_jump(kBlockMass)), 1.8);
}

TEST_P(JumpBy, OfATorqueKeepsSecondOrderOfAPendulum) {
  SceneBuilder b;
  constexpr double kArm = 0.5, kInertia = 0.1;
  b.body("bar", 1, {kArm, 0, 0}, Vector3(0.1, 0.1, kInertia).asDiagonal());
  b.joint("hinge", scene::JointKind::Revolute, "world", "bar", {0, 0, 0}, {0, 0, 1});
  b.scene.gravity = {0, -kGravity, 0};
  b.scene.efforts.push_back({"hinge", TimeFunction::parse(kJumping), {}});
  const auto motion = [](double torque) {
    return [torque](double, const Eigen::VectorXd& y) {
      return Eigen::VectorXd(
          Eigen::Vector2d(y[1], (torque - kGravity * kArm * std::cos(y[0])) / (kInertia + kArm * kArm)));
    };
  };
  const Eigen::VectorXd at_jump = solve_ode(motion(3), 0, kJump, Eigen::Vector2d::Zero());
  EXPECT_GT(order_of(b, GetParam(), solve_ode(motion(-3), kJump, 1, at_jump)[0]), 1.8);
}

// Of a mean force: h^2 theta (1 - theta)/2 times the jump of the acceleration, for a jump at theta of the step.
TEST(Jump, LeavesTheErrorThatTheoryTells) {
  SceneBuilder b = block_on_rail();
  b.scene.efforts.push_back({"rail", TimeFunction::parse(kJumping), {}});
  for (const char* scheme : {"em", "em0", "edmc2", "m1", "std"})
    for (const int steps : {10, 13, 50}) {
      const double h = 1.0 / steps, theta = kJump / h - std::floor(kJump / h);
      // From +3 to -3: the scheme has the later impulse of the jump too early.
      const double error = 0.5 * h * h * theta * (1 - theta) * -6 / kBlockMass;
      EXPECT_NEAR(position_at_1(b, scheme, steps) - position_after_a_jump(kBlockMass), error, 1e-11)
          << scheme << " " << steps;
    }
}

// Where the force is constant between jumps its impulses are exact, and so are velocities at ends of steps.
TEST(Jump, IsCountedExactlyInWorkAndMomentum) {
  SceneBuilder b = block_on_rail();
  b.scene.efforts.push_back({"rail", TimeFunction::parse("sign(sin(41.3*t)) + min(1, 3*t)"), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  const double start = energy_account(simulation);
  run(simulation, 200, [&] { EXPECT_NEAR(energy_account(simulation), start, 1e-12); });
  const double left = std::abs(std::remainder(41.3 * 2.0, 2 * kPi)) / 41.3, ramp = 0.5 / 3 + (2 - 1.0 / 3);
  EXPECT_NEAR(simulation.energies().kinetic, 0.5 * std::pow(left + ramp, 2) / kBlockMass, 1e-11);
}

// Prestrains and loads of a flexible arm that jump: the account stays closed to Newton's tolerance.
TEST(Jump, OfPrestrainsAndLoadsClosesTheAccountOfBeams) {
  for (const char* scheme : {"em", "edmc2", "em_symmetric"}) {
    SceneBuilder b = cantilever_scene({{line({1, 0, 0})}, kSection}, 4, 2);
    b.scene.integrator.tolerance = 1e-12;
    b.scene.links[1].beam->prestrain[kBendingZ] = TimeFunction::parse("t < 0.0527 ? 0.5 : (t < 0.1003 ? 0.2 : 0.7)");
    b.scene.links[1].beam->prestrain[kTorsion] = TimeFunction::parse("abs(sin(31*t))");
    b.scene.loads.push_back(
        {"arm", {1, 0, 0}, {0, 1, 2}, {0, 0, 0}, scene::LoadFrame::World, TimeFunction::parse("sign(cos(77*t))"), {}});
    Simulation simulation(b.scene, options(scheme, 2e-3, 1e-12));
    const double start = energy_account(simulation);
    run(simulation, 100, [&] { EXPECT_NEAR(energy_account(simulation), start, 1e-10) << scheme; });
    EXPECT_GT(std::abs(simulation.energies().work), 0.1);
  }
}

}  // namespace
}  // namespace flexarm::test
