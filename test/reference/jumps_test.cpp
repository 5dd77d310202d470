// Tests forces that jump within steps. They act by their integrals, so that a jump does not reduce the order.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "math/pi.h"
#include "reference/ode.h"
#include "reference/one_coordinate_scenes.h"
#include "reference/reference_cantilever.h"
#include "support/scheme_variants.h"

namespace flexarm::test {
namespace {

const double kJump = std::sqrt(0.1);  // no step ends there
const std::string kJumping = "t < sqrt(0.1) ? 3 : -3";

std::vector<std::string> schemes_of_second_order() {
  std::vector<std::string> names;
  for (const Scheme& scheme : schemes())
    if (scheme.order >= 2) names.emplace_back(scheme.name);
  return names;
}

constexpr scene::DirectSection kSection{4e3, 1e3, 1e3, 6, 8, 12, 1, 0.01, 0.004, 0.006};

/// Exact position after 1 s of a mass that starts from rest, under a force that jumps.
double position_after_a_jump(double mass) {
  const double a = 3 / mass, rest = 1 - kJump;
  return a * (0.5 * kJump * kJump + kJump * rest - 0.5 * rest * rest);
}

double position(const Simulation& simulation) {
  return simulation.position(0);
}
double tip(const Simulation& simulation) {
  return simulation.probe(0).pose.position.x();
}

using Measure = double (*)(const Simulation&);

double position_at_1(const SceneBuilder& builder, const std::string& scheme, int steps, Measure measure = position) {
  Simulation simulation(builder.scene, options(scheme, 1.0 / steps, 1e-12));
  run(simulation, steps);
  return measure(simulation);
}

/// Observed order between steps around 1/48 s and steps a fourth as long. Takes the worst of many lengths each, since
/// the error depends on where in its step the jump is.
double order_of(const SceneBuilder& builder, const std::string& scheme, double exact, Measure measure = position) {
  double error[2] = {};
  for (int steps = 40; steps < 60; ++steps)
    for (const int i : {0, 1}) {
      const double end = position_at_1(builder, scheme, i == 0 ? steps : 4 * steps, measure);
      error[i] = std::max(error[i], std::abs(end - exact));
    }
  return 0.5 * observed_order(error[0], error[1]);
}

constexpr double kRotor = 1;  // kg, reflected to the joint

SceneBuilder block_with_motor() {
  SceneBuilder b = block_on_rail();
  b.drive("rail", 10, kRotor / 100);
  return b;
}

constexpr double kOmega = 5;  // rad/s

/// A rod of 1 kg and 1 m, clamped at one end, which heat makes longer. It is one element, whose free end has a third of
/// the mass. Its axial motion is linear with the frequency kOmega.
SceneBuilder heated_rod(const std::string& heat) {
  constexpr scene::DirectSection kRod{kOmega * kOmega / 3, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  SceneBuilder b = cantilever_scene({{line({1, 0, 0})}, kRod}, 1, 1);
  b.scene.integrator.tolerance = 1e-12;
  b.scene.links[1].beam->prestrain[kAxial] = TimeFunction::parse(heat);
  return b;
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

// The limit cuts the effort at each instant instead of its mean: 3 instead of 30.
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

// A motor's demand is a force like others. So is the set point and the feedforward of a controller in mode `effort`.
TEST_P(JumpBy, OfWhatAMotorIsAskedForKeepsSecondOrder) {
  const auto expect_order = [](const SceneBuilder& b) {
    EXPECT_GT(order_of(b, GetParam(), position_after_a_jump(kBlockMass + kRotor)), 1.8);
  };
  SceneBuilder by_effort = block_with_motor(), by_set_point = by_effort, by_feedforward = by_effort;
  by_effort.scene.efforts.push_back({"rail", TimeFunction::parse(kJumping), {}});
  expect_order(by_effort);
  by_set_point.servo("rail", 0).mode = ServoMode::Effort;
  by_set_point.scene.servos[0].set_point = TimeFunction::parse(kJumping);
  expect_order(by_set_point);
  by_feedforward.servo("rail", 0).mode = ServoMode::Effort;
  by_feedforward.scene.servos[0].feedforward = TimeFunction::parse(kJumping);
  expect_order(by_feedforward);
}

// Equation m v' = kp (w - v), where w jumps from w_0 to w_1.
TEST_P(JumpBy, OfASetVelocityKeepsSecondOrder) {
  constexpr double kGain = 6, kFirst = 1.5, kThen = -1, kRate = kGain / kBlockMass;
  // Distance of a motion with the initial velocity `begin`
  const auto way = [](double begin, double set, double time) {
    return set * time + (begin - set) * (1 - std::exp(-kRate * time)) / kRate;
  };
  const double at_jump = kFirst * (1 - std::exp(-kRate * kJump));
  SceneBuilder b = block_on_rail();
  scene::ServoDescription& servo = b.servo("rail", kGain);
  servo.mode = ServoMode::Velocity;
  servo.set_point = TimeFunction::parse("t < sqrt(0.1) ? 1.5 : -1");
  EXPECT_GT(order_of(b, GetParam(), way(0, kFirst, kJump) + way(at_jump, kThen, 1 - kJump)), 1.8);
}

// Equation m q'' = kp (w - q) + kd (w' - q'). A jump of w is an impulse kd of the jump, of which only the step is known
// in which it acts. Half a step too early or too late gives a position error of at most kd/m h/2; the bound is twice
// that. The exact motion starts from w - q = 1 and q' = kd/m.
TEST_P(JumpBy, OfASetPositionDeliversItsImpulse) {
  constexpr double kStiffness = 60, kDamping = 8, kDecay = kDamping / (2 * kBlockMass);
  const double omega = std::sqrt(kStiffness / kBlockMass - kDecay * kDecay), time = 1 - kJump;
  const double exact =
      1 - std::exp(-kDecay * time) * (std::cos(omega * time) - kDecay / omega * std::sin(omega * time));
  SceneBuilder b = block_on_rail();
  b.servo("rail", kStiffness, kDamping).set_point = TimeFunction::parse("t < sqrt(0.1) ? 0 : 1");
  for (const int steps : {160, 172, 188, 212, 236})
    EXPECT_NEAR(position_at_1(b, GetParam(), steps), exact, kDamping / kBlockMass / steps) << steps;
}

// Equation m/3 u'' + k u = k p, where p jumps.
TEST_P(JumpBy, OfAPrestrainKeepsSecondOrder) {
  const double exact = 1 + 0.02 * (1 - std::cos(kOmega)) - 0.04 * (1 - std::cos(kOmega * (1 - kJump)));
  EXPECT_GT(order_of(heated_rod("t < sqrt(0.1) ? 0.02 : -0.02"), GetParam(), exact, tip), 1.8);
}

// The error of a mean force is h^2 theta (1 - theta)/2 times the jump of the acceleration, for a jump at the fraction
// theta of the step.
TEST(Jump, LeavesTheErrorThatTheoryTells) {
  SceneBuilder b = block_on_rail();
  b.scene.efforts.push_back({"rail", TimeFunction::parse(kJumping), {}});
  for (const char* scheme : {"em", "em0", "edmc2", "m1", "std"})
    for (const int steps : {10, 13, 50}) {
      const double h = 1.0 / steps, theta = kJump / h - std::floor(kJump / h);
      // The force jumps from +3 to -3: the scheme applies the later impulse of the jump too early.
      const double error = 0.5 * h * h * theta * (1 - theta) * -6 / kBlockMass;
      EXPECT_NEAR(position_at_1(b, scheme, steps) - position_after_a_jump(kBlockMass), error, 1e-11)
          << scheme << " " << steps;
    }
}

// If the force is constant between jumps, its impulses, and the velocities at the ends of steps, are exact.
TEST(Jump, IsCountedExactlyInWorkAndMomentum) {
  SceneBuilder b = block_on_rail();
  b.scene.efforts.push_back({"rail", TimeFunction::parse("sign(sin(41.3*t)) + min(1, 3*t)"), {}});
  Simulation simulation(b.scene, options("em", 0.01, 1e-12));
  const double start = energy_account(simulation);
  run(simulation, 200, [&] { EXPECT_NEAR(energy_account(simulation), start, 1e-12); });
  const double left = std::abs(std::remainder(41.3 * 2.0, 2 * kPi)) / 41.3, ramp = 0.5 / 3 + (2 - 1.0 / 3);
  EXPECT_NEAR(simulation.energies().kinetic, 0.5 * std::pow(left + ramp, 2) / kBlockMass, 1e-11);
}

// Prestrains and loads of a flexible arm jump. The account closes to Newton's tolerance.
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

// The trapezoidal rule conserves the energy of linear motions. The work of jumping prestrains is exact to round-off,
// also in steps of several lengths, and if a step ends with a jump.
TEST(Jump, OfAPrestrainClosesTheAccountOfNewmark) {
  for (const bool halves : {false, true}) {
    Simulation simulation(heated_rod("(t < 0.0527 ? 0 : (t < 0.3 ? 0.2 : -0.1)) + 0.1*max(0, sin(31*t-1))").scene,
                          options("newmark", 0.01, 1e-13));
    const double start = energy_account(simulation);
    for (int n = 0; n < 100; ++n) {
      if (halves) {
        State state = state_of(simulation);
        state.halving_level = n % 3;
        restore(simulation, state);
      }
      run(simulation, 1);
      EXPECT_NEAR(energy_account(simulation), start, 1e-12) << "step " << n << (halves ? ", halved" : "");
    }
    EXPECT_GT(std::abs(simulation.energies().work), 0.1);
  }
}

// ---------------------------------------------------------------- published values

// The Newmark family balances forces at the ends of steps, and adds a correction for a jump within the step. Published
// efforts must not contain this correction.
TEST(Jump, IsNoPartOfAMotorsEffortBehindIt) {
  for (const char* scheme : {"newmark", "hht1", "hht2", "hht3"})
    for (const bool is_elastic : {false, true})
      for (const int kind : {0, 1, 2}) {
        SceneBuilder b = block_with_motor();
        if (is_elastic) b.scene.drives[0].stiffness = 900;
        b.scene.drives[0].effort_limit = 2.5;
        const TimeFunction jumping = TimeFunction::parse("t < sqrt(0.1) ? 2 : -3");
        if (kind == 0) b.scene.efforts.push_back({"rail", jumping, {}});
        if (kind > 0) b.servo("rail", 0).mode = ServoMode::Effort;
        if (kind == 1) b.scene.servos[0].set_point = jumping;
        if (kind == 2) b.scene.servos[0].feedforward = jumping;
        Simulation simulation(b.scene, options(scheme, 0.01, 1e-12));
        run(simulation, 50, [&] {
          EXPECT_NEAR(simulation.effort(0), simulation.time() < kJump ? 2 : -2.5, 1e-12)
              << scheme << " kind " << kind << " at " << simulation.time();
        });
      }
}

// A motor without a rotor does the same work as the effort alone.
TEST(Jump, DoesTheSameWorkByAMotor) {
  for (const char* scheme : {"em", "newmark"}) {
    SceneBuilder plain = block_on_rail(), driven = plain;
    for (SceneBuilder* b : {&plain, &driven}) b->scene.efforts.push_back({"rail", TimeFunction::parse(kJumping), {}});
    driven.drive("rail", 10, 0);
    Simulation by_effort(plain.scene, options(scheme, 0.01, 1e-12)),
        by_motor(driven.scene, options(scheme, 0.01, 1e-12));
    for (int n = 0; n < 60; ++n) {
      run(by_effort, 1);
      run(by_motor, 1);
      EXPECT_NEAR(by_motor.energies().work, by_effort.energies().work, 1e-11) << scheme << " " << n;
    }
  }
}

// After a jump of the force anywhere within a step, the error of published velocities is smaller than that of
// differences of positions, and never larger than the worst of the latter.
TEST_P(JumpBy, LeavesVelocitiesBetterThanDifferencesOfPositions) {
  constexpr int kBehind = 8;
  for (const auto& [first, then] : {std::pair<double, double>{0, 3}, {3, -3}, {3, 0}, {3, 6}, {-3, 9}}) {
    double published = 0, differences = 0, worst_published = 0, worst_difference = 0;
    for (const int steps : {40, 41, 43, 46, 47, 50, 53, 55, 59, 61}) {
      SceneBuilder b = block_on_rail();
      b.scene.efforts.push_back({"rail", TimeFunction::parse(fmt::format("t < sqrt(0.1) ? {} : {}", first, then)), {}});
      Simulation simulation(b.scene, options(GetParam(), 1.0 / steps, 1e-12));
      const int before = static_cast<int>(std::floor(kJump * steps));
      run(simulation, before);
      double last = simulation.position(0);
      run(simulation, kBehind, [&, first = first, then = then] {
        const double exact = (first * kJump + then * (simulation.time() - kJump)) / kBlockMass;
        const double of_published = (simulation.velocity(0) - exact) * steps,
                     of_difference = (simulation.position(0) - last) * steps * steps - exact * steps;
        last = simulation.position(0);
        published += of_published * of_published;
        differences += of_difference * of_difference;
        worst_published = std::max(worst_published, std::abs(of_published));
        worst_difference = std::max(worst_difference, std::abs(of_difference));
      });
    }
    EXPECT_LT(published, differences) << "from " << first << " to " << then;
    EXPECT_LE(worst_published, worst_difference * (1 + 1e-9)) << "from " << first << " to " << then;
  }
}

}  // namespace
}  // namespace flexarm::test
