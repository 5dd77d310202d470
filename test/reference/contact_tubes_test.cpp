// Tests bodies inside of tubes, and tubes over others, against closed forms and an equation of motion.
#include <cmath>

#include "reference/contact_scenes.h"
#include "reference/ode.h"

namespace flexarm::test::touching {
namespace {

constexpr double kBore = 0.1, kBallRadius = 0.02;

std::string tube_shape(double radius, double inner, double length) {
  return fmt::format("<cylinder radius='{}' inner_radius='{}' length='{}'/>", radius, inner, length);
}
const std::string kLying = "<origin xyz='0 0 0' rpy='1.5707963267948966 0 0'/>";

// A ball rolls to and fro in a lying tube, as a pendulum of the length 7/5 (R - r). It sinks by at most twice its
// weight over the stiffness of a contact of 2 ms.
TEST(ContactOfTubes, BallRollsInATube) {
  constexpr double kArm = kBore - kBallRadius, kStart = 0.7;
  Simulation simulation = simulation_of(
      ball("ball", 1, kBallRadius) + floating("ball") + fixed("tube", tube_shape(0.12, kBore, 0.5), kLying) +
          contact_of("ball", "tube", "friction='0.9' restitution='0' contact_time='0.002'"),
      start("ball", {kArm * std::sin(kStart), 0, -kArm * std::cos(kStart)}, Vector3::Zero()), 5e-4);
  const OdeFunction swing = [&](double, const Eigen::VectorXd& y) {
    return Eigen::VectorXd(Eigen::Vector2d(y[1], -kG * std::sin(y[0]) / (1.4 * kArm)));
  };
  Eigen::VectorXd expected = Eigen::Vector2d(kStart, 0);
  const double sunk = 2 * kG * std::pow(0.002 / 3.14159, 2);
  for (int i = 1; i <= 10; ++i) {
    run_until(simulation, 0.1 * i);
    expected = solve_ode(swing, 0.1 * (i - 1), 0.1 * i, expected);
    const Vector3 place = simulation.link_pose(1).position;
    EXPECT_NEAR(std::atan2(place.x(), -place.z()), expected[0], 1e-3) << i;
    EXPECT_NEAR(std::hypot(place.x(), place.z()), kArm, sunk) << i;
    EXPECT_NEAR(place.y(), 0, 1e-12) << i;
  }
}

TEST(ContactOfTubes, BallFallsThroughATubeOrOntoItsWall) {
  for (const double x : {0.0, 0.0799, 0.11}) {
    Simulation simulation =
        simulation_of(ball("ball", 1, kBallRadius) + floating("ball") + fixed("tube", tube_shape(0.12, kBore, 0.5)) +
                          contact_of("ball", "tube", "restitution='0'"),
                      start("ball", {x, 0, 0.5}, Vector3::Zero()), 1e-3);
    run_until(simulation, 0.4);
    const double z = simulation.link_pose(1).position.z();
    if (x < kBore)
      EXPECT_NEAR(z, 0.5 - 0.5 * kG * 0.16, 1e-9) << x;
    else
      EXPECT_NEAR(z, 0.25 + kBallRadius, 1e-3) << x;
  }
}

// A ring falls down a peg onto the floor, with a play of 1 mm.
TEST(ContactOfTubes, RingFallsDownAPeg) {
  const double moment = 1e-3;
  Simulation simulation = simulation_of(
      body("ring", 1, Vector3::Constant(moment), Vector3::Zero(), collision(tube_shape(0.04, 0.021, 0.05))) +
          floating("ring") + fixed("peg", "<cylinder radius='0.02' length='0.6'/>") +
          "<ground name='floor' offset='-0.3'/>" + contact_of("ring", "*", "friction='0.1' restitution='0.2'"),
      start("ring", {0, 0, 0.2}, Vector3::Zero()) + "<initial joint='of_ring/rx' position='0.02'/>", 1e-3);
  const double begin = energy_account(simulation);
  run_until(simulation, 3);
  const Vector3 place = simulation.link_pose(1).position;
  EXPECT_NEAR(energy_account(simulation), begin, 1e-9);
  EXPECT_NEAR(place.z(), -0.275, 2e-4) << "on the floor, but for what its weight presses";
  EXPECT_LE(place.head<2>().norm(), 0.0011) << "within the play";
}

// A rod that lies along the bottom of a tube rests there.
TEST(ContactOfTubes, RodRestsInATube) {
  Simulation simulation =
      simulation_of(body("rod", 1, {8e-3, 8e-3, 2e-4}, Vector3::Zero(),
                         "<collision><origin rpy='1.5707963267948966 0 0'/><geometry><cylinder radius='0.02' "
                         "length='0.3'/></geometry></collision>") +
                        floating("rod") + fixed("tube", tube_shape(0.12, kBore, 0.5), kLying) +
                        contact_of("rod", "tube", "friction='0.3' restitution='0.2'"),
                    start("rod", {0, 0, -0.05}, Vector3::Zero()), 1e-3);
  run_until(simulation, 2);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), -kBore + 0.02, 5e-4);
  EXPECT_NEAR(simulation.momentum().norm(), 0, 1e-6);
}

// A tube rolls down a slope with the inertia m + J / R^2.
TEST(ContactOfTubes, TubeRollsDownASlope) {
  constexpr double kOuter = 0.1, kInner = 0.08, kAngle = 0.1;
  const double along = 0.5 * (kOuter * kOuter + kInner * kInner), across = 0.5 * along + 0.04 * 0.04 / 12;
  Simulation simulation = simulation_of(body("tube", 1, {across, along, across}, Vector3::Zero(),
                                             "<collision><origin rpy='1.5707963267948966 0 0'/><geometry>" +
                                                 tube_shape(kOuter, kInner, 0.04) + "</geometry></collision>") +
                                            floating("tube") + kFloor + contact_of("tube", "floor", "friction='0.8'"),
                                        start("tube", {0, 0, kOuter}, Vector3::Zero()), 1e-3,
                                        kG * Vector3(std::sin(kAngle), 0, -std::cos(kAngle)));
  run_until(simulation, 1);
  const double expected = kG * std::sin(kAngle) / (1 + along / (kOuter * kOuter));
  EXPECT_NEAR(simulation.momentum().x(), expected, 1e-4 * expected);
}

}  // namespace
}  // namespace flexarm::test::touching
