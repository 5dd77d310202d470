// Tests forces and motions of a cylinder against a boom in closed form.
#include <cmath>

#include "flexarm/simulation/linear_model.h"
#include "math/pi.h"
#include "support/boom.h"

namespace flexarm::test {
namespace {

constexpr double kStartAngle = 0.2;  // rad
const BoomParts kMassive{2, 1.5};

std::string motion_of(const std::string& length) {
  return "<motion joint='lift' position='" + length + "'/>";
}
std::string digits_of(double value) {
  return fmt::format("{:.17g}", value);
}

}  // namespace

// Moments about the hinge: force lever = weight of the boom times its arm (and the parts').
TEST(Cylinder, HoldsTheBoomWithTheForceOfStatics) {
  for (const BoomParts& parts : {BoomParts{}, kMassive})
    for (const double angle : {-0.4, 0.0, 0.7}) {
      const BoomOnParts boom{parts};
      Simulation held(boom_scene(angle, "", motion_of(digits_of(BoomOnParts::length(angle))), parts));
      for (int n = 0; n < 3; ++n) ASSERT_TRUE(held.step().converged);
      EXPECT_NEAR(position_of(held, "hinge"), angle, 1e-12);
      const double force = boom.force(angle, 0, 0);
      EXPECT_NEAR(held.effort(*held.find_coordinate("lift")), force, 1e-8 * force) << angle;

      Simulation pushed(boom_scene(angle, "", "<effort joint='lift' history='" + digits_of(force) + "'/>", parts));
      ASSERT_TRUE(pushed.solve_static(1, Equilibrium::UnderTheLoads).converged);
      EXPECT_NEAR(position_of(pushed, "hinge"), angle, 1e-9);
    }
  const double weight = 9.81 * 10 * 0.5;  // for the boom alone: the triangle by hand
  EXPECT_NEAR(BoomOnParts().force(0, 0, 0), weight / 0.3, 1e-9);
}

// An effort that changes, a damper and a spring in the cylinder: errors fall with the square of the step.
TEST(Cylinder, PushesTheBoomAsTheDifferentialEquation) {
  for (const BoomParts& parts : {BoomParts{}, kMassive}) {
    const BoomOnParts boom{parts};
    const double rest = BoomOnParts::length(kStartAngle), end = 0.8;
    const std::array<double, 2> exact = boom_after(end, boom, kStartAngle, [&](double t, double length, double rate) {
      return 200 + 60 * std::sin(7 * t) - 150 * rate - 900 * (length - rest);
    });
    std::array<double, 2> errors;
    for (int k = 0; k < 2; ++k) {
      Simulation simulation(
          boom_scene(kStartAngle, "<dynamics damping='150'/><spring stiffness='900' rest='" + digits_of(rest) + "'/>",
                     "<effort joint='lift' history='200+60*sin(7*t)'/>", parts),
          options("em", k == 0 ? 4e-3 : 2e-3));
      run_until(simulation, end);
      const double angle = position_of(simulation, "hinge");
      EXPECT_NEAR(position_of(simulation, "lift"), BoomOnParts::length(angle), 1e-9);
      errors[k] = std::abs(angle - exact[0]);
    }
    EXPECT_GT(std::abs(exact[0] - kStartAngle), 0.1);
    EXPECT_LT(errors[1], 2e-5);
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
  }
}

// A prescribed length moves the boom by the law of cosines, and needs the force of Newton and Euler.
TEST(Cylinder, DrivesTheBoomByItsLength) {
  for (const BoomParts& parts : {BoomParts{}, kMassive}) {
    const BoomOnParts boom{parts};
    const double start = BoomOnParts::length(kStartAngle), swing = 0.05, omega = 5;
    std::array<double, 2> errors{};
    for (int k = 0; k < 2; ++k) {
      Simulation simulation(
          boom_scene(kStartAngle, "", motion_of(fmt::format("{:.17g}+{}*(1-cos({}*t))", start, swing, omega)), parts),
          options("em", k == 0 ? 4e-3 : 2e-3));
      run_until(simulation, 1, [&] {
        const double t = simulation.time(), length = start + swing * (1 - std::cos(omega * t));
        ASSERT_NEAR(position_of(simulation, "lift"), length, 1e-12);
        ASSERT_NEAR(position_of(simulation, "hinge"), BoomOnParts::angle_at(length), 1e-8);
        if (t < 0.1) return;
        const auto angle = [&](double time) {
          return BoomOnParts::angle_at(start + swing * (1 - std::cos(omega * time)));
        };
        const auto rate = [&](double time) { return BoomOnParts::derivative(angle, time); };
        const double force = boom.force(angle(t), rate(t), BoomOnParts::derivative(rate, t));
        errors[k] = std::max(errors[k], std::abs(simulation.effort(*simulation.find_coordinate("lift")) - force));
      });
    }
    EXPECT_LT(errors[1], 0.05);  // of about 200 N
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.8);
  }
}

// A spring in the cylinder holds the boom: omega^2 = V'' / M.
TEST(Cylinder, SwingsAtTheFrequencyOfOneDegreeOfFreedom) {
  for (const BoomParts& parts : {BoomParts{}, kMassive}) {
    const BoomOnParts boom{parts};
    const double stiffness = 2e4, rest = BoomOnParts::length(kStartAngle) + boom.force(kStartAngle, 0, 0) / stiffness;
    const auto potential = [&](double angle) {
      const double stretch = BoomOnParts::length(angle) - rest;
      return boom.potential(angle) + 0.5 * stiffness * stretch * stretch;
    };
    const auto slope = [&](double angle) { return BoomOnParts::derivative(potential, angle); };
    const double omega = std::sqrt(BoomOnParts::derivative(slope, kStartAngle) / boom.mass(kStartAngle));
    Simulation simulation(
        boom_scene(kStartAngle, fmt::format("<spring stiffness='{}' rest='{:.17g}'/>", stiffness, rest), "", parts));
    ASSERT_TRUE(simulation.solve_static(1).converged);
    EXPECT_NEAR(position_of(simulation, "hinge"), kStartAngle, 1e-9);
    const std::vector<Mode> modes = simulation.natural_modes(3);
    ASSERT_EQ(modes.size(), 1u);
    EXPECT_NEAR(2 * kPi * modes[0].frequency, omega, 1e-6 * omega);
    ASSERT_EQ(modes[0].coordinate_motion.size(), 2u);
    EXPECT_NEAR(std::abs(modes[0].coordinate_motion[1] / modes[0].coordinate_motion[0]),
                BoomOnParts::lever(kStartAngle), 1e-6);
    const std::vector<Pole> all = poles(linearise(simulation));
    ASSERT_EQ(all.size(), 1u);
    EXPECT_NEAR(std::abs(all[0].value), omega, 1e-6 * omega);
  }
}

// Oil as a spring: bulk A^2 (1/V1 + 1/V2), between the piston and the place to which the pump has moved it.
TEST(Cylinder, SwingsOnItsOil) {
  const double bulk = 1.4e9, area = 1e-3, first = 2e-4, second = 3e-4, moved = 5, pump = 1e9;
  const double stiffness = bulk * area * area * (1 / first + 1 / second);
  scene::SceneDescription scene = boom_scene(
      kStartAngle,
      fmt::format("<drive stiffness='{}' rotor_inertia='{}'/><servo mode='position' kp='{}'/>", stiffness, moved, pump),
      "");
  scene.gravity.setZero();
  const std::vector<Mode> modes = Simulation(scene).natural_modes(3);
  // The boom, as a mass at the piston, on the oil, and the moved mass of oil between this and the servo.
  const double boom = BoomOnParts().mass(kStartAngle) / std::pow(BoomOnParts::lever(kStartAngle), 2);
  const double sum = stiffness / boom + (stiffness + pump) / moved, product = stiffness * pump / (boom * moved);
  const double root = std::sqrt(sum * sum / 4 - product);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(2 * kPi * modes[0].frequency, std::sqrt(product / (sum / 2 + root)), 1e-6 * std::sqrt(stiffness / boom));
  EXPECT_NEAR(2 * kPi * modes[1].frequency, std::sqrt(sum / 2 + root), 1e-6 * std::sqrt(sum));
  EXPECT_NEAR(2 * kPi * modes[0].frequency, std::sqrt(stiffness / boom), 0.01 * std::sqrt(stiffness / boom));
}

// A commanded flow moves the piston; a limit of the pressure stops it.
TEST(Cylinder, IsMovedByFlow) {
  const double stiffness = 1e7, speed = 0.02, area = 1e-3;
  const auto position_after = [&](double pressure) {
    const std::string limit = pressure > 0 ? fmt::format("effort_limit='{}'", pressure * area) : "";
    Simulation simulation(boom_scene(kStartAngle,
                                     fmt::format("<drive stiffness='{}' rotor_inertia='5' damping='2e4' {}/>"
                                                 "<servo mode='velocity' kp='1e6' ki='1e8' set_point='{}'/>",
                                                 stiffness, limit, speed),
                                     ""));
    run_until(simulation, 2);
    return position_of(simulation, "lift");
  };
  const double start = BoomOnParts::length(kStartAngle);
  // The weight compresses the oil.
  EXPECT_NEAR(position_after(0), start + 2 * speed - BoomOnParts().force(0.3, 0, 0) / stiffness, 2e-4);
  EXPECT_LT(position_after(0.5 * BoomOnParts().force(kStartAngle, 0, 0) / area), start);
}

// The initial rate of one joint determines those of all others.
TEST(Cylinder, StartsWithVelocitiesThatFit) {
  const double lever = BoomOnParts::lever(kStartAngle);
  const Simulation turned(boom_scene(0, "", "<initial joint='hinge' position='0.2' velocity='0.5'/>"));
  EXPECT_NEAR(turned.velocity(*turned.find_coordinate("lift")), 0.5 * lever, 1e-9);
  const Simulation pushed(boom_scene(kStartAngle, "", "<initial joint='lift' velocity='0.1'/>"));
  EXPECT_NEAR(pushed.velocity(*pushed.find_coordinate("hinge")), 0.1 / lever, 1e-9);
  EXPECT_NEAR(position_of(pushed, "lift"), BoomOnParts::length(kStartAngle), 1e-12);
}

// Stops know the inertia that moves behind the cylinder, with and without masses of its own.
TEST(Cylinder, BouncesFromItsStops) {
  for (const BoomParts& parts : {BoomParts{}, kMassive}) {
    const double upper = BoomOnParts::length(kStartAngle) + 0.05;
    scene::SceneDescription scene = boom_scene(kStartAngle, fmt::format("<limit lower='0.1' upper='{}'/>", upper),
                                               "<initial joint='lift' velocity='1'/>", parts);
    scene.gravity.setZero();
    Simulation simulation(scene);
    const std::size_t lift = *simulation.find_coordinate("lift");
    double deepest = 0, before = 0;
    while (simulation.time() < 0.2) {
      if (simulation.position(lift) < upper && simulation.velocity(lift) > 0) before = simulation.velocity(lift);
      ASSERT_TRUE(simulation.step().converged);
      deepest = std::max(deepest, simulation.position(lift) - upper);
    }
    EXPECT_GT(deepest, 0);
    EXPECT_LT(deepest, 0.1 * (upper - 0.1));
    EXPECT_NEAR(-simulation.velocity(lift) / before, 0.3, 0.06);
  }
}

}  // namespace flexarm::test
