// Tests rigid bodies in contact against closed forms and solvers of ordinary differential equations.
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/pi.h"
#include "reference/contact_scenes.h"
#include "reference/ode.h"

namespace flexarm::test::touching {
namespace {

/// Force of an elastic contact at a penetration p: k x dx/dp with x = p / (1 - (p/d)^2)^2, zero outside
/// (docs/notes/stops.md 2). [N]
double push(double stiffness, double depth, double penetration) {
  if (penetration <= 0) return 0;
  const double s = penetration / depth, room = 1 - s * s;
  return stiffness * penetration * (1 + 3 * s * s) / std::pow(room, 5);
}

// ---------------------------------------------------------------- bodies that stay in contact

/// Largest error of the angle of an arm on a hinge at some height, with a ball at the end of a weightless rod. The ball
/// lies on the floor, pressed by its weight, and swings without leaving the floor.
double error_of_pressed_arm(double step) {
  constexpr double kMass = 1, kBall = 0.05, kArm = 0.5, kHeight = 0.06, kStiffness = 6e3, kInside = 1e-3, kUntil = 1;
  const double start = std::asin((kHeight - kBall + kInside) / kArm), inertia = 0.4 * kMass * kBall * kBall;
  Simulation simulation = simulation_of(
      joint("hinge", "continuous", "world", "arm", fmt::format("<origin xyz='0 0 {}'/><axis xyz='0 1 0'/>", kHeight)) +
          body("arm", kMass, Vector3::Constant(inertia), {kArm, 0, 0},
               collision(fmt::format("<sphere radius='{}'/>", kBall), {kArm, 0, 0})) +
          kFloor + contact_of("arm", "floor", fmt::format("restitution='1' stiffness='{}'", kStiffness)),
      fmt::format("<initial joint='hinge' position='{:.17g}'/>", start), step);
  const double depth = 0.1 * kBall;  // the initial penetration is less than a quarter of this
  const OdeFunction swing = [&](double, const Eigen::VectorXd& y) {
    const double lever = kArm * std::cos(y[0]), inside = kBall - kHeight + kArm * std::sin(y[0]);
    return Eigen::Vector2d(y[1],
                           lever * (kMass * kG - push(kStiffness, depth, inside)) / (inertia + kMass * kArm * kArm));
  };
  Eigen::VectorXd expected = Eigen::Vector2d(start, 0);
  double error = 0;
  for (int i = 1; i <= 50; ++i) {
    run_until(simulation, kUntil * i / 50);
    expected = solve_ode(swing, kUntil * (i - 1) / 50, kUntil * i / 50, expected);
    EXPECT_GT(kBall - kHeight + kArm * std::sin(expected[0]), 0) << "it stays in contact";
    error = std::max(error, std::abs(simulation.position(0) - expected[0]));
  }
  return error;
}

TEST(ContactOfBodies, WhatStaysInContactHasOrderTwo) {
  const double coarse = error_of_pressed_arm(1e-3), fine = error_of_pressed_arm(5e-4);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(observed_order(coarse, fine), 2, 0.05);
}

// Three spheres of radius 0 are points: 1 kg stands on them, with a third of its weight each.
TEST(ContactOfBodies, BodyStandsOnPoints) {
  std::string feet;
  for (const Vector3& foot : {Vector3(0.1, 0.1, 0), Vector3(-0.1, 0.1, 0), Vector3(0, -0.2, 0)})
    feet += collision("<sphere radius=\"0\"/>", foot);
  Simulation simulation =
      simulation_of(body("table", 1, Vector3::Constant(0.1), Vector3::Zero(), feet) + floating("table") + kFloor +
                        contact_of("table", "floor", "friction='0.5' stiffness='1e4'"),
                    start("table", {0, 0, 0.02}, {0.1, 0, 0}), 1e-3);
  run(simulation, 3000);
  const Pose pose = simulation.link_pose(1);
  EXPECT_NEAR(pose.position.z(), -kG / 3 / 1e4, 2e-6);  // the law hardens by 8 (p / depth)^2 = 8 (0.33 mm / 16 mm)^2
  EXPECT_NEAR(pose.orientation.angularDistance(Quaternion::Identity()), 0, 1e-9);
  EXPECT_LT(simulation.momentum().norm(), 1e-9);
}

// A cylinder of a micrometre at the end of a heavy body is a point. With its own size as the depth of the contact, its
// hits would be shorter than what numbers of metres resolve.
TEST(ContactOfBodies, TinyShapeOnAHeavyBodyKeepsTheAccount) {
  for (const char* shape : {"<cylinder radius='1e-6' length='1e-6'/>", "<sphere radius='1e-6'/>"}) {
    Simulation simulation =
        simulation_of(body("body", 70, {6, 30, 35}, Vector3::Zero(), collision(shape, {-0.4, 0, -0.16})) +
                          floating("body") + kFloor + contact_of("body", "floor", "friction='0.6'"),
                      start("body", {0, 0, 0.18}, Vector3::Zero()), 1e-3);
    const double begin = energy_account(simulation);
    run_until(simulation, 0.5);
    EXPECT_NEAR(energy_account(simulation), begin, 1e-10 * begin) << shape;
    EXPECT_GT(simulation.link_pose(1).position.z(), -1) << "it turns about the point: " << shape;
  }
}

// A ball lies in a wedge, whose walls push with m g / (2 cos a) each.
TEST(ContactOfBodies, BallComesToRestInAWedge) {
  constexpr double kMass = 1, kRadius = 0.05, kStiffness = 1e5, kSlope = 0.6;
  const double sine = std::sin(kSlope), cosine = std::cos(kSlope), each = kMass * kG / (2 * cosine);
  std::string parts = ball("ball", kMass, kRadius) + floating("ball");
  for (const double side : {-1.0, 1.0})
    parts += fmt::format(
        "<ground name='wall{0}' normal='{1:.17g} 0 {2:.17g}'/><contact first='ball' second='wall{0}' "
        "stiffness='{3}'/>",
        side < 0 ? "l" : "r", side * sine, cosine, kStiffness);
  Simulation simulation = simulation_of(parts, start("ball", {0.003, 0.01, kRadius / cosine + 0.02}, {0, 0, 0}), 1e-3);
  run_until(simulation, 6);
  double inside = each / kStiffness;
  for (int i = 0; i < 20; ++i) inside *= each / push(kStiffness, 0.1 * kRadius, inside);
  const Vector3 place = simulation.link_pose(1).position;
  EXPECT_NEAR(place.z(), (kRadius - inside) / cosine, 1e-10);
  EXPECT_NEAR(place.x(), 0, 1e-10);
  EXPECT_NEAR(place.y(), 0.01, 1e-12);
}

// No contact force can prevent a prescribed motion that leaves no room, so the step fails.
TEST(ContactOfBodies, WhatIsDrivenThroughAnotherIsTold) {
  Simulation simulation = simulation_of(
      joint("lower", "prismatic", "world", "block", "<origin xyz='0 0 0.07'/><axis xyz='0 0 -1'/>" + kFarLimits) +
          box("block", 1, Vector3::Constant(0.1)) + kFloor + contact_of("block", "floor"),
      "<motion joint='lower' position='0:0:0 1:0.1:0'/>", 1e-3);
  StepResult result;
  do {
    result = simulation.step();
  } while (result.converged && simulation.time() < 1);
  EXPECT_EQ(result.reason, StepResult::Reason::NotFinite) << simulation.explain(result);
  EXPECT_GT(simulation.link_pose(1).position.z(), 0.05 - 5.1e-3) << "the most that it gives way";
}

// ---------------------------------------------------------------- hits

/// Newton's cradle of five balls of 0.2 kg and radius 20 mm on rods of 0.3 m, 10 um apart. The first ball arrives with
/// 1 m/s. expected() solves the equations of the balls with contacts of finite stiffness.
struct Cradle {
  static constexpr int kBalls = 5;
  static constexpr double kMass = 0.2, kRadius = 0.02, kRod = 0.3, kGap = 1e-5, kStiffness = 1e6, kUntil = 0.02;
  static constexpr double kStart = 0.01, kRate = -1 / kRod, kApart = 2 * kRadius + kGap;
  static constexpr double kInertia = 0.4 * kMass * kRadius * kRadius;  // inertia of a ball

  static Eigen::VectorXd expected() {
    const OdeFunction swing = [](double, const Eigen::VectorXd& y) {
      Eigen::VectorXd rates(2 * kBalls);
      const auto arm = [&](int i) -> Eigen::Vector2d { return {-kRod * std::sin(y[i]), -kRod * std::cos(y[i])}; };
      for (int i = 0; i < kBalls; ++i) rates[kBalls + i] = kMass * kG * arm(i).x();
      for (int i = 0; i + 1 < kBalls; ++i) {
        const Eigen::Vector2d way = arm(i + 1) + Eigen::Vector2d(kApart, 0) - arm(i), along = way.normalized();
        const double force = push(kStiffness, 0.1 * kRadius, 2 * kRadius - way.norm());
        // Moment of a force about y: z Fx - x Fz.
        const auto lever = [&](int j) { return arm(j).y() * along.x() - arm(j).x() * along.y(); };
        rates[kBalls + i] -= force * lever(i);
        rates[kBalls + i + 1] += force * lever(i + 1);
      }
      rates.head(kBalls) = y.tail(kBalls);
      rates.tail(kBalls) /= kInertia + kMass * kRod * kRod;
      return rates;
    };
    Eigen::VectorXd y = Eigen::VectorXd::Zero(2 * kBalls);
    y[0] = kStart;
    y[kBalls] = kRate;
    constexpr int kPieces = 400;  // so short that no hit lies within one
    for (int i = 0; i < kPieces; ++i) y = solve_ode(swing, kUntil * i / kPieces, kUntil * (i + 1) / kPieces, y, 1e-10);
    return y;
  }

  static Eigen::VectorXd velocities(double step) {
    std::string parts = contact_of("*", "*", fmt::format("restitution='1' stiffness='{}'", kStiffness));
    for (int i = 0; i < kBalls; ++i)
      parts += joint(fmt::format("hinge{}", i), "continuous", "world", fmt::format("ball{}", i),
                     fmt::format("<origin xyz='{:.17g} 0 0'/><axis xyz='0 1 0'/>", kApart * i)) +
               body(fmt::format("ball{}", i), kMass, Vector3::Constant(kInertia), {0, 0, -kRod},
                    collision(fmt::format("<sphere radius='{}'/>", kRadius), {0, 0, -kRod}));
    Simulation simulation = simulation_of(
        parts, fmt::format("<initial joint='hinge0' position='{}' velocity='{:.17g}'/>", kStart, kRate), step);
    const double begin = simulation.energies().total();
    run_until(simulation, kUntil);
    // Tolerance: round-off over sub-steps of 1e-5 s; the kinetic energy is 0.1 J.
    EXPECT_NEAR(simulation.energies().total(), begin, 1e-10);
    Eigen::VectorXd out(kBalls);
    for (int i = 0; i < kBalls; ++i) out[i] = simulation.velocity(i);
    return out;
  }
};

// A step resolves the hits, which last 1 ms. So results after hits have the scheme's order.
TEST(ContactOfBodies, NewtonsCradleDoesWhatItsEquationsSay) {
  const Eigen::VectorXd expected = Cradle::expected().tail(Cradle::kBalls);
  EXPECT_GT(expected[0], 0) << "the first ball comes back";
  EXPECT_LT(expected[4], 0.95 * Cradle::kRate) << "the last ball has nearly all";
  const double coarse = (Cradle::velocities(2.5e-5) - expected).cwiseAbs().maxCoeff(),
               fine = (Cradle::velocities(1.25e-5) - expected).cwiseAbs().maxCoeff();
  EXPECT_LT(fine, 1e-3 * std::abs(Cradle::kRate));
  EXPECT_NEAR(observed_order(coarse, fine), 2, 0.05);
}

// ---------------------------------------------------------------- friction

// A disc that lies flat is braked as by a uniform pressure, by the moment 2/3 mu m g R: 4/3 mu g/R. Forces act at the
// mean of both ends of a step, whose arm is shorter by (rate h)^2/8.
TEST(ContactOfBodies, DiscThatSpinsOnTheFloorIsBraked) {
  constexpr double kMass = 2, kRadius = 0.1, kHigh = 0.02, kFriction = 0.3, kStiffness = 1e5, kRate = 10, kStep = 1e-3;
  constexpr int kPoints = 24;
  const double polar = kMass * kRadius * kRadius / 2, across = polar / 2 + kMass * kHigh * kHigh / 12;
  // It starts at the penetration at which its rim carries it.
  double inside = kMass * kG / kPoints / kStiffness;
  for (int i = 0; i < 20; ++i) inside *= kMass * kG / kPoints / push(kStiffness, 0.05 * kHigh, inside);
  Simulation simulation =
      simulation_of(body("disc", kMass, {across, across, polar}, Vector3::Zero(),
                         collision(fmt::format("<cylinder radius='{}' length='{}'/>", kRadius, kHigh))) +
                        floating("disc") + kFloor +
                        contact_of("disc", "floor", fmt::format("friction='{}' stiffness='{}'", kFriction, kStiffness)),
                    start("disc", {0, 0, kHigh / 2 - inside}, {0, 0, 0}, {0, 0, kRate}), kStep);
  const double braking = 4.0 / 3 * kFriction * kG / kRadius, stop = kRate / braking;
  const auto rate = [&] { return simulation.angular_momentum().z() / polar; };
  run_until(simulation, 0.02);  // until all points of the rim slip
  const double first = rate(), begin = simulation.time();
  run_until(simulation, 0.9 * stop);
  const double seen = (first - rate()) / (simulation.time() - begin);
  EXPECT_NEAR(seen, braking, 2 * kRate * kRate * kStep * kStep / 8 * braking);
  run_until(simulation, 4 * stop);
  EXPECT_NEAR(rate(), 0, 1e-9);
  EXPECT_LE(simulation.link_pose(1).position.head<2>().norm(), 1e-12) << "it has spun on the spot";
}

/// A block of 0.5 kg between two pads with a clamping force, pulled along them: its displacement, and its acceleration
/// at the end.
struct Drawn {
  double way, acceleration;
};
Drawn draw_block(double force, double friction, double pressed) {
  std::string parts = box("block", 0.5, {0.4, 0.08, 0.1}) + floating("block"), simulation_entries;
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "low" : "high";
    parts += joint("press_" + name, "prismatic", "world", name,
                   fmt::format("<origin xyz='0 {} 0'/><axis xyz='0 {} 0'/>", 0.05 * side, -side) + kFarLimits) +
             box(name, 0.1, {0.06, 0.02, 0.06});
    simulation_entries += fmt::format("<effort joint='press_{}' history='0:0 0.05:{}'/>", name, pressed);
  }
  parts += contact_of("block", "*", fmt::format("friction='{}' stiffness='1e6'", friction));
  simulation_entries +=
      fmt::format("<load link='block' at='0 0 0' force='{:.17g} 0 0' history='0:0 0.2:0 0.4:1'/>", force);
  Simulation simulation = simulation_of(parts, simulation_entries, 1e-3, Vector3::Zero());
  run_until(simulation, 0.5);
  const double begin = simulation.momentum().x() / 0.5;
  run_until(simulation, 0.7);
  return {simulation.link_pose(1).position.x(), (simulation.momentum().x() / 0.5 - begin) / 0.2};
}

TEST(ContactOfBodies, WhatIsGraspedSlipsAtTwiceTheFrictionOfAFinger) {
  constexpr double kFriction = 0.5, kPressed = 20, kMost = 2 * kFriction * kPressed;
  const Drawn held = draw_block(0.999 * kMost, kFriction, kPressed);
  // Four corners of each pad stick with a stiffness of 1e6 N/m, or with the largest stiffness that the step allows.
  EXPECT_LT(held.way, 2e-5);
  EXPECT_NEAR(held.acceleration, 0, 1e-9);
  for (const double more : {1.001, 1.01, 1.05})
    EXPECT_NEAR(draw_block(more * kMost, kFriction, kPressed).acceleration, (more - 1) * kMost / 0.5, 1e-9) << more;
}

// A cube slides over the edge of a table. The edge enters the cube by its front, but carries its bottom. The cube moves
// as on a plane, x = v t - mu g t^2/2, until its middle has left the table.
TEST(ContactOfBodies, CubeSlidesOffATable) {
  constexpr double kFriction = 0.2, kSpeed = 2, kStiffness = 1e6;
  Simulation simulation =
      simulation_of(box("cube", 1, Vector3::Constant(0.1)) + floating("cube") +
                        fixed("table", "<box size='0.5 0.5 0.1'/>", "<origin xyz='0 0 -0.05'/>") +
                        contact_of("cube", "table", fmt::format("friction='{}' stiffness='{}'", kFriction, kStiffness)),
                    start("cube", {0, 0, 0.05}, {kSpeed, 0, 0}), 1e-3);
  const double begin = energy_account(simulation);
  while (simulation.link_pose(1).position.x() < 0.24) {
    ASSERT_TRUE(simulation.step().converged);
    const double t = simulation.time();
    EXPECT_NEAR(simulation.link_pose(1).position.x(), kSpeed * t - 0.5 * kFriction * kG * t * t, 1e-4) << t;
    // At the end two corners, 10 mm behind the middle, and the edge carry it; the edge carries nearly all of the
    // weight.
    EXPECT_NEAR(simulation.link_pose(1).position.z(), 0.05, 2e-4) << t;
  }
  while (simulation.link_pose(1).position.z() > -0.1) ASSERT_TRUE(simulation.step().converged);
  EXPECT_GT(simulation.link_pose(1).position.x(), 0.25);
  EXPECT_NEAR(energy_account(simulation), begin, 1e-9);
}

// The same over the gap between two tables of equal height. The penetration on the second table continues that on the
// first one.
TEST(ContactOfBodies, CubeSlidesFromATableToAnother) {
  constexpr double kFriction = 0.1, kSpeed = 2;
  std::string parts = box("cube", 1, Vector3::Constant(0.1)) + floating("cube") +
                      contact_of("*", "*", fmt::format("friction='{}'", kFriction));
  for (const double x : {0.0, 0.5})
    parts +=
        fixed(fmt::format("table{}", x), "<box size='0.5 0.5 0.1'/>", fmt::format("<origin xyz='{} 0 -0.05'/>", x));
  Simulation simulation = simulation_of(parts, start("cube", {0, 0, 0.05}, {kSpeed, 0, 0}), 1e-3);
  const double begin = energy_account(simulation);
  while (simulation.link_pose(1).position.x() < 0.6) {
    ASSERT_TRUE(simulation.step().converged);
    const double t = simulation.time(), middle = kSpeed * t - 0.5 * kFriction * kG * t * t;
    // The cube sinks by 0.12 mm, and by twice as much on half of its points. The slip before it slides is as large.
    ASSERT_NEAR(simulation.link_pose(1).position.x(), middle, 1e-3) << t;
    ASSERT_NEAR(simulation.link_pose(1).position.z(), 0.05, 1e-3) << t;
  }
  EXPECT_NEAR(energy_account(simulation), begin, 1e-9);
}

// Two equal cubes on a frictionless floor hit each other. Their bottoms and sides are flush, and they must not pass
// through each other. Momentum is conserved.
TEST(ContactOfBodies, CubesOnAFloorKnockAgainstEachOther) {
  Simulation simulation =
      simulation_of(box("one", 1, Vector3::Constant(0.1)) + floating("one") + box("other", 1, Vector3::Constant(0.1)) +
                        floating("other") + kFloor + contact_of("*", "*", "restitution='0.5'"),
                    start("one", {0, 0, 0.05}, {1, 0, 0}) + start("other", {0.12, 0, 0.05}, {0, 0, 0}), 1e-3);
  run_until(simulation, 0.2);
  const double gap = simulation.link_pose(2).position.x() - simulation.link_pose(1).position.x();
  EXPECT_GT(gap, 0.1);
  EXPECT_NEAR(simulation.momentum().x(), 1, 1e-9);
  EXPECT_LT(simulation.link_pose(1).position.x(), 0.02 + 0.18 * 0.5) << "it has given its speed away";
}

/// Painleve's rod: its lower end approaches the floor at a distance of 1 um, with a velocity only along the floor. The
/// rod has 1 kg and two balls of 10 mm at its ends, 1 m apart.
struct Painleve {
  static constexpr double kHalf = 0.5, kMass = 1, kRadius = 1e-2, kStiffness = 1e6, kGap = 1e-6, kUntil = 0.03;
  static constexpr double kInertia = kMass * 4 * kHalf * kHalf / 12;
  double friction, angle, speed;  ///< angle of the rod over the floor

  bool is_paradox() const {  // sliding friction increases the normal force by more than this force
    const double along = speed < 0 ? -1 : 1;
    return 1 + 3 * std::cos(angle) * (std::cos(angle) + along * friction * std::sin(angle)) < 0;
  }

  /// Root of the hardening of the grip at a part of the depth; `belonging`: the penetration that belongs to the speed
  /// of approach [m].
  static double grip_root(double part, double belonging) {
    if (part <= 0) return 1;
    const double square = part * part, hardened = 0.1 * kRadius * part / std::pow(1 - square, 2);
    const double weight = std::clamp(2 * belonging / hardened - 1, 0.0, 1.0);
    return std::sqrt(1 + weight * ((1 + square * (18 + 21 * square)) / std::pow(1 - square, 6) - 1));
  }

  /// Velocity of the middle and rate of rotation, from the contact law's own equations by the semi-implicit Euler
  /// method of order 1.
  Vector3 expected() const {
    constexpr int kSteps = 300000;
    constexpr double kStep = kUntil / kSteps;
    double height = kRadius + kGap + kHalf * std::sin(angle), turned = angle, stretch = 0, approach = 0;
    bool recedes = false;
    Vector3 motion(speed, 0, 0);
    for (int i = 0; i < kSteps; ++i) {
      const double x = -kHalf * std::cos(turned), z = -kHalf * std::sin(turned) - kRadius;
      const double penetration = -(height + z), rate = -(motion.y() + motion.z() * x);
      if (rate > 0) approach = penetration <= 0 || recedes ? rate : std::max(approach, rate);  // or it is a new hit
      recedes = rate <= 0;
      const double root = grip_root(penetration / (0.1 * kRadius), approach / std::sqrt(kStiffness / kMass));
      const double force = push(kStiffness, 0.1 * kRadius, penetration), grip = kStiffness * root;
      stretch += kStep * root * (motion.x() - motion.z() * z);
      stretch = std::clamp(stretch, -friction * force / grip, friction * force / grip);
      const double drag = -grip * stretch;
      motion += kStep * Vector3(drag / kMass, force / kMass - kG, (x * force - z * drag) / kInertia);
      height += kStep * motion.y();
      turned += kStep * motion.z();
    }
    return motion;
  }

  Vector3 seen(double step) const {
    std::string balls;
    for (const double end : {-kHalf, kHalf})
      balls += collision(fmt::format("<sphere radius='{}'/>", kRadius), {end, 0, 0});
    const std::string parts =
        body("rod", kMass, {1e-4, kInertia, kInertia}, Vector3::Zero(), balls) + floating("rod") + kFloor +
        contact_of("rod", "floor", fmt::format("friction='{}' restitution='1' stiffness='{}'", friction, kStiffness));
    Simulation simulation =
        simulation_of(parts,
                      start("rod", {0, 0, kRadius + kGap + kHalf * std::sin(angle)}, {speed, 0, 0}) +
                          fmt::format("<initial joint='of_rod/ry' position='{:.17g}'/>", -angle),
                      step);
    const double begin = energy_account(simulation), energy = simulation.energies().total();
    while (simulation.time() < kUntil - 0.5 * step) {
      EXPECT_TRUE(simulation.step().converged);
      EXPECT_LT(simulation.energies().total(), energy * (1 + 1e-9)) << "energy from nowhere";
    }
    EXPECT_NEAR(energy_account(simulation), begin, 1e-8 * begin);
    const Vector3 middle = simulation.link_pose(1).position, momentum = simulation.momentum();
    const double spin = (simulation.angular_momentum() - middle.cross(momentum)).y();
    return {momentum.x() / kMass, momentum.z() / kMass, -spin / kInertia};
  }
};

// Where friction increases the normal force without bound, the rod jams and is thrown off, although it has no speed
// towards the floor. Sticking has order 1, sliding order 2.
TEST(ContactOfBodies, PainlevesRodJamsAndIsThrownOff) {
  for (const Painleve& rod : {Painleve{2, 1, -3}, Painleve{5, 0.6, -3}}) {
    EXPECT_TRUE(rod.is_paradox());
    const Vector3 expected = rod.expected();
    EXPECT_GT(expected.y(), 1) << "thrown off";
    const Vector3 coarse = rod.seen(8e-6), fine = rod.seen(4e-6);
    EXPECT_LT((2 * fine - coarse - expected).norm(), 0.01 * expected.norm()) << "in the limit of short steps";
    EXPECT_GT(observed_order((coarse - expected).norm(), (fine - expected).norm()), 0.8);
  }
  for (const Painleve& rod : {Painleve{2, 1, 3}, Painleve{0.5, 1, -3}}) {
    EXPECT_FALSE(rod.is_paradox());
    const Vector3 expected = rod.expected();
    const double coarse = (rod.seen(2e-5) - expected).norm(), fine = (rod.seen(1e-5) - expected).norm();
    EXPECT_LT(fine, 1e-4);
    EXPECT_NEAR(observed_order(coarse, fine), 2, 0.2);
  }
}

}  // namespace
}  // namespace flexarm::test::touching
