// Tests stops of joints and at the ends of lines: penetration, restitution and energy at any speed and under any force.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

constexpr double kStep = 1e-3, kLimit = 0.5;

void start(SceneBuilder& b, const std::string& coordinate, double position, double velocity) {
  b.scene.initial_joints.push_back({coordinate, position, velocity, {}, true});
}

/// A mass of 2 kg on a rail along x, between stops at +-0.5 m.
SceneBuilder carriage(double speed) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX()).limits =
      scene::JointLimits{-kLimit, kLimit};
  start(b, "rail", 0, speed);
  return b;
}

constexpr double kStretch = 4e7;  // stiffness of the beam below [N]

/// The mass slides along a cantilever of `elements` elements over 10 m. The cantilever is so heavy that a hit does not
/// move it.
SceneBuilder rider(int elements, double position, double speed) {
  SceneBuilder b;
  b.beam("rail", {{10, 0, 0}}, section(kStretch, kStretch, 4e7, 5e7, 1e4, 200, 100), elements, 2);
  b.joint("clamp", JointKind::Fixed, "world", "rail");
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  b.joint("ride", JointKind::Slide, "rail", "block").slide = scene::SlideDescription{position, JointKind::Fixed};
  start(b, "ride", position, speed);
  return b;
}

/// Observations of a run.
struct Watch {
  double deepest = 0;        // largest depth beyond `limit`
  double energy_defect = 0;  // relative to the largest energy
  int halvings = 0;          // largest number in one step
};

Watch watch(Simulation& simulation, double limit, int steps) {
  Watch out;
  const double begin = energy_account(simulation);
  double scale = simulation.energies().total();
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    EXPECT_TRUE(result.converged) << to_string(result.reason) << " at " << simulation.time();
    if (!result.converged) return out;
    out.deepest = std::max(out.deepest, std::abs(simulation.position(0)) - limit);
    out.halvings = std::max(out.halvings, result.halvings);
    scale = std::max(scale, std::abs(simulation.energies().work));
    out.energy_defect = std::max(out.energy_defect, std::abs(energy_account(simulation) - begin) / scale);
  }
  return out;
}

// Accuracy of the restitution (docs/notes/stops.md): full steps have an error of 2 % of the speed. Halved steps of a
// fifth of a hit have at most a tenth of the restitution.
constexpr double kRestitution = 0.3, kOfRestitution = 0.03;

class Stops : public ::testing::TestWithParam<const char*> {};

TEST_P(Stops, HoldACarriageAtAnySpeed) {
  for (const double speed : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    SCOPED_TRACE(speed);
    Simulation simulation(carriage(speed).scene, options(GetParam(), kStep));
    const double hit = kLimit / speed / kStep;  // time of the first hit, in steps
    const Watch seen = watch(simulation, kLimit, static_cast<int>(hit + std::min(2 * hit, 30.0)) + 2);
    EXPECT_LT(seen.deepest, 0.1 * 2 * kLimit);
    EXPECT_LE(seen.halvings, 20) << "two hits";
    if (hit > 10) {  // otherwise later hits fall into the same step
      EXPECT_NEAR(-simulation.velocity(0) / speed, kRestitution, kOfRestitution);
    }
    EXPECT_LT(seen.energy_defect, 1e-11);
  }
}

TEST_P(Stops, HoldASliderAtAnySpeed) {
  for (const int elements : {40, 100})
    for (const double speed : {0.1, 1.0, 8.0, 20.0, 50.0, 200.0}) {
      SCOPED_TRACE(fmt::format("{} m/s, {} elements", speed, elements));
      const double way = std::min(0.03 * speed, 4.0), length = 10;
      Simulation simulation(rider(elements, length - way, speed).scene, options(GetParam(), kStep));
      const Watch seen = watch(simulation, length, static_cast<int>(way / speed / kStep) + 30);
      EXPECT_LT(seen.deepest, 0.1 * length / elements);
      EXPECT_LE(seen.halvings, 14);
      EXPECT_NEAR(-simulation.velocity(0) / speed, kRestitution, kOfRestitution);
      // Round-off of strains gives a force, which does work over the distance.
      const double round_off = kStretch * 1e-16 * elements, energy = speed * speed;
      EXPECT_LT(seen.energy_defect, round_off * 2 * way / energy + 1e-10);
    }
}

// A range of 1 mrad, which 200 rad/s crosses in 5 us. Seven hits fall into the first step of 10 ms. With a restitution
// of 0.3 they would take 9.8 ms, with 0.33 5.8 ms, and the eighth hit would come after 17 ms.
TEST_P(Stops, ThrowAnArmToAndFroWithinAStep) {
  constexpr double kRange = 1e-3, kSpeed = 200;
  SceneBuilder b;
  b.body("arm", 1, {0.5, 0, 0}, 0.1 * Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "world", "arm", Vector3::Zero(), Vector3::UnitZ()).limits =
      scene::JointLimits{-kRange / 2, kRange / 2};
  b.scene.gravity.setZero();
  start(b, "hinge", 0, kSpeed);
  Simulation simulation(b.scene, options(GetParam(), 0.01));
  const double energy = simulation.energies().total();
  const StepResult first = simulation.step();
  ASSERT_TRUE(first.converged) << to_string(first.reason);
  EXPECT_GT(first.deepest_halving, b.scene.integrator.max_halvings);
  const double speed = -simulation.velocity(0) / kSpeed;
  EXPECT_GT(speed, std::pow(kRestitution, 7));
  EXPECT_LT(speed, std::pow(kRestitution + kOfRestitution, 7));
  // In the shortest sub-steps, angles of 2e-7 rad are differences of orientations with a round-off of 2e-16.
  const Energies& after = simulation.energies();
  EXPECT_NEAR((after.total() + after.dissipated) / energy, 1, 1e-9 * first.halvings);
  EXPECT_LT(watch(simulation, kRange / 2, 9).deepest, 0.1 * kRange);
}

INSTANTIATE_TEST_SUITE_P(Conserving, Stops, ::testing::Values("em", "std", "edmc2"));

// In the Newmark family the force acts at the end of the step. The energy account must hold with it.
TEST(Stop, OfNewmarksFamily) {
  for (const char* scheme : {"newmark", "hht3"})
    for (const double speed : {0.1, 10.0, 100.0}) {
      SCOPED_TRACE(fmt::format("{} {}", scheme, speed));
      Simulation simulation(carriage(speed).scene, options(scheme, kStep));
      const Watch seen = watch(simulation, kLimit, static_cast<int>(kLimit / speed / kStep) + 30);
      EXPECT_LT(seen.deepest, 0.1 * 2 * kLimit);
      EXPECT_NEAR(-simulation.velocity(0) / speed, kRestitution, 0.1) << "of first order in the step";
      // The dissipation of the Hilber-Hughes-Taylor schemes is not in the account.
      EXPECT_LT(seen.energy_defect, scheme == std::string("newmark") ? 1e-10 : 0.05);
    }
}

// Stops with a given restitution have the same accuracy as those with the default. At 1 m/s, a hit begins and ends
// between the ends of steps.
TEST(Stop, GivesBackWhatTheSceneAsks) {
  for (const double restitution : {0.1, 0.6, 1.0}) {
    SCOPED_TRACE(restitution);
    SceneBuilder b = carriage(1);
    b.scene.joints.back().limits->restitution = restitution;
    Simulation joint(b.scene, options("em", kStep));
    EXPECT_LT(watch(joint, kLimit, 560).energy_defect, 1e-11);
    EXPECT_NEAR(-joint.velocity(0), restitution, kOfRestitution);

    SceneBuilder slide = rider(40, 9.9, 1);
    slide.scene.joints.back().slide->restitution = restitution;
    Simulation ride(slide.scene, options("em", kStep));
    watch(ride, 10, 160);
    EXPECT_NEAR(-ride.velocity(0), restitution, kOfRestitution);
  }
}

TEST(Stop, HoldsWhateverPresses) {
  SceneBuilder b = carriage(0);
  b.scene.efforts.push_back({"rail", TimeFunction::parse("0:0 0.1:1e6 1:1e6"), {}});
  Simulation joint(b.scene, options("em", kStep));
  EXPECT_LT(watch(joint, kLimit, 300).deepest, 0.1 * 2 * kLimit);
  EXPECT_GT(joint.position(0), kLimit);

  SceneBuilder slide = rider(40, 10, 0);
  slide.scene.efforts.push_back({"ride", TimeFunction::parse("0:0 0.1:1e6 1:1e6"), {}});
  Simulation slider(slide.scene, options("em", kStep));
  EXPECT_LT(watch(slider, 10, 300).deepest, 0.1 * 10.0 / 40);
  EXPECT_GT(slider.position(0), 10);
}

// Stiffness and damping of a stop are chosen for the inertia at the start. The stop also holds a thousand times this
// inertia.
TEST(Stop, HoldsAnArmThatHasGrown) {
  using scene::JointKind;
  SceneBuilder b;
  b.body("sleeve", 0.1, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("hinge", JointKind::Revolute, "world", "sleeve").limits = scene::JointLimits{-kLimit, kLimit};
  b.body("weight", 10, Vector3::Zero(), 0.01 * Matrix3::Identity());
  b.joint("boom", JointKind::Prismatic, "sleeve", "weight", Vector3::Zero(), Vector3::UnitX());
  b.scene.motions.push_back({"boom", TimeFunction::parse("0:0.1 1:3 10:3"), {}});
  b.scene.efforts.push_back({"hinge", TimeFunction::parse("0:0 1.1:0 1.2:2000 10:2000"), {}});
  Simulation simulation(b.scene, options("em", kStep));
  double deepest = 0;
  for (int n = 0; n < 3000; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    deepest = std::max(deepest, std::abs(simulation.position(0)) - kLimit);
  }
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 0.1 * 2 * kLimit);
}

// Two limits at one position hold the joint there.
// How deep a hit goes, and how long it lasts, belongs to the scene: half the step changes neither.
TEST(Stop, DependsOnNoStep) {
  for (const double contact_time : {0.01, 0.04}) {
    SceneBuilder b = carriage(0.5);
    b.scene.contact_time = contact_time;
    b.scene.joints[0].limits->restitution = 1;
    for (const double step : {1e-3, 2.5e-4, 1e-4}) {
      SimulationOptions finer = options("em", kStep);
      finer.step = step;
      Simulation simulation(b.scene, finer);
      double deepest = 0, begin = 0, end = 0;
      while (simulation.time() < 1.5) {
        ASSERT_TRUE(simulation.step().converged);
        deepest = std::max(deepest, simulation.position(0) - kLimit);
        if (simulation.position(0) > kLimit) end = simulation.time(), begin = begin > 0 ? begin : end;
      }
      // A linear oscillator: depth v T / pi; hardening and midpoint rule change it by less than (pi h / T)^2 / 8 + 5
      // (p/d)^2 / 2.
      const double depth = 0.5 * contact_time / 3.14159265358979323846;
      EXPECT_NEAR(deepest, depth,
                  (0.125 * std::pow(3.15 * step / contact_time, 2) + 2.5 * std::pow(depth / 0.1, 2)) * depth)
          << step;
      EXPECT_NEAR(end - begin, contact_time, 2 * step + 0.05 * contact_time) << step;
    }
  }
}

// A declared stiffness is the ratio of a load to the depth where the stop yields little.
TEST(Stop, HasTheDeclaredStiffness) {
  for (const std::string scheme : {"em", "newmark", "rk4"}) {
    SceneBuilder b = carriage(0);
    b.scene.joints[0].limits->stiffness = 4e5;
    b.scene.joints[0].damping = 2 * std::sqrt(2 * 4e5);
    start(b, "rail", kLimit, 0);
    b.scene.initial_joints.erase(b.scene.initial_joints.begin());
    Simulation simulation(b.scene, options(scheme, kStep));
    simulation.command_effort(0, 40);
    for (int n = 0; n < 300; ++n) ASSERT_TRUE(simulation.step().converged);
    EXPECT_NEAR(simulation.position(0) - kLimit, 1e-4, 1e-4 * 8 * 1e-6 + 1e-12) << scheme;
  }
}

TEST(Stop, OfNoRange) {
  SceneBuilder b = carriage(1);
  b.scene.joints[0].limits = scene::JointLimits{0, 0};
  b.scene.efforts.push_back({"rail", TimeFunction::parse("0:0 0.1:1000 0.2:-1000 1:-1000"), {}});
  Simulation simulation(b.scene, options("em", kStep));
  EXPECT_LT(watch(simulation, 0, 500).deepest, 1e-4) << "of the size of the mechanism";
}

TEST(Stop, OfATravelThatFollowsAnAngle) {
  SceneBuilder b = rider(40, 9.5, 0);
  scene::JointDescription& ride = b.scene.joints.back();
  ride.slide->rotation = JointKind::Screw;
  ride.axis = Vector3::UnitX();
  ride.ratio = 0.5;
  b.scene.initial_joints = {{"ride/1", 0, 100, {}, true}};
  Simulation simulation(b.scene, options("em", kStep));
  double deepest = 0;
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    deepest = std::max(deepest, simulation.position(0) - 10);
  }
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 0.1 * 10.0 / 40);
  EXPECT_LT(simulation.velocity(0), 0) << "it is thrown back";
}

// A driven coordinate has no stops. A motion beyond the end of the line is an error that names the drive, also for
// travels that follow an angle.
TEST(Stop, NoneOfAMotionBeyondTheEnd) {
  for (const JointKind rotation : {JointKind::Fixed, JointKind::Screw}) {
    SceneBuilder b = rider(40, 9, 0);
    b.scene.initial_joints.clear();
    scene::JointDescription& ride = b.scene.joints.back();
    ride.slide->rotation = rotation;
    ride.axis = Vector3::UnitX();
    ride.ratio = 1;
    const bool is_screw = rotation == JointKind::Screw;
    b.scene.motions.push_back(
        {is_screw ? "ride/1" : "ride", TimeFunction::parse(is_screw ? "0:0 1:2" : "0:9 1:11"), {}});
    Simulation simulation(b.scene, options("em", kStep));
    StepResult result;
    do result = simulation.step();
    while (result.converged && simulation.time() < 1);
    EXPECT_EQ(result.reason, StepResult::Reason::DrivenOffTheLine);
    EXPECT_NEAR(simulation.position(0), 10 + 0.1 * 10.0 / 40, 2e-3 + 1e-9) << "2 m/s, the last step done";
  }
}

}  // namespace
}  // namespace flexarm::test
