// Tests servos: continuous ones against closed forms and a reference integration, sampled ones against the stability
// limits of their difference equations.
#include <array>

#include "math/dense_eigenpairs.h"
#include "reference/one_coordinate_scenes.h"
#include "support/dense_solution.h"

namespace flexarm::test {
namespace {

scene::ServoDescription& add_servo(SceneBuilder& b, ServoMode mode, double kp, double kd = 0, double ki = 0) {
  scene::ServoDescription& servo = b.servo(b.scene.joints.front().name, kp, kd, ki);
  servo.mode = mode;
  return servo;
}

scene::DriveDescription& add_drive(SceneBuilder& b, double rotor_inertia) {
  return b.drive(b.scene.joints.front().name, 10, rotor_inertia / 100);
}

// Equation m q'' + kd q' + kp q = kp: a step of the set point.
TEST(Servo, PositionRespondsAsTheSecondOrderSystem) {
  const double kp = 60, kd = 8, rotor = 1, mass = kBlockMass + rotor;
  const double decay = kd / (2 * mass), omega = std::sqrt(kp / mass - decay * decay), end = 0.8;
  const double expected = 1 - std::exp(-decay * end) * (std::cos(omega * end) + decay / omega * std::sin(omega * end));
  for (const char* scheme : {"em", "m1", "edmc2", "newmark", "hht1", "hht3", "em4"}) {
    std::array<double, 2> error;
    for (const int k : {0, 1}) {
      SceneBuilder b = block_on_rail();
      add_drive(b, rotor);
      add_servo(b, ServoMode::Position, kp, kd).set_point = TimeFunction(1.0);
      const int steps = 100 << k;
      Simulation simulation(b.scene, options(scheme, end / steps, 1e-12));
      run(simulation, steps);
      error[k] = std::abs(simulation.position(0) - expected);
    }
    EXPECT_LT(error[1], 1e-3) << scheme;
    // At least second order; only the composed scheme with its continuous mean is better.
    EXPECT_GT(observed_order(error[0], error[1]), 1.85) << scheme;
  }
}

// Equation m v' = kp (w - v).
TEST(Servo, VelocityRespondsAsTheFirstOrderSystem) {
  const double kp = 6, wanted = 1.5, end = 0.5;
  const double expected = wanted * (1 - std::exp(-kp / kBlockMass * end));
  for (const char* scheme : {"em", "newmark"}) {
    std::array<double, 2> error;
    for (const int k : {0, 1}) {
      SceneBuilder b = block_on_rail();
      add_servo(b, ServoMode::Velocity, kp).set_point = TimeFunction(wanted);
      const int steps = 100 << k;
      Simulation simulation(b.scene, options(scheme, end / steps, 1e-12));
      run(simulation, steps);
      error[k] = std::abs(simulation.velocity(0) - expected);
    }
    EXPECT_LT(error[1], 1e-3) << scheme;
    EXPECT_GT(observed_order(error[0], error[1]), 1.85) << scheme;
  }
  // With an integral, a load causes no permanent error.
  SceneBuilder b = block_on_rail();
  add_servo(b, ServoMode::Velocity, 20, 0, 60).set_point = TimeFunction(wanted);
  b.load("block", Vector3::Zero(), {-30, 0, 0});
  Simulation simulation(b.scene, options("em", 1e-3));
  run(simulation, 5000);
  EXPECT_NEAR(simulation.velocity(0), wanted, 1e-6);
  EXPECT_NEAR(simulation.effort(0), 30, 1e-5);
}

/// Returns exp(matrix t) start.
Eigen::Vector4d evolved(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& start, double t) {
  const auto [rates, vectors] = dense_eigenpairs(matrix);
  const Eigen::VectorXcd parts = complex_solution(vectors, start.cast<std::complex<double>>());
  return (vectors * (rates * t).array().exp().matrix().cwiseProduct(parts)).real();
}

// A set point that jumps by J where a step ends strikes once: after sub-steps, too, whose times differ by round-off.
// The velocity kd J / m decays with kd / m, so that the block comes to J.
TEST(Servo, JumpsWhereStepsEndAreNotLost) {
  const double kd = 40, jump = 0.3;
  for (const char* scheme : {"em", "em4", "rk4"})
    for (int k = 10; k < 60; ++k) {
      SceneBuilder b = block_on_rail();
      add_servo(b, ServoMode::Position, 1e-12, kd).set_point =
          TimeFunction::parse("t < " + std::to_string(0.01 * k) + " ? 0 : 0.3");
      Simulation simulation(b.scene, options(scheme, 0.01, 1e-12));
      run(simulation, 100);
      const double left = std::exp(-kd / kBlockMass * (1 - 0.01 * k));
      // The step of the jump lags by its length or less.
      EXPECT_NEAR(simulation.position(0), jump * (1 - left), 0.02 * kd / kBlockMass * jump * left + 1e-4)
          << scheme << " " << k;
    }
}

// The servo measures either the motor's or the link's side of an elastic gear. On the link's side, the rotor is between
// the servo and the controlled coordinate.
TEST(Servo, OnEitherSideOfAnElasticGear) {
  const double kp = 60, kd = 8, rotor = 0.5, gear = 400, damping = 1, end = 0.6;
  for (const bool on_link : {false, true})
    for (const char* scheme : {"em", "newmark"}) {  // dampers of joints are of first order in hht*
      Eigen::Matrix4d matrix;                       // of {q, theta, q', theta'} relative to the set point
      const double on_q = on_link ? 1 : 0, on_theta = 1 - on_q;
      matrix << 0, 0, 1, 0,  //
          0, 0, 0, 1,        //
          -gear / kBlockMass, gear / kBlockMass, -damping / kBlockMass, damping / kBlockMass,
          (gear - kp * on_q) / rotor, -(gear + kp * on_theta) / rotor, (damping - kd * on_q) / rotor,
          -(damping + kd * on_theta) / rotor;
      const double expected = 1 + evolved(matrix, {-1, -1, 0, 0}, end)[0];
      std::array<double, 2> error;
      for (const int k : {0, 1}) {
        SceneBuilder b = block_on_rail();
        scene::DriveDescription& drive = add_drive(b, rotor);
        drive.stiffness = gear;
        drive.damping = damping;
        scene::ServoDescription& servo = add_servo(b, ServoMode::Position, kp, kd);
        servo.set_point = TimeFunction(1.0);
        if (on_link) servo.side = scene::ServoDescription::Side::Link;
        const int steps = 400 << k;
        Simulation simulation(b.scene, options(scheme, end / steps, 1e-12));
        run(simulation, steps);
        error[k] = std::abs(simulation.position(0) - expected);
      }
      EXPECT_LT(error[1], 1e-3) << scheme << on_link;
      EXPECT_GT(observed_order(error[0], error[1]), 1.8) << scheme << on_link;
    }
}

// A servo with a very large gain is stiff, and reaches its set point in a few steps without oscillation. (Without
// damping, gains that the steps resolve oscillate, as in continuous time.)
TEST(Servo, AnyGainIsStable) {
  for (const double kp : {1e8, 1e10, 1e12})
    for (const double kd : {0.0, 1e-3 * kp})
      for (const bool is_elastic : {false, true}) {
        SceneBuilder b = block_on_rail();
        scene::DriveDescription& drive = add_drive(b, 0.5);
        if (is_elastic) drive.stiffness = 1e4, drive.damping = 50;
        add_servo(b, ServoMode::Position, kp, kd);
        b.load("block", Vector3::Zero(), {50, 0, 0});
        Simulation simulation(b.scene, options("em", 1e-3));
        simulation.command_set_point(0, 0.3);
        run(simulation, 3000);
        const double bent = is_elastic ? 50 / 1e4 : 0;
        EXPECT_NEAR(simulation.position(0), 0.3 + 50 / kp + bent, 1e-6) << kp << " " << kd << is_elastic;
        EXPECT_NEAR(state_of(simulation).actuators[0].rate, 0, 1e-6) << kp << " " << kd << is_elastic;
        EXPECT_NEAR(simulation.effort(0), -50, kp < 1e12 ? 1e-3 : 1) << "to the digits of a position, times kp";
      }
}

/// Reference by a Runge-Kutta method with short steps: q'' = M/m, I' = e + (M - raw)/(ki T), where M is raw = kp e - kd
/// q' + ki I cut at the limit.
double reference_position(double kp, double kd, double ki, double limit, double tracking, double end) {
  using State = Eigen::Vector3d;  // q, q', I
  const auto rate = [&](const State& s) {
    const double error = 1 - s[0], raw = kp * error - kd * s[1] + ki * s[2], motor = std::clamp(raw, -limit, limit);
    return State(s[1], motor / kBlockMass, error + (tracking > 0 ? (motor - raw) / (ki * tracking) : 0.0));
  };
  State s = State::Zero();
  const int steps = 200000;
  const double h = end / steps;
  for (int n = 0; n < steps; ++n) {
    const State a = rate(s), b = rate(s + 0.5 * h * a), c = rate(s + 0.5 * h * b), d = rate(s + h * c);
    s += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return s[0];
}

TEST(Servo, SaturatesWithAndWithoutWindup) {
  const double kp = 40, kd = 12, ki = 80, limit = 6, end = 3;
  double position[2];
  for (const double tracking : {0.0, 0.2}) {
    const double expected = reference_position(kp, kd, ki, limit, tracking, end);
    std::array<double, 2> error;
    for (const int k : {0, 1}) {
      SceneBuilder b = block_on_rail();
      scene::ServoDescription& servo = add_servo(b, ServoMode::Position, kp, kd, ki);
      servo.set_point = TimeFunction(1.0);
      servo.effort_limit = limit;
      servo.anti_windup = tracking;
      const int steps = 1000 << k;
      Simulation simulation(b.scene, options("em", end / steps, 1e-12));
      run(simulation, steps, [&] { EXPECT_LE(std::abs(simulation.effort(0)), limit); });
      error[k] = std::abs(simulation.position(0) - expected);
      position[tracking > 0] = simulation.position(0);
    }
    EXPECT_LT(error[1], 1e-4) << tracking;
    EXPECT_GT(observed_order(error[0], error[1]), 1.5) << "kinks lie anywhere in a step: " << tracking;
  }
  EXPECT_GT(std::abs(position[0] - 1), 3 * std::abs(position[1] - 1)) << "wound up it is farther off";
}

// Equation m v' = -K w, held over T, where w is the difference quotient of positions at the last sample. With x = K
// T/m, the roots of z^2 + (x/2 - 1) z + x/2 leave the unit circle at x = 2. With a delay of T, the roots of z^3 - z^2 +
// x (z + 1)/2 leave it at x = 2 (sqrt(2) - 1).
TEST(Servo, SampledHasTheStabilityLimitOfItsDifferenceEquation) {
  const double period = 0.004;
  for (const bool is_late : {false, true}) {
    const double limit = is_late ? 2 * (std::sqrt(2) - 1) : 2.0;
    for (const char* scheme : {"em", "m1"})
      for (const double part : {0.97, 1.03}) {
        SceneBuilder b = block_on_rail(0, 1);
        scene::ServoDescription& servo = add_servo(b, ServoMode::Velocity, part * limit * kBlockMass / period);
        servo.sample_time = period;
        servo.delay = is_late ? period : 0;
        Simulation simulation(b.scene, options(scheme, 0.001));
        double early = 0, late = 0;
        int n = 0;
        run(simulation, 4000, [&] {
          ++n;
          double& largest = n < 400 ? early : late;
          if (n < 400 || n > 3600) largest = std::max(largest, std::abs(state_of(simulation).actuators[0].rate));
        });
        if (part < 1)
          EXPECT_LT(late, 1e-2 * early) << scheme << is_late;
        else
          EXPECT_GT(late, 1e2 * early) << scheme << is_late;
      }
  }
}

// A delay that is no multiple of the step splits the step.
TEST(Servo, SampledOutputsActAfterTheirDelay) {
  SceneBuilder b = block_on_rail();
  scene::ServoDescription& servo = add_servo(b, ServoMode::Effort, 0);
  servo.set_point = TimeFunction(4.0);
  servo.sample_time = 0.01;
  servo.delay = 0.0175;
  Simulation simulation(b.scene, options("em", 0.005));
  run(simulation, 10);
  EXPECT_NEAR(simulation.velocity(0), 4 * (0.05 - 0.0175) / kBlockMass, 1e-12);
  EXPECT_DOUBLE_EQ(simulation.effort(0), 4);
}

TEST(Servo, WorkIsInTheAccount) {
  for (const double sample_time : {0.0, 0.004}) {
    SceneBuilder b = block_on_rail(0.2, -1);
    scene::DriveDescription& drive = add_drive(b, 0.5);
    drive.stiffness = 900;
    drive.damping = 3;
    drive.backlash = 0.01;
    drive.effort_limit = 40;
    drive.velocity_limit = 3;
    scene::ServoDescription& servo = add_servo(b, ServoMode::Position, 200, 20, 100);
    servo.set_point = TimeFunction::parse("0.3*sin(5*t)");
    servo.feedforward = TimeFunction::parse("cos(3*t)");
    servo.anti_windup = 0.1;
    servo.sample_time = sample_time;
    servo.delay = sample_time;
    Simulation simulation(b.scene, full_newton(options("em", 1e-3, 1e-13)));
    InvariantDrift drift(simulation);
    run(simulation, 3000, [&] {
      drift.observe();
      ASSERT_LT(drift.energy(), 1e-10);
    });
    EXPECT_NEAR(simulation.position(0), 0.3 * std::sin(15), 0.15) << "follows it";
  }
}

// A cubic trajectory gives the same motion as its formula: the set point and, if the scheme uses it, its rate.
TEST(Servo, FollowsATrajectoryAsTheFormula) {
  const TimeFunction formula = TimeFunction::parse("t < 0 ? 0 : t*t*(3-2*t)");
  const TimeFunction trajectory = TimeFunction::spline({0, 0.3, 1}, {0, 0.216, 1}, {0, 1.26, 0});
  // Derivatives of formulas are differences with an error of eps^(2/3). The position error follows as kd / kp times
  // that.
  const double tolerance = 4 * std::pow(std::numeric_limits<double>::epsilon(), 2.0 / 3.0);
  for (const char* scheme : {"em", "newmark"})
    for (const double sample_time : {0.0, 0.004}) {
      std::vector<std::vector<double>> positions(2);
      for (const int k : {0, 1}) {
        SceneBuilder b = block_on_rail();
        scene::ServoDescription& servo = add_servo(b, ServoMode::Position, 4000, 200);
        servo.set_point = k == 0 ? formula : trajectory;
        servo.sample_time = sample_time;
        Simulation simulation(b.scene, options(scheme, 1e-3, 1e-13));
        run(simulation, 900, [&] { positions[k].push_back(simulation.position(0)); });
      }
      for (std::size_t n = 0; n < positions[0].size(); ++n)
        ASSERT_NEAR(positions[0][n], positions[1][n], tolerance) << scheme << sample_time << " " << n;
      EXPECT_NEAR(positions[1].back(), formula(0.9), 1e-2) << "follows it";
    }
}

TEST(Servo, TakesCommands) {
  SceneBuilder b = block_on_rail(0.1);
  add_servo(b, ServoMode::Position, 1e3, 100);
  Simulation simulation(b.scene, options("em", 1e-3));
  EXPECT_TRUE(simulation.has_servo(0));
  run(simulation, 100);
  EXPECT_NEAR(simulation.position(0), 0.1, 1e-12) << "holds where it starts";
  simulation.command_set_point(0, 0.4);
  run(simulation, 2000);
  EXPECT_NEAR(simulation.position(0), 0.4, 1e-6);
  simulation.release_set_point(0);
  run(simulation, 2000);
  EXPECT_NEAR(simulation.position(0), 0.1, 1e-6);
  EXPECT_THROW(simulation.command_set_point(0, std::nan("")), std::invalid_argument);
  Simulation without(block_on_rail().scene);
  EXPECT_FALSE(without.has_servo(0));
  EXPECT_THROW(without.command_set_point(0, 1), std::invalid_argument);
}

// While the servo is off, its motor gives no effort for any command. When it is on again, its integral is empty.
TEST(Servo, SwitchedOffItsMotorGivesNothing) {
  const double kp = 400, kd = 30, ki = 5000, step = 1e-3;
  for (const char* scheme : {"em", "newmark"})
    for (const double sample_time : {0.0, 0.004}) {
      SceneBuilder b = block_on_rail(0.1, 0.5);
      scene::ServoDescription& servo = add_servo(b, ServoMode::Position, kp, kd, ki);
      servo.set_point = TimeFunction(1.0);
      servo.sample_time = sample_time;
      Simulation simulation(b.scene, options(scheme, step));
      simulation.switch_servo(0, false);
      simulation.command_effort(0, 3);
      run(simulation, 10);  // in the first step, Newmark's rule still has the acceleration of the start
      const double begin = simulation.position(0), velocity = simulation.velocity(0);
      run(simulation, 990, [&] { ASSERT_EQ(simulation.effort(0), 0); });
      EXPECT_NEAR(simulation.position(0), begin + 990 * step * velocity, 1e-10) << scheme;
      EXPECT_TRUE(simulation.natural_modes(1)[0].is_free()) << scheme;
      const Snapshot off = simulation.snapshot();
      simulation.release_command(0);
      simulation.switch_servo(0, true);
      run(simulation, 12);
      // kp e - kd v, plus the integral over 12 steps, and the changes of position and velocity in them.
      const double error = 1 - begin - 990 * step * velocity;
      EXPECT_NEAR(simulation.effort(0), kp * error - kd * velocity, 12 * step * (ki * error + kp * 1 + kd * 100))
          << scheme << sample_time;
      EXPECT_GT(std::abs(simulation.effort(0)), 20) << scheme << sample_time;
      simulation.restore(off);
      run(simulation, 10);
      EXPECT_EQ(simulation.effort(0), 0) << "off is a part of the state";
      simulation.reset();
      run(simulation, 10);
      EXPECT_GT(simulation.effort(0), 50) << "as the scene has it";
    }
  Simulation without(block_on_rail().scene);
  EXPECT_THROW(without.switch_servo(0, false), std::invalid_argument);
}

TEST(Servo, HoldsInStatics) {
  for (const bool is_elastic : {false, true}) {
    SceneBuilder b = block_on_rail(0.1);
    scene::DriveDescription& drive = add_drive(b, 0.5);
    if (is_elastic) drive.stiffness = 300;
    add_servo(b, ServoMode::Position, 200, 10).set_point = TimeFunction(0.2);
    b.load("block", Vector3::Zero(), {6, 0, 0});
    Simulation simulation(b.scene);
    ASSERT_TRUE(simulation.solve_static(1).converged);
    EXPECT_NEAR(simulation.position(0), 0.2 + 6 / 200.0 + (is_elastic ? 6 / 300.0 : 0), 1e-12);
    run(simulation, 20);
    EXPECT_NEAR(simulation.velocity(0), 0, 1e-9) << "at rest there";
  }
}

}  // namespace
}  // namespace flexarm::test
