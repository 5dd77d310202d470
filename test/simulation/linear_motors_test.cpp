// Tests linear models about an instant of a motion with motors and controllers, against closed forms of a rotor on a
// hinge.
#include <cmath>

#include "flexarm/simulation/linear_model.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

/// The derivative of the set point is computed as a central difference. Its error is eps^(2/3)/6 times the third
/// derivative, 0.3 5^3.
constexpr double kRateError = 3e-10;
constexpr double kInertia = 2, kRotor = 0.4;  // of the link and of the rotor about the hinge [kg m^2]

/// A wheel on a hinge that is driven by a motor, after a quarter of a second.
Simulation turning_wheel(const std::string& drive, const std::string& servo) {
  Simulation simulation(test::scene_of(test::robot(
      test::joint("hinge", "continuous", "world", "wheel", "<axis xyz='0 0 1'/>") +
          test::body("wheel", 1, {1, 1, kInertia}) +
          fmt::format(
              R"(<drive joint="hinge" rotor_inertia="{}" {}/> <servo joint="hinge" {} set_point="sin(5*t)*0.3"/>)",
              kRotor, drive, servo),
      test::integrator("em", 0.001, 1e-13) + test::gravity({0, 0, 0}) +
          "<initial joint='hinge' position='0.2' velocity='-0.5'/>")));
  test::run(simulation, 250);
  return simulation;
}

LinearModel about_now(const Simulation& simulation) {
  LinearRequest request;
  request.about = LinearisedAbout::Instant;
  return linearise(simulation, request);
}

constexpr const char* kFollowing = R"(mode="position" kp="30" kd="2")";
double set_point(double time) {
  return 0.3 * std::sin(5 * time);
}
double set_rate(double time) {
  return 1.5 * std::cos(5 * time);
}

// Closed form: (I + J) q'' = kp (s - q) + kd (s' - q').
TEST(LinearMotors, SetPointThatMoves) {
  const Simulation simulation = turning_wheel("", kFollowing);
  const LinearModel model = about_now(simulation);
  const double time = simulation.time(), place = simulation.position(0), rate = model.drift[0];
  const double effort = 30 * (set_point(time) - place) + 2 * (set_rate(time) - rate);
  EXPECT_NEAR(model.drift[1], effort / (kInertia + kRotor), 2 * kRateError);
  EXPECT_NEAR(model.a(1, 0), -30 / (kInertia + kRotor), 1e-12 * 30);
  EXPECT_NEAR(model.a(1, 1), -2 / (kInertia + kRotor), 1e-12 * 30);
}

// A commanded effort is added to that of the controller.
TEST(LinearMotors, EffortBesideTheController) {
  Simulation simulation = turning_wheel("", kFollowing);
  const double alone = about_now(simulation).drift[1];
  simulation.command_effort(0, 0.7);
  EXPECT_NEAR(about_now(simulation).drift[1] - alone, 0.7 / (kInertia + kRotor), 1e-13);
}

// Closed form in mode velocity: (I + J) q'' = kp (s - q').
TEST(LinearMotors, SetSpeed) {
  const Simulation simulation = turning_wheel("", R"(mode="velocity" kp="3")");
  const LinearModel model = about_now(simulation);
  const double effort = 3 * (set_point(simulation.time()) - model.drift[0]);
  EXPECT_NEAR(model.drift[1], effort / (kInertia + kRotor), 1e-12 * std::abs(effort));
  EXPECT_EQ(model.a(1, 0), 0);
  EXPECT_NEAR(model.a(1, 1), -3 / (kInertia + kRotor), 1e-12 * 3);
}

// If the limit cuts the total effort, it depends neither on position nor on rate.
TEST(LinearMotors, CutByALimit) {
  const Simulation simulation = turning_wheel(R"(effort_limit="0.3")", kFollowing);
  const LinearModel model = about_now(simulation);
  const double time = simulation.time();
  const double asked = 30 * (set_point(time) - simulation.position(0)) + 2 * (set_rate(time) - model.drift[0]);
  ASSERT_GT(std::abs(asked), 0.3);
  EXPECT_NEAR(model.drift[1], std::copysign(0.3, asked) / (kInertia + kRotor), 1e-15);
  EXPECT_EQ(model.a(1, 0), 0);
  EXPECT_EQ(model.a(1, 1), 0);
}

// A part of the effort exceeds the limit, but the sum of all parts does not. So nothing is cut.
TEST(LinearMotors, LimitOfTheSum) {
  const Simulation simulation = turning_wheel(R"(effort_limit="50")", R"(mode="position" kp="30" kd="200")");
  const LinearModel model = about_now(simulation);
  const double time = simulation.time();
  const double effort = 30 * (set_point(time) - simulation.position(0)) + 200 * (set_rate(time) - model.drift[0]);
  ASSERT_GT(std::abs(200 * set_rate(time)), 50);
  ASSERT_LT(std::abs(effort), 50);
  EXPECT_NEAR(model.drift[1], effort / (kInertia + kRotor), 200 * kRateError);
  EXPECT_NEAR(model.a(1, 1), -200 / (kInertia + kRotor), 1e-12 * 200);
}

// Closed form: I q'' = k (r - q) + d (r' - q'),  J r'' = kp (s - r) + kd (s' - r') - I q''.
TEST(LinearMotors, RotorBehindAnElasticGear) {
  const double stiffness = 500, damping = 3;
  const Simulation simulation = turning_wheel(R"(stiffness="500" damping="3")", kFollowing);
  const LinearModel model = about_now(simulation);
  ASSERT_EQ(model.states, (std::vector<std::string>{"hinge", "rotor:hinge", "d/dt hinge", "d/dt rotor:hinge"}));
  const double time = simulation.time(), load = kInertia * model.drift[2];
  const double twist = (load - damping * (model.drift[1] - model.drift[0])) / stiffness;
  const double rotor = simulation.position(0) + twist;
  const double motor = 30 * (set_point(time) - rotor) + 2 * (set_rate(time) - model.drift[1]);
  EXPECT_NEAR(model.drift[3], (motor - load) / kRotor, 2 / kRotor * kRateError);
  Eigen::Matrix2d expected;
  expected << -stiffness / kInertia, stiffness / kInertia, stiffness / kRotor, -(stiffness + 30) / kRotor;
  EXPECT_LT((model.a.bottomLeftCorner(2, 2) - expected).norm(), 1e-12 * expected.norm());
  expected << -damping / kInertia, damping / kInertia, damping / kRotor, -(damping + 2) / kRotor;
  EXPECT_LT((model.a.bottomRightCorner(2, 2) - expected).norm(), 1e-12 * expected.norm());
}

}  // namespace
}  // namespace flexarm
