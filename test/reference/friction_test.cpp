// Tests dry friction against closed forms: sticking, stopping, and friction that grows with the force on the joint.
#include "reference/dynamics_joint_chain.h"
#include "reference/one_coordinate_scenes.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using Law = scene::FrictionDescription::Law;

/// A block on a rail along x. The rail is inclined by the angle `slope`, and positive positions are uphill.
SceneBuilder incline(double slope, double coefficient, double velocity) {
  SceneBuilder b;
  b.scene.gravity = kGravity * Vector3(-std::sin(slope), 0, -std::cos(slope));
  b.body("block", kBlockMass, {0, 0, 0}, Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "block", {0, 0, 0}, {1, 0, 0}).friction_law = {Law::Coulomb,
                                                                                                coefficient, 0};
  initial_joint(b, "rail", 0, velocity);
  return b;
}

/// The same block on a stiff, light beam instead of a rail.
SceneBuilder beam_incline(double slope, double coefficient, double velocity) {
  SceneBuilder b = incline(slope, coefficient, velocity);
  b.beam("line", {{2, 0, 0}}, section(1e9, 1e9, 1e8, 1e8, 1e-3, 1e-6, 1e-6), 2, 2);
  scene::JointDescription slide = b.scene.joints[0];
  b.scene.joints.clear();
  b.joint("clamp", JointKind::Fixed, "world", "line", {-1, 0, 0});
  slide.parent = "line";
  slide.kind = JointKind::Slide;
  slide.slide = scene::SlideDescription{1.0, JointKind::Fixed};
  b.scene.joints.push_back(slide);
  b.scene.initial_joints[0].position = 1;
  return b;
}

// ---------------------------------------------------------------- a block on an incline

TEST(Incline, SticksBelowTheAngleOfFriction) {
  for (const std::string scheme : {"em", "edmc2", "m1", "m2", "std", "newmark", "hht2"}) {
    Simulation simulation(incline(0.4, std::tan(0.4) * 1.001, 0).scene, options(scheme, 0.01));
    run(simulation, 200, [&] { ASSERT_EQ(simulation.position(0), 0) << scheme; });
    EXPECT_NEAR(simulation.velocity(0), 0, 1e-14);
    EXPECT_EQ(simulation.energies().dissipated, 0);
    EXPECT_EQ(simulation.effort(0), 0) << "what friction holds is no applied effort";
  }
}

TEST(Incline, SlidesAboveTheAngleOfFriction) {
  const double slope = 0.4, coefficient = 0.3;
  const double acceleration = -kGravity * (std::sin(slope) - coefficient * std::cos(slope));
  for (const std::string scheme : {"em", "m1", "newmark"}) {
    Simulation simulation(incline(slope, coefficient, 0).scene, options(scheme, 0.01));
    run(simulation, 100, [&] {  // the law is exact at constant acceleration
      const double t = simulation.time();
      ASSERT_NEAR(simulation.velocity(0), acceleration * t, 1e-12) << scheme;
      ASSERT_NEAR(simulation.position(0), 0.5 * acceleration * t * t, 1e-12) << scheme;
    });
    const double expected = coefficient * kBlockMass * kGravity * std::cos(slope) * std::abs(simulation.position(0));
    EXPECT_NEAR(simulation.energies().dissipated, expected, 1e-11);
  }
}

// The beam bends by at most 1e-7, which changes the direction of the normal force. There is no normal force before the
// beam has bent: the damped beam takes up the load over some steps, during which the block moves a little.
TEST(Incline, HoldsOnAStiffBeam) {
  const double slope = 0.4, coefficient = 0.3;
  SceneBuilder steep = beam_incline(slope, std::tan(slope) * 1.01, 0);
  steep.scene.links[2].beam->stiffness_proportional_damping = 1e-3;
  Simulation sticking(steep.scene, options("em", 0.01));
  run(sticking, 50);
  const double rest = sticking.position(0);
  EXPECT_NEAR(rest, 1, 1e-2);
  run(sticking, 100, [&] { ASSERT_EQ(sticking.position(0), rest); });
  Simulation sliding(beam_incline(slope, coefficient, 0).scene, options("em", 0.002));
  run(sliding, 200);
  const double t = sliding.time(), force = kBlockMass * kGravity;
  const double travel = -0.5 * kGravity * (std::sin(slope) - coefficient * std::cos(slope)) * t * t;
  const double bend = force * 2 * 2 / 1e8;  // slope of the deflected line
  EXPECT_NEAR(sliding.position(0) - 1, travel, 10 * bend * std::abs(travel));
}

// The block stops within the step in which v <= F h / m. The distance of the mean velocity is longer than the exact one
// by at most F/m h^2 / 8.
TEST(Incline, DecelerationStopsAfterTheDistanceOfStopping) {
  const double coefficient = 0.35, deceleration = coefficient * kGravity;
  for (const double velocity : {1.0, -0.77, 0.01})
    for (const double step : {0.01, 0.003}) {
      Simulation simulation(incline(0, coefficient, velocity).scene, options("em", step));
      run(simulation, static_cast<int>(0.5 / step));
      const double exact = velocity * velocity / (2 * deceleration), way = std::abs(simulation.position(0));
      EXPECT_GE(way, exact - 1e-13);
      EXPECT_LE(way, exact + deceleration * step * step / 8 + 1e-13);
      EXPECT_NEAR(simulation.energies().dissipated, 0.5 * kBlockMass * velocity * velocity, 1e-12);
      const double rest = simulation.position(0);
      run(simulation, 100, [&] { ASSERT_EQ(simulation.position(0), rest); });
      EXPECT_NEAR(simulation.velocity(0), 0, 1e-14);
    }
}

// The block moves up to a halt and stays there, or slides down again if the incline is steep. The reversal costs the
// distance of a few steps.
TEST(Incline, StopsOrTurnsOnTheWayUp) {
  const double slope = 0.4, step = 0.01;
  for (const double coefficient : {0.6, 0.2}) {
    const double up = kGravity * (std::sin(slope) + coefficient * std::cos(slope));
    const double down = kGravity * (std::sin(slope) - coefficient * std::cos(slope));
    Simulation simulation(incline(slope, coefficient, 1).scene, options("em", step));
    run(simulation, 100);
    double expected = 1 / (2 * up);
    const double falling = simulation.time() - 1 / up;
    if (down > 0) expected -= 0.5 * down * falling * falling;
    // Change of the distance if the reversal is one step late
    const double late = (down > 0 ? down * falling : 0) + up * step;
    EXPECT_NEAR(simulation.position(0), expected, late * step);
    if (down < 0) {
      const double rest = simulation.position(0);
      run(simulation, 100, [&] { ASSERT_EQ(simulation.position(0), rest); });
    }
  }
}

TEST(Incline, PushedAgainstAStopAndBack) {
  SceneBuilder b = incline(0, 0.2, 0);
  b.scene.joints[0].limits = scene::JointLimits{-1, 0.1};
  Simulation simulation(b.scene, options("em", 1e-3, 1e-11));
  InvariantDrift drift(simulation);
  simulation.command_effort(0, 10);
  run(simulation, 1500, [&] { drift.observe(); });
  EXPECT_NEAR(simulation.velocity(0), 0, 1e-9) << "rests in the stop";
  simulation.command_effort(0, -10);
  run(simulation, 300, [&] { drift.observe(); });
  EXPECT_LT(simulation.position(0), 0);
  EXPECT_LT(drift.energy(), 1e-11);
}

// ---------------------------------------------------------------- pendulum with a bearing

/// Next turning point of a point pendulum of length l that turned at `from` and moves in the direction `sign`. Its
/// bearing has the friction moment mu r |force|. w = (dtheta/dt)^2 obeys dw/dtheta + 2 s c w = -2 g/l (sin + s c cos),
/// with c = mu r/l / sqrt(1 - (mu r/l)^2). The bearing's force has the radial part m (g cos + l w) and the moment's
/// share.
double next_turn(double from, double sign, double length, double lever) {
  const double q = kGravity / length, c = sign * (lever / length) / std::sqrt(1 - std::pow(lever / length, 2));
  const double B = -6 * q * c / (1 + 4 * c * c), A = 2 * q + 2 * c * B;
  const auto particular = [&](double x) { return A * std::cos(x) + B * std::sin(x); };
  const auto w = [&](double x) { return particular(x) - particular(from) * std::exp(-2 * c * (x - from)); };
  double inside = 0, outside = -from;  // because of friction it turns before -from
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (inside + outside);
    (w(middle) > 0 ? inside : outside) = middle;
  }
  return inside;
}

TEST(Pendulum, LosesPerHalfSwingWhatItsBearingTakes) {
  const double length = 0.8, lever = 0.4 * 0.1, start = 1.0, step = 1e-3;
  for (const Law law : {Law::Coulomb, Law::Smooth}) {
    SceneBuilder b;
    b.scene.gravity = {0, 0, -kGravity};
    b.body("bob", 2, {0, 0, -length}, Matrix3::Zero());
    b.joint("bearing", JointKind::Revolute, "world", "bob", {0, 0, 0}, {0, 1, 0}).friction_law = {law, 0.4, 0.1};
    initial_joint(b, "bearing", start, 0);
    Simulation simulation(b.scene, options("em", step));
    double exact = start, extreme = start, sign = -1;
    int turns = 0;
    run(simulation, 4000, [&] {
      const double angle = simulation.position(0);
      if (sign * (angle - extreme) >= 0) {
        extreme = angle;
      } else if (turns < 4 && sign * (angle - extreme) < -1e-6) {
        exact = next_turn(exact, sign, length, lever);
        // Sampling and reversal have errors of up to a h^2 each, with the largest acceleration a = g/l. The smooth law
        // adds the error of its creeping speed.
        const double tolerance = 2 * (++turns) * kGravity / length * step * step + (law == Law::Smooth ? 1e-3 : 0);
        EXPECT_NEAR(extreme, exact, tolerance) << "turn " << turns;
        sign = -sign;
      }
    });
    EXPECT_EQ(turns, 4);
  }
}

// ---------------------------------------------------------------- stick and slip

/// A disc at rest on a torsion spring, and a rotating drum on it with the constant friction moment M. They slip until
/// their rates agree. Then they swing together, until the drum's inertia needs more than M.
struct StickSlipOrbit {
  double k = 50, disc = 0.3, drum = 0.5, moment = 2, speed = 1;

  double disc_angle(double t) const { return moment / k * (1 - std::cos(std::sqrt(k / disc) * t)); }
  double disc_rate(double t) const { return moment / std::sqrt(k * disc) * std::sin(std::sqrt(k / disc) * t); }
  double drum_rate(double t) const { return speed - moment / drum * t; }
  double slip_duration() const {
    double low = 0, high = 0;
    while (drum_rate(high) > disc_rate(high)) high += 1e-3;
    for (int n = 0; n < 60; ++n) {
      const double middle = 0.5 * (low + high);
      (drum_rate(middle) > disc_rate(middle) ? low : high) = middle;
    }
    return low;
  }
  double slipped() const {
    const double t = slip_duration();
    return speed * t - 0.5 * moment / drum * t * t - disc_angle(t);
  }
  double stick_duration() const {
    const double rate = std::sqrt(k / (disc + drum)), t = slip_duration();
    const double amplitude = std::hypot(disc_angle(t), disc_rate(t) / rate);
    const double largest = moment / (drum * rate * rate);  // deflection at which the drum needs M
    return (std::asin(largest / amplitude) - std::asin(disc_angle(t) / amplitude)) / rate;
  }
};

SceneBuilder spring_and_drum(const StickSlipOrbit& orbit) {
  SceneBuilder b;
  b.beam("spring", {{1, 0, 0}}, section(1e4, 1e4, orbit.k, 1e4, 1e-6, 1e-9, 1e-9), 1, 1);
  b.body("disc", 1, {0, 0, 0}, Vector3(orbit.disc, 1, 1).asDiagonal());
  b.body("drum", 1, {0, 0, 0}, Vector3(orbit.drum, 1, 1).asDiagonal());
  b.joint("clamp", JointKind::Fixed, "world", "spring");
  b.joint("weld", JointKind::Fixed, "spring", "disc", {1, 0, 0});
  scene::JointDescription& bearing = b.joint("bearing", JointKind::Continuous, "disc", "drum", {0, 0, 0}, {1, 0, 0});
  bearing.friction = orbit.moment;
  bearing.friction_law.law = Law::Coulomb;
  initial_joint(b, "bearing", 0, orbit.speed);
  return b;
}

TEST(StickSlipOrbit, FollowsTheClosedForm) {
  const StickSlipOrbit orbit;
  const double slip = orbit.slip_duration(), stick = orbit.stick_duration();
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const double step = 0.004 / (k == 0 ? 1 : 8);
    Simulation simulation(spring_and_drum(orbit).scene, options("em", step));
    double before = -1, stuck_from = 0, stuck_to = 0;
    run(simulation, static_cast<int>((slip + stick + 0.05) / step), [&] {
      const double angle = simulation.position(0);
      if (angle == before) {
        if (stuck_from == 0) stuck_from = simulation.time() - step;
        stuck_to = simulation.time();
        error[k] = std::abs(angle - orbit.slipped());
      }
      before = angle;
    });
    // Transitions are decided once per step, by means of the efforts over the step.
    EXPECT_NEAR(stuck_from, slip, 2 * step);
    EXPECT_NEAR(stuck_to, slip + stick, 2 * step);
  }
  EXPECT_LT(error[1], 1e-5 * orbit.slipped());
  EXPECT_GT(std::log(error[0] / error[1]) / std::log(8), 1.5) << error[0] << " " << error[1];
}

// ---------------------------------------------------------------- couplings

// A mimic's friction acts on the coordinate that it mimics, multiplied by the absolute value of the ratio.
TEST(FollowersFriction, AddsToTheThreshold) {
  for (const double ratio : {2.0, -2.0}) {
    SceneBuilder b;
    b.body("one", 1, {0, 0, 0}, Matrix3::Identity());
    b.body("two", 1, {0, 0, 0}, Matrix3::Identity());
    b.joint("master", JointKind::Prismatic, "world", "one", {0, 0, 0}, {1, 0, 0}).friction = 1;
    b.joint("follower", JointKind::Prismatic, "world", "two", {0, 1, 0}, {1, 0, 0}).mimic =
        scene::Mimic{"master", ratio, 0};
    b.scene.joints[1].friction = 3;
    for (scene::JointDescription& joint : b.scene.joints) joint.friction_law.law = Law::Coulomb;
    const double threshold = 1 + 3 * std::abs(ratio), inertia = 1 + ratio * ratio;
    for (const double sign : {1.0, -1.0}) {
      Simulation simulation(b.scene, options("em", 0.01));
      simulation.command_effort(0, 0.999 * sign * threshold);
      run(simulation, 50, [&] { ASSERT_EQ(simulation.position(0), 0); });
      simulation.command_effort(0, sign * (threshold + 1));
      run(simulation, 50);
      EXPECT_NEAR(simulation.velocity(0), sign * 0.5 / inertia, 1e-13);
      EXPECT_NEAR(simulation.energies().dissipated, threshold * std::abs(simulation.position(0)), 1e-13);
      simulation.command_effort(0, 0);
      run(simulation, 50);
      EXPECT_NEAR(simulation.velocity(0), 0, 1e-14) << "stops";
    }
  }
}

TEST(SphericalFriction, HoldsARotationExactly) {
  SceneBuilder b;
  b.body("ball", 1, {0, 0, 0}, Matrix3::Identity());
  scene::JointDescription& joint = b.joint("socket", JointKind::Spherical, "world", "ball");
  joint.friction = 1;
  joint.friction_law.law = Law::Coulomb;
  Simulation simulation(b.scene, options("em", 0.01));
  for (int k = 0; k < 3; ++k) simulation.command_effort(k, k == 1 ? -0.9 : 0.9);
  run(simulation, 100, [&] {
    for (int k = 0; k < 3; ++k) ASSERT_EQ(simulation.position(k), 0);
  });
  simulation.command_effort(0, 3);
  run(simulation, 20);
  EXPECT_GT(simulation.velocity(0), 0.3);
}

// Components of free rotations stick independently of each other.
TEST(SphericalFriction, SlipsAboutOneAxisOnly) {
  SceneBuilder b;
  b.body("ball", 1, {0, 0, 0}, Matrix3::Identity());
  b.body("knob", 1, {0, 0, 0}, Matrix3::Identity());
  b.joint("socket", JointKind::Spherical, "world", "ball");
  b.joint("eye", JointKind::Spherical, "world", "knob");
  for (scene::JointDescription& joint : b.scene.joints) joint.friction = 1, joint.friction_law.law = Law::Coulomb;
  for (int slipping = 0; slipping < 6; ++slipping) {
    Simulation simulation(b.scene, options("em", 0.01));
    simulation.command_effort(slipping, 1.5);
    run(simulation, 50);
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(simulation.position(k), k == slipping ? 0.5 * 0.5 * 0.25 : 0, k == slipping ? 1e-5 : 1e-14) << k;
  }
}

TEST(NoForceNoFriction, StaysFree) {
  SceneBuilder b = incline(0, 0.5, 1);
  b.scene.gravity.setZero();
  Simulation simulation(b.scene, options("em", 0.01));
  run(simulation, 100);
  EXPECT_NEAR(simulation.position(0), 1, 1e-13);
  EXPECT_EQ(simulation.energies().dissipated, 0);
}

TEST(CoulombFriction, IsRefusedWhereStepsGoBackwards) {
  EXPECT_THROW(Simulation(incline(0, 0.5, 1).scene, options("em4", 0.01)), std::exception);
}

}  // namespace
}  // namespace flexarm::test
