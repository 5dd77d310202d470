// Tests cylinders that roll, lie, spin and tilt on flat faces, against closed forms and against a coin's own equations.
#include <cmath>

#include "contact/shape.h"
#include "math/pi.h"
#include "math/so3.h"
#include "reference/contact_scenes.h"
#include "reference/ode.h"

namespace flexarm::test::touching {
namespace {

/// A disc, whose axis is the link's y. Its flat faces are `thick` apart.
struct Disc {
  double mass, radius, thick;

  Vector3 moments() const {
    const double across = mass * (3 * radius * radius + thick * thick) / 12, polar = mass * radius * radius / 2;
    return {across, polar, across};
  }
  std::string link(const std::string& name) const {
    return body(name, mass, moments(), Vector3::Zero(),
                "<collision><origin rpy='1.5707963267948966 0 0'/><geometry>" +
                    fmt::format("<cylinder radius='{:.17g}' length='{:.17g}'/>", radius, thick) +
                    "</geometry></collision>");
  }
};
constexpr Disc kWheel{1, 0.1, 0.04};

/// A wheel on a slope, at rest or rolling. `lies`: on its face.
Simulation on_slope(double angle, double speed, bool lies, const std::string& support = kFloor) {
  const Vector3 g = kG * Vector3(std::sin(angle), 0, -std::cos(angle));
  const double height = lies ? kWheel.thick / 2 : kWheel.radius;
  std::string starts = start("wheel", {0, 0, height}, {speed, 0, 0}, {0, speed / kWheel.radius, 0});
  if (lies) starts += fmt::format("<initial joint='of_wheel/rx' position='{:.17g}'/>", kPi / 2);
  return simulation_of(
      kWheel.link("wheel") + floating("wheel") + support + contact_of("wheel", "floor", "friction='0.8'"), starts, 1e-3,
      g);
}

// The wheel starts without penetration and sinks by p = m g / k, where k is that part of m (pi / 10 ms)^2 which two
// rims have. While it does so, it may slip by a part p / R of its way, and its speed changes by the square of this. The
// hardening lets it sink by 7/2 (p / 2 mm)^2 less (docs/notes/stops.md 2).
TEST(ContactOfRims, WheelCoasts) {
  const double rims = 2 * (1 - 2 / (3 * (1 - kDrawnIn))), sunk = kG / rims / std::pow(kPi / 0.01, 2) / kWheel.radius;
  const std::string plate = fixed("floor", "<box size='8 1 0.1'/>", "<origin xyz='0 0 -0.05'/>");
  for (const std::string& support : {kFloor, plate}) {
    Simulation simulation = on_slope(0, 0.5, false, support);
    run_until(simulation, 3);
    EXPECT_NEAR(simulation.momentum().x(), 0.5, 0.5 * sunk * sunk) << support;
    EXPECT_NEAR(simulation.link_pose(1).position.x(), 1.5, 1.5 * sunk * sunk) << support;
    EXPECT_NEAR(simulation.link_pose(1).position.z(), kWheel.radius * (1 - sunk),
                8 * std::pow(sunk * kWheel.radius / (0.05 * kWheel.thick), 2) * sunk * kWheel.radius)
        << support;
  }
}

TEST(ContactOfRims, WheelRollsDownSlopesAndStandsOnItsFace) {
  for (const double degrees : {0.5, 8.0}) {
    const double angle = degrees * kPi / 180, along = kG * std::sin(angle), stuck = along / std::pow(kPi / 0.01, 2);
    Simulation rolling = on_slope(angle, 0, false);
    run_until(rolling, 2);
    // The first hundredth of a second is that of settling.
    EXPECT_NEAR(rolling.link_pose(1).position.x(), along / 3 * 4, 1e-4 * along) << degrees;
    EXPECT_NEAR(rolling.momentum().x(), along * 2 / 3 * 2, 1e-5 * along) << degrees;
    Simulation lying = on_slope(angle, 0, true);
    run_until(lying, 2);
    EXPECT_NEAR(lying.momentum().norm(), 0, 1e-12) << degrees;
    EXPECT_LE(lying.link_pose(1).position.x(), 2 * stuck) << degrees << ": twice the stretch of what sticks";
  }
}

// A wheel rolls over the edge of a table and falls: it leaves it at its middle, turned about the edge.
TEST(ContactOfRims, WheelRollsOffATable) {
  Simulation simulation = on_slope(0, 0.5, false, fixed("floor", "<box size='2 1 0.1'/>", "<origin xyz='0 0 -0.05'/>"));
  run_until(simulation, 1.9);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), kWheel.radius, 3e-4) << "its middle is above the table";
  run_until(simulation, 2.6);
  EXPECT_LT(simulation.link_pose(1).position.z(), -0.5);
  const Energies energies = simulation.energies();
  EXPECT_NEAR(energies.total() + energies.dissipated, kWheel.mass * (kG * kWheel.radius + 0.75 * 0.25), 1e-9);
}

// A car of four wheels on hinges rolls with the inertia m + 4 J / R^2.
TEST(ContactOfRims, CarRollsDownASlope) {
  const double angle = 0.05;
  std::string parts =
      box("car", 2, {0.4, 0.2, 0.05}) + floating("car") + kFloor + contact_of("*", "floor", "friction='0.8'");
  for (const int k : {0, 1, 2, 3}) {
    const std::string name = fmt::format("wheel_{}", k);
    parts += kWheel.link(name) + joint("axle" + name, "continuous", "car", name,
                                       fmt::format("<origin xyz='{} {} 0'/><axis xyz='0 1 0'/>", k < 2 ? 0.15 : -0.15,
                                                   k % 2 ? 0.15 : -0.15));
  }
  Simulation simulation = simulation_of(parts, start("car", {0, 0, kWheel.radius}, Vector3::Zero()), 1e-3,
                                        kG * Vector3(std::sin(angle), 0, -std::cos(angle)));
  run_until(simulation, 1);
  EXPECT_NEAR(simulation.momentum().x() / 6, kG * std::sin(angle) * 6 / 8, 1e-4);
  EXPECT_NEAR(simulation.momentum().y(), 0, 1e-9);
}

// ---------------------------------------------------------------- a coin

constexpr Disc kCoin{1, 0.1, 0.01};
constexpr double kCoinTilt = 25 * kPi / 180;

/// From the middle of a coin to the lowest point of its lower rim. `axis`: of the coin, a unit vector.
Vector3 lowest_of_coin(const Vector3& axis) {
  const double cosine = axis.z();
  const Vector3 down = Vector3::UnitZ() - cosine * axis;
  return -std::copysign(kCoin.thick / 2, cosine) * axis - kCoin.radius * down.normalized();
}

/// Rates of {middle, axis, rate of rotation} of a coin that rolls without slip on a rigid plane: the velocity of the
/// lowest point is 0, and the moments about it are in balance.
Eigen::VectorXd coin_rates(double, const Eigen::VectorXd& y) {
  const Vector3 axis = y.segment<3>(3).normalized(), rate = y.segment<3>(6), turn = rate.cross(axis);
  const Vector3 moments = kCoin.moments();
  const Matrix3 inertia = moments.x() * Matrix3::Identity() + (moments.y() - moments.x()) * axis * axis.transpose();
  const Vector3 arm = lowest_of_coin(axis);
  const double cosine = axis.z();
  const Vector3 down = Vector3::UnitZ() - cosine * axis, down_rate = -turn.z() * axis - cosine * turn;
  const double length = down.norm();
  const Vector3 arm_rate = -std::copysign(kCoin.thick / 2, cosine) * turn -
                           kCoin.radius * (down_rate / length - down * down.dot(down_rate) / std::pow(length, 3));
  const Matrix3 cross = so3::hat(arm);
  const Vector3 moment =
      -rate.cross(inertia * rate) + kCoin.mass * arm.cross(kG * Vector3::UnitZ() - rate.cross(arm_rate));
  Eigen::VectorXd out(9);
  out << -rate.cross(arm), turn, (inertia - kCoin.mass * cross * cross).lu().solve(moment);
  return out;
}

/// Where a coin that starts as the equations' own is after 2 s, with a contact of this time [m].
Vector3 rolled_coin(const Eigen::VectorXd& begin, double contact_time, double step) {
  Simulation simulation = simulation_of(
      kCoin.link("coin") + floating("coin") + kFloor +
          contact_of("coin", "floor", fmt::format("friction='4' restitution='0' contact_time='{}'", contact_time)),
      start("coin", begin.head<3>(), coin_rates(0, begin).head<3>(), begin.tail<3>()) +
          fmt::format("<initial joint='of_coin/rx' position='{:.17g}'/>", kCoinTilt),
      step);
  run_until(simulation, 2);
  return simulation.link_pose(1).position;
}

// The coin rolls and nutates in a circle. It sinks in proportion to the square of the contact time, and so does the
// error.
TEST(ContactOfRims, CoinRollsAsItsOwnEquationsSay) {
  const Vector3 axis(0, std::cos(kCoinTilt), std::sin(kCoinTilt));
  Eigen::VectorXd begin(9);
  begin << -lowest_of_coin(axis), axis, 1.5 * Vector3::UnitZ() + 6.0 * axis;
  const Vector3 expected = solve_ode(coin_rates, 0, 2, begin).head<3>();
  const double coarse = (rolled_coin(begin, 2e-3, 5e-4) - expected).norm(),
               fine = (rolled_coin(begin, 1e-3, 2.5e-4) - expected).norm();
  EXPECT_GT((begin.head<3>() - expected).norm(), 0.1);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(observed_order(coarse, fine), 1.5);
}

// A disc that falls in any way loses energy by what the account says, and comes to rest on its face or its side.
TEST(ContactOfRims, FallingDiscsKeepTheirAccount) {
  for (const double tilt : {0.0, 0.02, 0.5, 1.2, 1.5707}) {
    Simulation simulation = simulation_of(kWheel.link("wheel") + floating("wheel") + kFloor +
                                              contact_of("wheel", "floor", "friction='0.3' restitution='0.3'"),
                                          start("wheel", {0, 0, 0.3}, Vector3::Zero(), {1, 2, 3}) +
                                              fmt::format("<initial joint='of_wheel/rx' position='{}'/>", tilt),
                                          1e-3);
    const double begin = simulation.energies().total();
    run_until(simulation, 3);
    const Energies energies = simulation.energies();
    EXPECT_NEAR(energies.total() + energies.dissipated, begin, 1e-9) << tilt;
    EXPECT_GT(simulation.link_pose(1).position.z(), 0.018) << tilt;
  }
}

}  // namespace
}  // namespace flexarm::test::touching
