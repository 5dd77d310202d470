// Tests bodies and beams in contact against closed forms.
#include <array>

#include "math/pi.h"
#include "reference/contact_scenes.h"
#include "support/refusal.h"

namespace flexarm::test::touching {
namespace {

// ---------------------------------------------------------------- friction

Simulation block_on_incline(double slope, double friction) {
  return simulation_of(box("block", 3, {0.2, 0.15, 0.1}) + floating("block") + kFloor +
                           contact_of("block", "floor", fmt::format("friction='{}'", friction)),
                       start("block", {0, 0, 0.05}, {0, 0, 0}), 2e-3, {kG * std::sin(slope), 0, -kG * std::cos(slope)});
}

TEST(Contact, BlockOnAnInclineSticksBelowTheAngleOfFriction) {
  Simulation simulation = block_on_incline(0.46, 0.5);
  run_until(simulation, 2);
  const Vector3 place = simulation.link_pose(1).position;
  run_until(simulation, 12);
  EXPECT_LE((simulation.link_pose(1).position - place).norm(), 1e-15);
}

TEST(Contact, BlockOnAnInclineSlidesAboveTheAngleOfFriction) {
  const double slope = 0.6, friction = 0.4;
  Simulation simulation = block_on_incline(slope, friction);
  run_until(simulation, 1);
  const double begin = simulation.momentum().x() / 3;
  run_until(simulation, 2);
  // Tolerance: Newton's tolerance of 1e-8 m in each step, over the step of 2e-3 s, in 500 steps.
  EXPECT_NEAR(simulation.momentum().x() / 3 - begin, kG * (std::sin(slope) - friction * std::cos(slope)), 1e-6);
  EXPECT_NEAR(energy_account(simulation), energy_account(block_on_incline(slope, friction)), 1e-8);
}

// Sticking friction gives the force that rolling needs. Rolling is exact in a step, up to the error of Newton's method.
TEST(Contact, BallRollsWithoutSlip) {
  const double slope = 0.4;
  Simulation simulation =
      simulation_of(ball("ball", 1, 0.1) + floating("ball") + kFloor + contact_of("ball", "floor", "friction='0.5'"),
                    start("ball", {0, 0, 0.1}, {0, 0, 0}), 1e-3, {kG * std::sin(slope), 0, -kG * std::cos(slope)});
  run_until(simulation, 0.5);
  const double begin = simulation.momentum().x();
  run_until(simulation, 1);
  EXPECT_NEAR((simulation.momentum().x() - begin) / 0.5, 5.0 / 7 * kG * std::sin(slope), 1e-9);
}

// The couple s m g brakes the ball to rest. The remainder of the first bounce is below 1e-6 of the weight by then.
TEST(Contact, BallThatSpinsIsBrakedAndStands) {
  constexpr double kRadius = 0.1, kSpinning = 2e-3, kRate = 4, kPolar = 0.4 * kRadius * kRadius;
  Simulation simulation =
      simulation_of(kFloor + ball("ball", 1, kRadius) + floating("ball") + contact_of("*", "*", "spinning='2e-3'"),
                    start("ball", {0, 0, kRadius}, {0, 0, 0}, {0, 0, kRate}), 1e-3);
  const auto rate = [&] { return simulation.angular_momentum().z() / kPolar; };
  run_until(simulation, 0.4);
  const double first = rate(), total = energy_account(simulation);
  run_until(simulation, 0.7);
  EXPECT_NEAR((first - rate()) / 0.3, kSpinning * kG / kPolar, 1e-6 * kSpinning * kG / kPolar);
  run_until(simulation, 2);
  EXPECT_NEAR(rate(), 0, 1e-9);
  EXPECT_NEAR(energy_account(simulation), total, 1e-12);
}

// A couple of r N acts against rolling: x'' = (g sin - r g cos / R) / 1.4 down a slope, or rest if this is negative.
TEST(Contact, RollingMayBeResistedTo) {
  constexpr double kRadius = 0.1, kRolling = 5e-3;
  const auto roll = [&](double slope) {
    Simulation simulation = simulation_of(
        kFloor + ball("ball", 1, kRadius) + floating("ball") + contact_of("*", "*", "friction='0.5' rolling='5e-3'"),
        start("ball", {0, 0, kRadius}, {0, 0, 0}), 1e-3, kG * Vector3(std::sin(slope), 0, -std::cos(slope)));
    run_until(simulation, 1);
    const double first = simulation.momentum().x();
    run_until(simulation, 2);
    const double gained = simulation.momentum().x() - first;
    run_until(simulation, 4);
    return std::array<double, 2>{gained, simulation.momentum().x()};
  };
  const double limit = std::atan(kRolling / kRadius);
  EXPECT_NEAR(roll(0.99 * limit)[1], 0, 1e-9) << "after it has rung";
  const double steep = 2 * limit, expected = kG * (std::sin(steep) - kRolling / kRadius * std::cos(steep)) / 1.4;
  EXPECT_NEAR(roll(steep)[0], expected, 1e-6 * expected);
}

// ---------------------------------------------------------------- several contacts, beams

// Crossed bars have no corner inside of each other. On parallel bars, all corners are on edges of the other bar.
TEST(Contact, BoxesRestOnEachOther) {
  const std::string contact = kFloor + contact_of("*", "*", "friction='0.5'");
  const Vector3 along(0.4, 0.06, 0.05), across(0.06, 0.4, 0.05);
  for (const Vector3& upper : {along, across}) {
    Simulation simulation =
        simulation_of(contact + box("low", 1, along) + box("high", 1, upper) + floating("low") + floating("high"),
                      start("low", {0, 0, 0.025}, {0, 0, 0}) + start("high", {0, 0, 0.075}, {0, 0, 0}), 2e-3);
    run_until(simulation, 4);
    const Vector3 place = simulation.link_pose(2).position;
    EXPECT_NEAR(place.z(), 0.075, 2.5e-3) << "half of what they give way at most";
    run_until(simulation, 6);
    EXPECT_LE((simulation.link_pose(2).position - place).norm(), 1e-9);
    EXPECT_LE(simulation.momentum().norm(), 1e-9);
  }
}

// Corners and balls of fixed bodies act, too. A floating body is no neighbour of the world, so it touches fixed bodies.
TEST(Contact, PlateRestsOnFixedPostsAndBalls) {
  std::string parts = box("plate", 1, {0.6, 0.6, 0.04}) + floating("plate") + contact_of("*", "*", "friction='0.5'");
  parts += fixed("post1", "<box size='0.05 0.05 0.1'/>", "<origin xyz='0.2 0.2 0'/>") +
           fixed("post2", "<box size='0.05 0.05 0.1'/>", "<origin xyz='-0.2 0.2 0'/>") +
           fixed("ball", "<sphere radius='0.05'/>", "<origin xyz='0 -0.2 0'/>");
  Simulation simulation = simulation_of(parts, start("plate", {0, 0, 0.071}, {0, 0, 0}), 1e-3);
  run_until(simulation, 3);
  EXPECT_NEAR(simulation.link_pose(1).position.z(), 0.07, 2e-3) << "what it gives way at most";
  EXPECT_LE(simulation.momentum().norm(), 1e-6);
}

TEST(Contact, EqualBoxesThatStartALittleInsideRest) {
  const Vector3 size(0.2, 0.2, 0.1);
  Simulation simulation =
      simulation_of(kFloor + box("low", 1, size) + box("high", 1, size) + floating("low") + floating("high") +
                        contact_of("*", "*", "friction='0.5'"),
                    start("low", {0, 0, 0.05}, {0, 0, 0}) + start("high", {0, 0, 0.15 - 1e-6}, {0, 0, 0}), 1e-3);
  run_until(simulation, 3);
  EXPECT_NEAR(simulation.link_pose(2).position.z(), 0.15, 5e-3) << "what they give way at most";
}

// An initial penetration p decays as p e^(-w t / 100), with w = pi / 10 per step. The first push is a hit with the
// speed p w / 100, of which at most the factor (1 + e) is given back. The weight makes the body lag behind by g / w^2,
// as at rest. The lag is twice as large if half of the points, which share the stiffness, carry nothing, e.g. boxes
// whose upper corners do not touch.
TEST(Contact, WhatStartsInsideIsLetOutLittleByLittle) {
  const double h = 1e-3, frequency = kPi / (10 * h), inside = 0.05, sag = 2 * kG / (frequency * frequency);
  const double restitution = 0.3, rate = inside * frequency / 100;
  const Vector3 size(0.1, 0.1, 0.1);
  const std::string contact = contact_of("*", "*", "friction='0.5'");
  const struct {
    std::string parts, starts;
    std::size_t link;
    double rest;
  } scenes[] = {
      {box("cube", 1, size) + floating("cube"), start("cube", {0, 0, 0}, {0, 0, 0}), 1, 0.05},
      {ball("ball", 1, 0.05) + floating("ball"), start("ball", {0, 0, 0}, {0, 0, 0}), 1, 0.05},
      {box("low", 1e3, size) + box("high", 1, size) + floating("low") + floating("high"),
       start("low", {0, 0, 0.05}, {0, 0, 0}) + start("high", {0, 0, 0.1}, {0, 0, 0}), 2, 0.15},
  };
  for (const auto& [parts, starts, link, rest] : scenes) {
    Simulation simulation = simulation_of(kFloor + parts + contact, starts, h);
    ASSERT_EQ(simulation.start_warnings().size(), 1u);
    EXPECT_NE(simulation.start_warnings()[0].text().find("they penetrate each other at the start"), std::string::npos);
    const double total = energy_account(simulation);
    double fastest = 0;
    while (simulation.time() < 1) {
      const double before = simulation.link_pose(link).position.z();
      ASSERT_TRUE(simulation.step().converged);
      fastest = std::max(fastest, (simulation.link_pose(link).position.z() - before) / h);
      const double left = inside * std::exp(-frequency * simulation.time() / 100);
      if (simulation.time() > 0.1) {
        EXPECT_NEAR(simulation.link_pose(link).position.z(), rest - left, 1.05 * sag) << link;
      }
    }
    EXPECT_LE(fastest, (1 + restitution) * rate) << link;
    run_until(simulation, 6);
    EXPECT_NEAR(simulation.link_pose(link).position.z(), rest, 1.05 * sag);
    EXPECT_LE(simulation.momentum().norm(), 1e-6);
    EXPECT_NEAR(energy_account(simulation), total, 1e-9) << "letting out is work from outside";
    EXPECT_GT(simulation.energies().work, 0.9 * kG * inside) << "by which it is lifted";
  }
}

// Schemes with forces at the ends of steps, and those with backward steps, do not support contact.
TEST(Contact, SchemesThatHaveNoneAreRefused) {
  const scene::SceneDescription scene = scene_at("config/examples/gripper.urdf");
  for (const std::string scheme : {"newmark", "hht1", "hht2", "hht3", "em4"})
    expect_contains(refusal_of(scene, options(scheme)), "scheme '" + scheme + "' has no <contact>");
}

TEST(Contact, PairsThatCannotTouchAreRefused) {
  const std::string mesh = fixed("mesh", "<mesh filename='file:///none.stl'/>"),
                    post = fixed("post", "<box size='1 1 1'/>");
  const std::string moving = ball("ball", 1, 0.1) + floating("ball") + kFloor;
  EXPECT_THROW(simulation_of(moving + mesh + contact_of("mesh", "floor"), "", 1e-3), std::runtime_error);
  EXPECT_THROW(simulation_of(moving + post + contact_of("post", "floor"), "", 1e-3), std::runtime_error);
}

// Smooth lines of beams have no resistance to rotation. A contact that names such a beam and asks for this resistance
// is an error. A contact of all pairs ignores it for beams.
TEST(Contact, LinesResistToNoTurns) {
  std::string parts;
  for (const std::string name : {"one", "two"})
    parts +=
        round_beam(name, "<line to='1 0 0'/>", 0.01, "<material young='7e10' poisson='0.3' density='2700'/>", 2, 1) +
        floating(name);
  const std::string start = "<initial joint='of_two/z' position='1'/>";
  EXPECT_THROW(simulation_of(parts + contact_of("one", "two", "spinning='0.01'"), start, 1e-3), std::runtime_error);
  EXPECT_NO_THROW(simulation_of(parts + contact_of("*", "*", "spinning='0.01'"), start, 1e-3));
}

// The weight of a cantilever presses it on the floor. Without the floor, its tip would be 0.117 m lower.
TEST(Contact, CantileverRestsOnTheFloorInStatics) {
  Simulation simulation = simulation_of(
      round_beam("arm", "<line to='1 0 0'/>", 0.004, "<material young='7e9' poisson='0.3' density='2700'/>", 10) +
          joint("clamp", "fixed", "world", "arm") + "<ground name='low' offset='-0.05'/>" +
          contact_of("arm", "low", "stiffness='1e6'"),
      "", 1e-3);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  EXPECT_NEAR(simulation.tip_pose(1).position.z(), -0.046, 4e-4) << "a radius above the floor, less its depth";
  const Vector3 at_rest = simulation.tip_pose(1).position;
  run_until(simulation, 0.2);
  EXPECT_NEAR(simulation.tip_pose(1).position.z(), at_rest.z(), 1e-12) << "it stays";
}

TEST(Contact, StackOfBoxesRests) {
  const Vector3 size(0.2, 0.2, 0.1);
  std::string parts = kFloor + contact_of("*", "*", "friction='0.5'"), starts;
  for (int i = 0; i < 3; ++i) {
    const std::string name = fmt::format("box{}", i);
    parts += box(name, 1, size) + floating(name);
    starts += start(name, {0.01 * i, 0, 0.051 + 0.101 * i}, {0, 0, 0});
  }
  Simulation simulation = simulation_of(parts, starts, 2e-3);
  run_until(simulation, 6);
  EXPECT_LE(simulation.momentum().norm(), 1e-9);
  // The load on a face is eccentric by e = 10, 10 and 5 mm. The box sinks by p = load / stiffness and leans by p e /
  // r^2, where r^2 is the mean square of the points' distances: a^2/4 on the floor (24.7 kN/m), a^2/6 between boxes
  // (12.3 kN/m). This gives 1.2, 2.4 and 0.6 mrad with the stiffness of shallow contacts. The contacts harden, so that
  // the boxes lean less.
  const double leans[] = {6e-5, 3e-4, 7e-4};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(simulation.link_pose(1 + i).position.z(), 0.05 + 0.1 * i, 5e-3) << "what they give way at most";
    EXPECT_GT(simulation.link_pose(1 + i).position.x(), 0.01 * i) << i;
    EXPECT_LT(simulation.link_pose(1 + i).position.x(), 0.01 * i + leans[i]) << i;
  }
  const Vector3 top = simulation.link_pose(3).position;
  run_until(simulation, 8);
  EXPECT_LE((simulation.link_pose(3).position - top).norm(), 1e-9);
}

// A gripper lifts a block and swings it around. The block does not creep in the grip.
TEST(Contact, GraspedBlockIsLiftedAndDoesNotCreep) {
  Simulation simulation(scene_at("config/examples/gripper.urdf"));
  const std::size_t palm = 2, block = 5;
  ASSERT_EQ(simulation.link_names()[palm], "palm");
  ASSERT_EQ(simulation.link_names()[block], "block");
  const auto held = [&] { return simulation.link_pose(palm).inverse() * simulation.link_pose(block); };
  run_until(simulation, 4);
  const Pose at_rest = held();
  EXPECT_NEAR(simulation.link_pose(block).position.z(), 0.24, 0.01) << "it has been lifted by 0.2 m";
  run_until(simulation, 10);
  EXPECT_LE((held().position - at_rest.position).norm(), 1e-9);
}

// A beam falls on the floor and bounces. Its total energy stays the same, however it vibrates.
TEST(Contact, BeamThatBouncesKeepsItsEnergy) {
  Simulation simulation = simulation_of(
      round_beam("rod", "<line to='1 0 0'/>", 0.01, "<material young='5e9' poisson='0.3' density='2000'/>", 6) +
          floating("rod") + kFloor + contact_of("rod", "floor", "restitution='1' stiffness='1e5'"),
      start("rod", {0, 0, 0.25}, {0, 0, 0}) + "<initial joint='of_rod/ry' position='0.2'/>", 1e-3);
  ASSERT_LT(simulation.energies().strain, 1e-20) << "it starts outside";
  const double begin = simulation.energies().total();
  bool has_touched = false;
  for (int i = 0; i < 800; ++i) {
    ASSERT_TRUE(simulation.step().converged);
    has_touched = has_touched || simulation.tip_pose(1).position.z() < 0.011;
    ASSERT_NEAR(simulation.energies().total(), begin, 1e-9 * std::abs(begin));
  }
  EXPECT_TRUE(has_touched);
}

}  // namespace
}  // namespace flexarm::test::touching
