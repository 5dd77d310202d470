// Tests servos whose mode is switched during a run, and set points that move.
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "flexarm/simulation/checkpoint.h"
#include "simulation/inside.h"
#include "simulation/same_bits.h"
#include "support/refusal.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using scene::JointKind;
using Mode = ServoMode;

constexpr double kStep = 1e-3, kLoad = 5, kMass = 2;
/// Tolerance for forces and displacements of a block at rest: Newton's tolerance, 1e-12 m, times kp, and over a step.
constexpr double kRest = 1e-8;

/// A block on a rail that a constant force pushes. Its servo is in mode position and also has gains for mode velocity.
SceneBuilder block_on_rail() {
  SceneBuilder b;
  b.scene.integrator.step = kStep;
  b.scene.integrator.tolerance = 1e-12;
  b.body("block", kMass, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("rail", JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  b.load("block", Vector3::Zero(), {kLoad, 0, 0});
  scene::ServoDescription& servo = b.servo("rail", 800, 80, 2000);
  servo.set_point = TimeFunction(0.25);
  servo.other_modes.push_back({Mode::Velocity, 60, 0, 300, 0});
  return b;
}

void run_for(Simulation& simulation, double seconds) {
  for (int i = std::lround(seconds / kStep); i > 0; --i) ASSERT_TRUE(simulation.step().converged);
}

TEST(ServoModes, SwitchingIsNoBump) {
  for (const char* scheme : {"em", "newmark"})
    for (const double sample_time : {0.0, 0.002})
      for (const bool is_elastic : {false, true}) {
        SceneBuilder b = block_on_rail();
        b.scene.integrator.scheme = scheme;
        b.scene.servos[0].sample_time = sample_time;
        if (is_elastic) {
          scene::DriveDescription& drive = b.drive("rail", 1, 0.3);
          drive.stiffness = 1e4;
          drive.damping = 40;
        }
        Simulation simulation(b.scene);
        run_for(simulation, 8);
        const double rest = simulation.position(0);
        EXPECT_NEAR(rest, 0.25 + (is_elastic ? kLoad / 1e4 : 0), 1e-6) << "where the integral has brought it";
        for (const Mode mode : {Mode::Velocity, Mode::Effort, Mode::Position, Mode::Effort, Mode::Velocity}) {
          simulation.switch_mode(0, mode);
          EXPECT_EQ(simulation.servo_mode(0), mode);
          for (int i = 0; i < 50; ++i) {
            ASSERT_TRUE(simulation.step().converged);
            EXPECT_NEAR(simulation.effort(0), -kLoad, 1e-4) << scheme << sample_time << is_elastic;
          }
          EXPECT_NEAR(simulation.position(0), rest, 1e-6) << scheme << sample_time << is_elastic;
        }
      }
}

/// The block with a servo in mode velocity at 1 m/s, to be run until the motion is steady.
SceneBuilder sliding_block(double position_ki) {
  SceneBuilder b = block_on_rail();
  b.scene.servos.clear();
  scene::ServoDescription& servo = b.servo("rail", 120, 0, 2200);
  servo.mode = Mode::Velocity;
  servo.set_point = TimeFunction(1.0);
  servo.other_modes.push_back({Mode::Position, 2200, 120, position_ki, 0});
  return b;
}

/// Exact motion after the switch to mode position, relative to the set point: 2 x'' + 120 x' + 2200 x + 12000 (int x
/// dt) = 120. The gains put the roots of block and servo at -10, -20 and -30/s. The block arrives with 1 m/s, and the
/// integral begins with kd v.
struct Braking {
  static double position(double t) {
    return 0.25 * std::exp(-10 * t) - 0.4 * std::exp(-20 * t) + 0.15 * std::exp(-30 * t);
  }
  static double velocity(double t) {
    return -2.5 * std::exp(-10 * t) + 8 * std::exp(-20 * t) - 4.5 * std::exp(-30 * t);
  }
  static double acceleration(double t) {
    return 25 * std::exp(-10 * t) - 160 * std::exp(-20 * t) + 135 * std::exp(-30 * t);
  }
};

/// Largest error of the motor's effort over 0.3 s of braking.
double error_of_braking(const std::string& scheme, double step, bool is_sampled) {
  SceneBuilder b = sliding_block(12000);
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.step = step;
  b.scene.servos[0].sample_time = is_sampled ? step : 0;
  Simulation simulation(b.scene);
  for (int i = std::lround(2 / step); i > 0; --i) EXPECT_TRUE(simulation.step().converged);
  EXPECT_NEAR(simulation.velocity(0), 1, 1e-6);
  const double start = simulation.position(0);
  simulation.switch_mode(0, Mode::Position);
  EXPECT_EQ(simulation.set_point(0), start);
  double largest = 0;
  for (int i = 1; i * step < 0.3; ++i) {
    EXPECT_TRUE(simulation.step().converged);
    const double t = i * step;
    const double mean = (Braking::velocity(t) - Braking::velocity(t - step)) / step;  // mean over the step
    const double effort = kMass * (scheme == "em" ? mean : Braking::acceleration(t)) - kLoad;
    if (i == 1 && is_sampled) {
      EXPECT_NEAR(simulation.effort(0), -kLoad, 1e-5) << "the first sample";
    }
    largest = std::max(largest, std::abs(simulation.effort(0) - effort));
  }
  EXPECT_NEAR(simulation.position(0) - start, Braking::position(0.3), 1e-3);
  return largest;
}

// The effort follows the exact solution without a jump of kd v = 120 N. The error is of second order in the step, of
// first order with a sampled servo.
TEST(ServoModes, SwitchingToPositionWhileItMovesIsNoBump) {
  for (const char* scheme : {"em", "newmark"}) {
    const double coarse = error_of_braking(scheme, 1e-3, false), fine = error_of_braking(scheme, 5e-4, false);
    EXPECT_LT(coarse, 120 * 0.03 * 0.03) << scheme << ": (30/s h)^2 of kd v";
    EXPECT_LT(fine, coarse / 3.5) << scheme;
    const double sampled = error_of_braking(scheme, 1e-3, true);
    EXPECT_LT(sampled, 120 * 2 * 0.03) << scheme << ": held for a step, rates of the step before";
    EXPECT_LT(error_of_braking(scheme, 5e-4, true), sampled / 1.8) << scheme;
  }
}

/// Largest rate at which the effort of a servo in the given mode changes in motion.
double rate_of_effort(const scene::ServoDescription& servo, Mode mode, double velocity, double acceleration) {
  if (mode == Mode::Effort) return 0;
  if (mode == Mode::Position)
    return servo.kp * std::abs(velocity) + servo.kd * std::abs(acceleration) + servo.ki * 0.01;  // errors below 1 cm
  return servo.other_modes[0].kp * std::abs(acceleration) + servo.other_modes[0].ki * 0.01;
}

// Switches an accelerated block between all pairs of modes. In the step of the switch, the effort may change only by
// what both laws change over a step in this motion.
TEST(ServoModes, NoPairOfModesHasABumpInMotion) {
  const double coarse = 1e-3;
  for (const char* scheme : {"em", "newmark"})
    for (const bool has_integral : {true, false})
      for (const double sample_time : {0.0, 0.002})
        for (const double delay : {0.0, 0.003})
          for (const bool is_elastic : {false, true}) {
            if (delay > 0 && sample_time == 0) continue;
            SceneBuilder b = block_on_rail();
            b.scene.integrator.scheme = scheme;
            b.scene.integrator.step = coarse;
            scene::ServoDescription& servo = b.scene.servos[0];
            servo.set_point = TimeFunction::parse("0.5*t^2");
            servo.sample_time = sample_time;
            servo.delay = delay;
            if (!has_integral) servo.ki = servo.other_modes[0].ki = 0;
            if (is_elastic) {
              scene::DriveDescription& drive = b.drive("rail", 1, 0.3);
              drive.stiffness = 1e4;
              drive.damping = 40;
            }
            Simulation simulation(b.scene);
            run_for(simulation, 1.5);
            Mode before = Mode::Position;
            for (const Mode mode :
                 {Mode::Velocity, Mode::Effort, Mode::Position, Mode::Effort, Mode::Velocity, Mode::Position}) {
              const double effort = simulation.effort(0), velocity = simulation.velocity(0);
              const double acceleration = (std::abs(effort) + kLoad) / kMass;
              const double held = std::max(sample_time, coarse) + delay;
              const double bound = 1.5 * held *
                                   (rate_of_effort(servo, before, velocity, acceleration) +
                                    rate_of_effort(servo, mode, velocity, acceleration));
              simulation.switch_mode(0, mode);
              for (int i = 0; i * coarse < 0.5 * held; ++i) {
                ASSERT_TRUE(simulation.step().converged);
                EXPECT_NEAR(simulation.effort(0), effort, bound + 1e-6)
                    << scheme << has_integral << sample_time << delay << is_elastic << to_string(before) << " to "
                    << to_string(mode);
              }
              run_for(simulation, 0.05);
              before = mode;
            }
          }
}

// Without an integral, the set point is chosen so that the effort is kept. So a block at rest stays where it is.
TEST(ServoModes, SwitchingWithoutAnIntegralMovesTheSetPoint) {
  SceneBuilder b = block_on_rail();
  b.scene.servos[0].ki = b.scene.servos[0].other_modes[0].ki = 0;
  Simulation simulation(b.scene);
  run_for(simulation, 8);
  const double rest = 0.25 + kLoad / 800;
  EXPECT_NEAR(simulation.position(0), rest, kRest);
  for (const Mode mode : {Mode::Velocity, Mode::Position, Mode::Effort, Mode::Position}) {
    simulation.switch_mode(0, mode);
    const double expected = mode == Mode::Velocity ? -kLoad / 60 : mode == Mode::Effort ? -kLoad : 0.25;
    EXPECT_NEAR(simulation.set_point(0), expected, 1e-4 * kLoad) << to_string(mode);
    run_for(simulation, 0.5);
    EXPECT_NEAR(simulation.effort(0), -kLoad, 1e-4) << to_string(mode);
    EXPECT_NEAR(simulation.position(0), rest, 1e-6) << to_string(mode);
  }
}

// A servo that is off has no effort that the other mode could take over.
TEST(ServoModes, SwitchedOffItTakesOverNothing) {
  for (const double ki : {0.0, 12000.0}) {
    Simulation simulation(sliding_block(ki).scene);
    run_for(simulation, 1);
    simulation.switch_servo(0, false);
    run_for(simulation, 0.1);
    const double position = simulation.position(0);
    simulation.switch_mode(0, Mode::Position);
    EXPECT_EQ(simulation.set_point(0), position);
    EXPECT_EQ(state_of(simulation).actuators[0].servo.integral, 0);
  }
}

// A commanded effort beyond the joint's limit counts with the value of the limit.
TEST(ServoModes, SwitchingIsNoBumpBesideACommandThatIsCut) {
  SceneBuilder b = block_on_rail();
  b.scene.joints[0].effort_limit = 4 * kLoad;
  b.scene.initial_joints.push_back({"rail", 0.25, 0, {}});
  Simulation simulation(b.scene);
  simulation.command_effort(0, -20 * kLoad);
  run_for(simulation, 8);
  const double rest = simulation.position(0), given = simulation.effort(0);
  for (const Mode mode : {Mode::Velocity, Mode::Effort, Mode::Position}) {
    simulation.switch_mode(0, mode);
    run_for(simulation, 0.1);
    EXPECT_NEAR(simulation.effort(0), given, 1e-4);
    EXPECT_NEAR(simulation.position(0), rest, 1e-6);
  }
}

TEST(ServoModes, EachTakesSetPointsOfItsOwn) {
  Simulation simulation(block_on_rail().scene);
  simulation.switch_mode(0, Mode::Velocity);
  simulation.command_set_point(0, 0.1);
  run_for(simulation, 3);
  EXPECT_NEAR(simulation.velocity(0), 0.1, kRest);
  const double begin = simulation.position(0);
  run_for(simulation, 1);
  EXPECT_NEAR(simulation.position(0) - begin, 0.1, kRest);
  simulation.switch_mode(0, Mode::Effort);
  simulation.command_set_point(0, 3 - kLoad);  // 3 N remain to accelerate the block
  const double rate = simulation.velocity(0);
  run_for(simulation, 1);
  EXPECT_NEAR(simulation.velocity(0) - rate, 3 / kMass, kRest);
  const double there = simulation.position(0);
  simulation.switch_mode(0, Mode::Position);
  EXPECT_EQ(simulation.set_point(0), there);
  run_for(simulation, 8);
  EXPECT_NEAR(simulation.position(0), there, 1e-6);
  simulation.switch_mode(0, Mode::Velocity);
  simulation.release_set_point(0);
  EXPECT_EQ(simulation.servo_mode(0), Mode::Position);
  run_for(simulation, 8);
  EXPECT_NEAR(simulation.position(0), 0.25, 1e-6) << "as the scene has it";
}

TEST(ServoModes, AreAPartOfTheState) {
  Simulation simulation(block_on_rail().scene), other(block_on_rail().scene);
  simulation.switch_mode(0, Mode::Velocity);
  simulation.command_set_point(0, 0.3, 0.2);
  run_for(simulation, 0.1);
  const std::string file = std::filesystem::temp_directory_path() / "flexarm_servo_modes_test";
  write_checkpoint(simulation, file);
  read_checkpoint(other, file);
  std::filesystem::remove(file);
  EXPECT_EQ(other.servo_mode(0), Mode::Velocity);
  EXPECT_TRUE(same_bits(state_of(simulation), state_of(other)));
  run_for(simulation, 0.1);
  run_for(other, 0.1);
  EXPECT_NEAR(simulation.position(0), other.position(0), kRest);
  other.reset();
  EXPECT_EQ(other.servo_mode(0), Mode::Position);
  State state = state_of(simulation);
  for (const double law : {3.0, -1.0, 0.5}) {
    state.actuators[0].servo.law = law;
    EXPECT_THROW(restore(other, state), std::invalid_argument) << law;
  }
  state.actuators[0].servo.law = 1;
  state.actuators[0].servo.set_point = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(restore(other, state), std::invalid_argument);
}

TEST(ServoModes, WithoutAServoOrGainsItIsSaidWhatToWrite) {
  SceneBuilder b = block_on_rail();
  b.scene.servos[0].other_modes.clear();
  Simulation simulation(b.scene);
  const State before = state_of(simulation);
  const auto told = [](Simulation& of, Mode mode) {
    return refusal<std::invalid_argument>([&] { of.switch_mode(0, mode); });
  };
  EXPECT_EQ(told(simulation, Mode::Velocity),
            "the servo of 'rail' has no gains of mode 'velocity': write <gains mode=\"velocity\" kp=\"...\"/> into its "
            "<servo>");
  EXPECT_TRUE(same_bits(before, state_of(simulation)));
  EXPECT_EQ(told(simulation, Mode::Effort), "");
  b.scene.servos.clear();
  Simulation without(b.scene);
  EXPECT_EQ(told(without, Mode::Effort),
            "joint coordinate 'rail' has no servo: write <servo joint=\"rail\" mode=\"...\" .../> into the scene");
  EXPECT_THROW(without.servo_mode(0), std::invalid_argument);
  EXPECT_THROW(without.set_point(0), std::invalid_argument);
}

// A set point that is a quadratic polynomial in time is described exactly by its value, rate and acceleration.
TEST(MovingSetPoints, DoWhatAFunctionOfTheSceneDoes) {
  const double c0 = 0.1, c1 = 0.2, c2 = 0.15;
  for (const char* scheme : {"em", "newmark", "hht1"})
    for (const double sample_time : {0.0, 0.004}) {
      SceneBuilder b = block_on_rail();
      b.scene.integrator.scheme = scheme;
      b.scene.servos[0].sample_time = sample_time;
      b.scene.servos[0].set_point = TimeFunction::parse("0.1+0.2*t+0.15*t^2");
      Simulation function(b.scene), commanded(b.scene);
      for (int n = 1; n <= 500; ++n) {
        const double t = n * kStep;
        commanded.command_set_point(0, c0 + t * (c1 + t * c2), c1 + 2 * c2 * t, 2 * c2);
        ASSERT_TRUE(function.step().converged);
        ASSERT_TRUE(commanded.step().converged);
        // Rates of functions are differences with an error of 1e-9, so efforts have an error of kd times that.
        ASSERT_NEAR(commanded.position(0), function.position(0), 1e-9) << scheme << sample_time << " " << n;
      }
      EXPECT_NEAR(commanded.set_point(0), c0 + 0.5 * (c1 + 0.5 * c2), 1e-15);
      run_for(commanded, 8);
      EXPECT_NEAR(commanded.position(0), c0 + 0.5 * (c1 + 0.5 * c2), 1e-6) << "it stays where the last one was";
    }
  Simulation simulation(block_on_rail().scene);
  EXPECT_THROW(simulation.command_set_point(0, 0.1, 1 / 0.0), std::invalid_argument);
  EXPECT_THROW(simulation.command_set_point(0, 0.1, 1, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace flexarm::test
