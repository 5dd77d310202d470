// Tests tendons in simulations: closed forms, independent solutions (solve_ivp of scipy with tolerances of 1e-12, and
// minimisation of the energy), and conservation.
#include <cmath>

#include "math/pi.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// A body without visible size that flies freely, in the plane or in space.
std::string tied(const std::string& name, double mass, const std::string& at, const std::string& release = "free") {
  return joint(name + "_joint", "floating", "world", name,
               "<origin xyz='" + at + "'/>" + (release == "planar" ? "<axis xyz='0 1 0'/>" : "") + "<release kind='" +
                   release + "'/>") +
         body(name, mass, Vector3::Constant(0.001));
}

/// Errors at a number of steps, each half as long as the one before; the order of convergence from the last two.
template <class Run>
double order_of(const Run& error_of) {
  return std::log2(error_of(1e-3) / error_of(5e-4));
}

const std::string kWeight = gravity({0, 0, -9.81});

// ---------------------------------------------------------------- statics

// A mass on a rope of EA 1000 N and 2 m: it stretches by m g L0 / EA.
TEST(Tendons, CarryAWeight) {
  Simulation s = simulation_of_parts(tied("mass", 5, "0 0 -2.1", "free") +
                                         R"(<tendon name="rope" ea="1000" rest_length="2"> <via link="world"/>
                                      <via link="mass"/> </tendon>)",
                                     kWeight);
  ASSERT_TRUE(s.solve_static(1).converged);
  const double stretch = 5 * 9.81 * 2 / 1000;
  EXPECT_NEAR(column(s, "tendon/rope/tension"), 5 * 9.81, 1e-6);
  EXPECT_NEAR(column(s, "tendon/rope/length"), 2 + stretch, 1e-9);
  EXPECT_NEAR(s.energies().strain, 0.5 * 1000 / 2 * stretch * stretch, 1e-8);
}

/// `law`: attributes of the tendon.
std::string finger(const std::string& law) {
  return joint("hinge1", "continuous", "world", "phalanx1", "<axis xyz='0 0 1'/>") +
         body("phalanx1", 0.03, Vector3::Constant(6e-6), {0.0225, 0, 0}) +
         joint("hinge2", "continuous", "phalanx1", "phalanx2", "<origin xyz='0.045 0 0'/><axis xyz='0 0 1'/>") +
         body("phalanx2", 0.02, Vector3::Constant(2e-6), {0.015, 0, 0}) +
         "<spring joint='hinge1' stiffness='0.04'/> <spring joint='hinge2' stiffness='0.03'/> <tendon name='flexor' " +
         law + R"(> <via link="world" at="-0.02 0.012 0"/> <via link="phalanx1" at="0.012 0.01 0"/>
    <via link="phalanx1" at="0.033 0.01 0"/> <via link="phalanx2" at="0.012 0.009 0"/>
    <via link="phalanx2" at="0.028 0.008 0"/> </tendon>)";
}

// The angles minimise the energy of springs and tendon (scipy, to 1e-14).
TEST(Tendons, BendAFinger) {
  Simulation given = simulation_of_parts(finger(R"(tension="3")"));
  ASSERT_TRUE(given.solve_static(10).converged);
  EXPECT_NEAR(given.position(0), 1.1656039679167243, 1e-9);
  EXPECT_NEAR(given.position(1), 1.4996953348183708, 1e-9);
  EXPECT_NEAR(column(given, "tendon/flexor/length"), 0.05752429550742347, 1e-11);
  Simulation elastic = simulation_of_parts(finger(R"(ea="80" rest_length="0.08511448292457283")"));
  ASSERT_TRUE(elastic.solve_static(10).converged);
  EXPECT_NEAR(column(elastic, "tendon/flexor/length"),
              0.08511448292457283 * (1 + column(elastic, "tendon/flexor/tension") / 80), 1e-12);
}

// A tendon beside a tube bends it to an arc of the angle w. Between its guides the tendon is straight: its n pieces are
// chords of the arc of radius R - d. It is pulled by much more than it can stretch. The tension EI w / (L d) shortens
// the tube and stretches the tendon.
TEST(Tendons, BendATubeToAnArc) {
  constexpr double kLength = 0.25, kDistance = 0.006, kRest = 0.24, kOuter = 0.61e-3, kInner = 0.477e-3;
  const double area = kPi * (kOuter * kOuter - kInner * kInner);
  const double axial = 83e9 * area, bending = 83e9 * area * (kOuter * kOuter + kInner * kInner) / 4;
  for (const int pieces : {11, 55, 56, 99}) {
    double least = 1, most = 3, length = kLength;  // for the angle of the arc, which the pull increases
    while (most - least > 1e-12) {
      const double angle = 0.5 * (least + most), tension = bending * angle / (kLength * kDistance);
      length = kLength * (1 - tension / axial);
      const double guided = (length / angle - kDistance) * 2 * pieces * std::sin(angle / (2 * pieces));
      (guided > kRest * (1 + tension / 1e5) ? least : most) = angle;
    }
    Simulation s = simulation_of_parts(fmt::format(R"xml(
      <joint name="clamp" type="fixed"> <parent link="world"/> <child link="tube"/> </joint>
      <link name="tube"> <beam elements="11" order="2"> <centerline> <line to="0.25 0 0"/> </centerline>
        <tube outer_radius="0.61e-3" inner_radius="0.477e-3"/>
        <material young="83e9" poisson="0.33" density="6450"/> </beam> </link>
      <tendon name="tendon" ea="1e5" rest_length="0.24"> <vias link="tube" from="0 0 0" to="0.25 0 0" count="{}"
        radius="0.006" phase="0"/> </tendon>)xml",
                                                   pieces + 1),
                                       R"(<gravity xyz="0 0 0"/>)");
    ASSERT_TRUE(s.solve_static(10).converged) << pieces;
    const Pose tip = s.tip_pose(1);
    // Left out: between guides the tendon is further from the axis, by (L/n)(w/n)/8, and the tube is bent more there:
    // with 11 pieces by 6 % of its curvature, with 55 by 0.3 %. This enters squared.
    const double off = pieces == 11 ? 1e-4 : 1e-5;
    EXPECT_NEAR(tip.position.x(), length / most * std::sin(most), off) << pieces;
    EXPECT_NEAR(std::hypot(tip.position.y(), tip.position.z()), length / most * (1 - std::cos(most)), off) << pieces;
  }
}

/// A platform in the plane on four cables, whose rest lengths are given.
Simulation cable_robot(const std::vector<double>& rest) {
  std::string cables;
  const std::vector<std::array<double, 4>> ends = {
      {0, 0, -0.25, -0.1}, {3, 0, 0.25, -0.1}, {3, 2, 0.25, 0.1}, {0, 2, -0.25, 0.1}};
  for (std::size_t i = 0; i < 4; ++i)
    cables += fmt::format(R"(<tendon name="cable{}" ea="10000" rest_length="{:.17g}"> <via link="world" at="{} 0 {}"/>
                             <via link="platform" at="{} 0 {}"/> </tendon>)",
                          i + 1, rest[i], ends[i][0], ends[i][1], ends[i][2], ends[i][3]);
  return simulation_of_parts(joint("plane", "floating", "world", "platform",
                                   "<origin xyz='1.5 0 1'/><axis xyz='0 1 0'/><release kind='planar'/>") +
                                 body("platform", 8, Vector3::Constant(0.2)) + cables,
                             kWeight);
}

// Forces of four cables by minimisation of the energy (scipy); in the second pose one of them is slack.
TEST(Tendons, HoldACableRobot) {
  Simulation taut = cable_robot({1.4965425105186323, 1.6737832839801197, 1.531018888175033, 1.3813584766201688});
  ASSERT_TRUE(taut.solve_static(10).converged);
  const std::vector<double> tensions = {156.20686775640993, 60, 238.6366445372864, 166.17670844674421};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(column(taut, fmt::format("tendon/cable{}/tension", i + 1)), tensions[i], 1e-5);
  const std::vector<Mode> modes = taut.natural_modes(3);
  const std::vector<double> frequencies = {5.221559284559201, 6.420755190729508, 7.506099971954388};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(modes.at(i).frequency, frequencies[i], 1e-7);

  Simulation slack = cable_robot({1.5165425105186323, 1.9237832839801197, 1.521018888175033, 1.4113584766201688});
  ASSERT_TRUE(slack.solve_static(10).converged);
  EXPECT_NEAR(column(slack, "tendon/cable1/tension"), 106.04045630761607, 1e-5);
  EXPECT_EQ(column(slack, "tendon/cable2/tension"), 0);
  EXPECT_NEAR(slack.natural_modes(3).at(0).frequency, 2.999917833826744, 1e-7);
}

// ---------------------------------------------------------------- motion

// A pendulum on a rope that is hoisted and lowered, in the plane and in space, against solve_ivp.
TEST(Tendons, HoistAPendulum) {
  struct Case {
    const char *at, *velocity;
    Vector3 end;
  };
  const std::vector<Case> cases = {
      {"1.2011434809983093 0 -2.198678393982359", "0 0 0", {0.2040546350, 0, -2.4995816705}},
      {"1.2012200194653146 0 -2.198818496706451", "0 0.8 0", {0.392146750, -0.137024678, -2.473212645}}};
  for (const Case& tested : cases) {
    const auto at = tested.at, velocity = tested.velocity;
    const Vector3 end = tested.end;
    const auto error = [&](double step) {
      Simulation s = simulation_of_parts(
          tied("mass", 5, at) + R"(<tendon name="rope" ea="20000" rest_length="2+0.5*cos(_pi*t/4) "> <via link="world"/>
                                   <via link="mass"/> </tendon>)",
          kWeight + fmt::format(R"(<initial link="mass" linear="{}" angular="0 0 0"/>
                                    <probe name="mass" link="mass"/>)",
                                velocity),
          step);
      const double start = energy_account(s);
      run_until(s, 8);
      EXPECT_NEAR(energy_account(s), start, 1e-11 * 8 / step);  // round-off of 100 J
      return (s.probe_pose(0).position - end).norm();
    };
    EXPECT_LT(error(5e-4), 1e-5);
    EXPECT_NEAR(order_of(error), 2, 0.1);
  }
}

// A winch with the same motion gives the same rope.
TEST(Tendons, AreWoundUpByAWinch) {
  const std::string mass = tied("mass", 5, "1.2011434809983093 0 -2.198678393982359");
  const std::string vias = R"(<via link="world"/> <via link="mass"/> </tendon>)";
  const std::string options = kWeight + R"(<probe name="mass" link="mass"/>)";
  Simulation given = simulation_of_parts(
      mass + R"(<tendon name="rope" ea="20000" rest_length="2+0.5*cos(_pi*t/4) ">)" + vias, options);
  Simulation wound = simulation_of_parts(
      mass + R"(<tendon name="rope" ea="20000" rest_length="2.5">)" + vias + R"(<winch name="hoist" tendon="rope"/>)",
      options + R"(<motion joint="hoist" position="-0.5+0.5*cos(_pi*t/4) "/>)");
  const double start = energy_account(wound);
  run_until(given, 2), run_until(wound, 2);
  EXPECT_LT((given.probe_pose(0).position - wound.probe_pose(0).position).norm(), 1e-9);
  EXPECT_NEAR(column(wound, "joint/hoist/position"), -0.5, 1e-12);
  // The force on what is paid out is T (1 + T / (2 EA)), against it.
  const double tension = column(wound, "tendon/rope/tension");
  EXPECT_NEAR(column(wound, "joint/hoist/effort"), -tension * (1 + tension / 40000), 2e-2 * tension);
  EXPECT_NEAR(energy_account(wound), start, 1e-9);
}

// Atwood's machine with a rope that does not slip on a pulley with inertia: a = (m1 - m2) g / (m1 + m2 + I / r^2). The
// elastic rope vibrates about it; the start has the tensions of that motion. Without friction I does not count.
TEST(Tendons, RunOverPulleys) {
  for (const bool grips : {true, false}) {
    const double added = grips ? 0.03 / (0.15 * 0.15) : 0, acceleration = (3.0 - 2.0) * 9.81 / (5 + added);
    const double first = 3 * (9.81 - acceleration), second = 2 * (9.81 + acceleration), ea = 1e6;
    // Where the rope is stretched as in that motion: the part with the first mass has the length 1, the other one 2.
    const double length = grips ? 1 / (1 + first / ea) + 2 / (1 + second / ea) : (3 + 0.15 * kPi) / (1 + first / ea);
    const double z1 = -1, z2 = grips ? -(length / 3 * 2) * (1 + second / ea) : -2;
    const double z_first = grips ? -(length / 3) * (1 + first / ea) : z1;
    Simulation s = simulation_of_parts(
        tied("a", 3, fmt::format("-0.15 0 {:.17g}", z_first)) + tied("b", 2, fmt::format("0.15 0 {:.17g}", z2)) +
            joint("axle", "continuous", "world", "drum", "<axis xyz='0 1 0'/>") +
            body("drum", 1, Vector3::Constant(0.03)) +
            fmt::format(R"(<tendon name="rope" ea="{}" rest_length="{:.17g}"> <via link="a"/> <pulley link="drum"
                             axis="0 1 0" radius="0.15" side="left" grips="{}"/> <via link="b"/> </tendon>)",
                        ea, length, grips),
        kWeight + R"(<probe name="a" link="a"/>)");
    const double start = energy_account(s);
    run_until(s, 0.5);
    const double way = z_first - s.probe_pose(0).position.z();
    EXPECT_NEAR(way, 0.5 * acceleration * 0.25, 2e-4) << grips;  // stretches change by 1e-4 on the way
    EXPECT_NEAR(energy_account(s), start, 1e-9) << grips;
    if (grips) {
      EXPECT_NEAR(s.position(12), -way / 0.15, 1e-3);
    } else {
      EXPECT_NEAR(s.position(12), 0, 1e-12);
    }
  }
}

// A mass flies round the anchor of a long rope, and round a pulley beside the anchor. Where the rope sweeps over the
// pulley from its side it is wound up, where it comes from the other side it passes. Its length never jumps.
TEST(Tendons, DoNotJumpRoundPulleys) {
  for (const char* const side : {"left", "right"}) {
    Simulation s =
        simulation_of_parts(tied("mass", 1, "-1 0 2") + fmt::format(R"(<tendon name="rope" ea="1e4" rest_length="60">
                                                      <via link="world" at="-1 0 0"/>
                                                      <pulley link="world" axis="0 1 0" radius="0.1" side="{}" wrap="0"/>
                                                      <via link="mass"/> </tendon>
                                                    <tendon name="orbit" tension="12.5"> <via link="world" at="-1 0 0"/>
                                                      <via link="mass"/> </tendon>)",
                                                                    side),
                            R"(<gravity xyz="0 0 0"/> <initial link="mass" linear="5 0 0" angular="0 0 0"/>)");
    double last = column(s, "tendon/rope/length");
    run(s, 8000, [&] {  // three turns of 2.5 s
      const double length = column(s, "tendon/rope/length");
      ASSERT_LT(std::abs(length - last), 2 * 5 * 1e-3) << side;  // 5 m/s, and rims are passed no faster
      last = length;
    });
  }
}

// Two guides at one point: the piece between them pulls at nothing. Two on one body: their distance does not matter.
// A peg below the pivot catches the line of a pendulum, and lets it go, ten times. Each time the energy changes by the
// third power of the angle of a step, up to 0.01 rad, which the account has.
TEST(Tendons, AreCaughtByAPeg) {
  Simulation s = simulation_of_parts(tied("bob", 1, "-0.6 0 -0.8", "planar") +
                                         R"(<tendon name="line" ea="500"> <via link="world"/> <pulley link="world"
                                        at="0.02 0 -0.5" axis="0 1 0" radius="0.02" side="right" wrap="0"/>
                                      <via link="bob"/> </tendon>)",
                                     kWeight);
  const double start = energy_account(s);
  run_until(s, 8);
  EXPECT_NEAR(energy_account(s), start, 1e-8);
  EXPECT_LT(std::abs(s.energies().dissipated), 10 * 1e-6 * 9.81);
}

TEST(Tendons, MayHaveCoincidingGuides) {
  for (const char* const between :
       {R"(<via link="world" at="1 0 0"/> <via link="b"/>)", R"(<via link="b"/> <via link="b"/>)"}) {
    Simulation s =
        simulation_of_parts(tied("a", 1, "0 0 0") + tied("b", 1, "1 0 0") +
                                fmt::format(R"(<tendon name="rope" ea="1e3" rest_length="1.2"> <via link="a"/> {}
                                                    <via link="world" at="2 0 0"/> </tendon>)",
                                            between),
                            kWeight);
    const double start = energy_account(s);
    run(s, 500);
    // Round-off of positions over the smallest length, 1e-8 m, changes directions by 2e-8: that times the work of 30 N
    // on a way of up to 100 m.
    EXPECT_NEAR(energy_account(s), start, 1e-4);
  }
}

// A line of which nothing is left stops the run.
TEST(Tendons, CannotBeWoundUpWhole) {
  Simulation s = simulation_of_parts(tied("mass", 1, "0 0 -1") + R"(<tendon name="rope" ea="1e3" rest_length="1-t ">
                                 <via link="world"/> <via link="mass"/> </tendon>)");
  bool converged = true;
  while (converged && s.time() < 2) converged = s.step().converged;
  EXPECT_FALSE(converged);
  EXPECT_LT(s.time(), 1);
}

/// Two masses on a rope with friction over a fixed pulley that it touches along half a turn.
Simulation brake(double first, double second) {
  const auto mass = [](const std::string& name, double mass, double x) {
    return joint(name + "_rail", "prismatic", "world", name,
                 fmt::format("<origin xyz='{} 0 -1'/><axis xyz='0 0 1'/>", x) + kFarLimits) +
           body(name, mass);
  };
  return simulation_of_parts(mass("a", first, -0.1) + mass("b", second, 0.1) +
                                 R"(<tendon name="rope" ea="1e5" damping="300"> <via link="a"/>
                              <pulley link="world" axis="0 1 0" radius="0.1" side="left" friction="0.25"/>
                              <via link="b"/> </tendon>)",
                             kWeight);
}

// The line slips where the ratio of tensions is E = exp(mu pi): m1 (g - a) = E m2 (g + a). It sticks at a smaller ratio
// of masses. The rope is so stiff (strains of 5e-4) and damped that its vibration is gone after 0.2 s.
TEST(Tendons, SlipOverABrake) {
  Simulation slips = brake(6, 2);
  const double start = energy_account(slips), ratio = std::exp(0.25 * kPi);
  run_until(slips, 0.2);
  const double speed = slips.velocity(0);
  run_until(slips, 0.5);
  const double acceleration = 9.81 * (6 - ratio * 2) / (6 + ratio * 2);
  EXPECT_NEAR((speed - slips.velocity(0)) / 0.3, acceleration, 1e-2 * acceleration);
  const double tension = column(slips, "tendon/rope/tension");
  EXPECT_NEAR(tension, 6 * (9.81 - acceleration), 1e-2 * tension);
  // The rate of slipping is known as its mean over the last step, so the damper's part lags by half a step.
  const double last = tension / ratio, lag = 300 * acceleration * 0.5e-3;
  EXPECT_NEAR(tension / column(slips, "tendon/rope/last_tension"), ratio, 2 * ratio * lag * (1 / tension + 1 / last));
  EXPECT_NEAR(energy_account(slips), start, 1e-10);
  EXPECT_NEAR(slips.energies().dissipated, (tension - tension / ratio) * -slips.position(0),
              0.05 * slips.energies().dissipated);
  Simulation sticks = brake(4, 2);
  run_until(sticks, 0.5);
  EXPECT_NEAR(sticks.velocity(0), 0, 1e-3);
  EXPECT_NEAR(sticks.position(0), 0, 4 * 9.81 / 1e5 * 2);  // its stretch
  EXPECT_NEAR(column(sticks, "tendon/rope/tension"), 4 * 9.81, 1e-2);
  EXPECT_NEAR(column(sticks, "tendon/rope/last_tension"), 2 * 9.81, 1e-2);
}

// A line that stays taut: order 4 with em4.
TEST(Tendons, HaveTheOrderOfTheScheme) {
  const auto end = [](double step) {
    Simulation s = simulation_of_parts(
        tied("mass", 5, "1.2 0 -2.2") + R"(<tendon name="rope" ea="2000" rest_length="2+0.5*cos(_pi*t/4) ">
                                           <via link="world"/> <via link="mass"/> </tendon>)",
        kWeight + R"(<probe name="mass" link="mass"/>)", step, "em4");
    run_until(s, 2);
    return Vector3(s.probe_pose(0).position);
  };
  const Vector3 coarse = end(0.02), middle = end(0.01), fine = end(0.005);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 4, 0.2);
}

// A mass falls 2 m on a slack rope, is caught and flies again: largest stretch and period in closed form.
TEST(Tendons, CatchAFall) {
  Simulation s = simulation_of_parts(tied("mass", 10, "0 0 -1") + R"(<tendon name="rope" ea="20000" rest_length="3">
                                 <via link="world"/> <via link="mass"/> </tendon>)",
                                     kWeight + R"(<probe name="mass" link="mass"/>)");
  const double start = energy_account(s);
  double longest = 0, least = 1e9;
  // Velocities follow from differences of positions: their round-off is epsilon |r| / step in each of n steps, so that
  // the energy's is that times m v sqrt(n), of which three times are not exceeded.
  const double round_off = 3 * 2.2e-16 * 3 / 1e-3 * 10 * 7 * 100;
  run(s, 10000, [&] {
    longest = std::max(longest, column(s, "tendon/rope/length"));
    least = std::min(least, column(s, "tendon/rope/tension"));
    ASSERT_NEAR(energy_account(s), start, round_off);
  });
  EXPECT_EQ(least, 0);
  // The catch lasts 126 steps: the length at its lowest point is found to (step v)^2 / ... of second order.
  EXPECT_NEAR(longest - 3, 0.25777164200963526, 2e-4);
}

// Two bodies that fly, tied by a rope through a ring on a third one: slack and taut in turns.
TEST(Tendons, KeepMomentaAndEnergy) {
  const std::string parts = tied("a", 1, "0 0 0") + tied("b", 2, "1 0.2 0.1") + tied("c", 1.5, "0.4 0.8 -0.3") +
                            R"(<tendon name="rope" ea="500" rest_length="2.1"> <via link="a" at="0.05 0.02 0"/>
                               <via link="b" at="-0.1 0.05 0.03"/> <via link="c" at="0 -0.1 0.02"/> </tendon>)";
  const std::string options = R"(<initial link="a" linear="-1 0.3 0.2" angular="1 -2 0.5"/>
                                 <initial link="b" linear="0.8 -0.2 0.1" angular="-0.5 1 2"/>
                                 <initial link="c" linear="-0.2 0.9 -0.4" angular="0.3 0.4 -1"/>)";
  for (const double step : {1e-3, 1e-2}) {
    Simulation s = simulation_of_parts(parts, options + R"(<gravity xyz="0 0 0"/>)", step);
    const double start = energy_account(s);
    const Vector3 momentum = s.momentum(), angular = s.angular_momentum();
    int slack = 0;
    run(s, 10000, [&] { slack += column(s, "tendon/rope/tension") == 0 ? 1 : 0; });
    EXPECT_GT(slack, 100);
    EXPECT_LT(slack, 9900);
    // Velocities follow from differences of positions r: epsilon |r| / step in each of n steps, times m sqrt(n), of
    // which three times are not exceeded. Positions grow with the time.
    const double round_off = 3 * 2.2e-16 * (10000 * step) / step * 2 * 100;
    EXPECT_NEAR(energy_account(s), start, round_off);
    EXPECT_LT((s.momentum() - momentum).norm(), round_off);
    EXPECT_LT((s.angular_momentum() - angular).norm(), 10000 * step * round_off);
  }
}

}  // namespace
}  // namespace flexarm::test
