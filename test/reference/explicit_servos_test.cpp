// Tests servos and motors with limits under explicit schemes, against closed forms.
#include <cmath>

#include "reference/explicit_runs.h"
#include "reference/one_coordinate_scenes.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

class ExplicitServos : public ExplicitRuns {
 protected:
  /// Expects errors to fall with the order of the method. `expected`: position and velocity at `end`.
  void expect_order(const SceneBuilder& b, double end, const Eigen::Vector2d& expected) const {
    double errors[2];
    for (const int k : {0, 1}) {
      const Simulation s = after(b, end, static_cast<int>(GetParam().steps * end) << k);
      errors[k] = std::hypot(s.position(0) - expected[0], s.velocity(0) - expected[1]);
    }
    EXPECT_GT(errors[1], 1e-14);
    EXPECT_NEAR(observed_order(errors[0], errors[1]), GetParam().order, 0.5) << errors[0] << " " << errors[1];
  }
};

scene::ServoDescription& servo_on(SceneBuilder& b, ServoMode mode, double kp, double kd = 0, double ki = 0) {
  scene::ServoDescription& servo = b.servo(b.scene.joints.front().name, kp, kd, ki);
  servo.mode = mode;
  return servo;
}

// I''' m + kd I'' + kp I' + ki I = 0 for the integral I of the error, with I = 0, I' = S, I'' = 0 at the start. The
// gains give the poles -a and -b +- i c.
TEST_P(ExplicitServos, HoldASetPoint) {
  const double a = 3, b = 2, c = 7, set = 0.8, end = 1;
  SceneBuilder scene = block_on_rail();
  servo_on(scene, ServoMode::Position, kBlockMass * (b * b + c * c + 2 * a * b), kBlockMass * (a + 2 * b),
           kBlockMass * a * (b * b + c * c))
      .set_point = TimeFunction(set);
  Matrix3 start;
  start << 1, 1, 0, -a, -b, c, a * a, b * b - c * c, -2 * b * c;
  const Vector3 parts = start.inverse() * Vector3(0, set, 0);
  const std::complex<double> pole(-b, c), phase = parts[1] - std::complex<double>(0, 1) * parts[2];
  const auto derivative = [&](int n) {  // of I
    return parts[0] * std::pow(-a, n) * std::exp(-a * end) + (phase * std::pow(pole, n) * std::exp(pole * end)).real();
  };
  expect_order(scene, end, {set - derivative(1), -derivative(2)});
}

// I'' + (kp/m) I' + (ki/m) I = s' for the integral I of the error of the velocity, with s = sin(w t).
TEST_P(ExplicitServos, FollowAVelocity) {
  const double b = 2, c = 6, w = 4, end = 1;
  SceneBuilder scene = block_on_rail();
  servo_on(scene, ServoMode::Velocity, kBlockMass * 2 * b, 0, kBlockMass * (b * b + c * c)).set_point =
      TimeFunction::parse("sin(4*t)");
  const std::complex<double> i(0, 1), forced = w / (b * b + c * c - w * w + 2 * b * w * i), pole(-b, c);
  const double at_start = -forced.real(), rate = -(i * w * forced).real();
  const std::complex<double> free = at_start - i * (rate + b * at_start) / c;
  const auto integral = [&](int n) {  // its derivative
    return (forced * std::pow(i * w, n) * std::exp(i * w * end) + free * std::pow(pole, n) * std::exp(pole * end))
        .real();
  };
  const double way = (1 - std::cos(w * end)) / w - integral(0), velocity = std::sin(w * end) - integral(1);
  expect_order(scene, end, {way, velocity});
}

// A motor on its torque-speed line: m v' = F (1 - v / V).
TEST_P(ExplicitServos, RunUpOnTheTorqueSpeedLine) {
  const double force = 24, speed = 0.9, time = kBlockMass * speed / force, end = 0.5;
  SceneBuilder scene = block_on_rail();
  scene::DriveDescription& drive = scene.drive("rail", 1, 0);
  drive.effort_limit = force;
  drive.velocity_limit = speed;
  scene.scene.efforts.push_back({"rail", TimeFunction(1e3), {}});
  const double lag = std::exp(-end / time);
  expect_order(scene, end, {speed * (end - time * (1 - lag)), speed * (1 - lag)});
}

// At a limit L of the effort the block moves by a t^2 / 2, a = L/m, and the integral I follows:
// I' = e - (kp e + kd e' + ki I - L) / (ki T).
TEST_P(ExplicitServos, FollowALimitedEffort) {
  const double kp = 40, kd = 3, ki = 20, set = 5, limit = 4, lag = 0.2, end = 0.5, a = limit / kBlockMass;
  SceneBuilder scene = block_on_rail();
  scene::ServoDescription& servo = servo_on(scene, ServoMode::Position, kp, kd, ki);
  servo.set_point = TimeFunction(set);
  servo.effort_limit = limit;
  servo.anti_windup = lag;
  const double share = 1 - kp / (ki * lag);
  const double g0 = set * share + limit / (ki * lag), g1 = kd * a / (ki * lag), g2 = -0.5 * a * share;
  const double p2 = g2 * lag, p1 = (g1 - 2 * p2) * lag, p0 = (g0 - p1) * lag;
  const double expected = p0 + p1 * end + p2 * end * end - p0 * std::exp(-end / lag);
  double errors[2];
  for (const int k : {0, 1}) {
    const Simulation s = after(scene, end, (GetParam().steps / 4) << k);
    EXPECT_NEAR(s.position(0), 0.5 * a * end * end, 1e-13);
    EXPECT_NEAR(s.effort(0), limit, 1e-13);
    EXPECT_NEAR(s.energies().work, limit * s.position(0), 1e-12);
    errors[k] = std::abs(state_of(s).actuators[0].servo.integral - expected);
  }
  EXPECT_NEAR(observed_order(errors[0], errors[1]), GetParam().order, 0.6) << errors[0] << " " << errors[1];
}

// Where a set point jumps by J, the derivative strikes with kd J, and the velocity decays with kd/m.
TEST_P(ExplicitServos, AreStruckByAJump) {
  const double kd = 10, jump = 0.3, begin = 0.5, end = 1, gain = 1e-9;
  SceneBuilder scene = block_on_rail();
  servo_on(scene, ServoMode::Position, gain, kd).set_point = TimeFunction::parse("t < 0.5 ? 0 : 0.3");
  const double lag = std::exp(-kd / kBlockMass * (end - begin)), velocity = kd * jump / kBlockMass;
  const Simulation s = after(scene, end, 40);  // a step ends at the jump, up to round-off of times
  // For the order 4: (kd h/m)^4 / 5! in each of the times m/kd, of the velocity and, twice that, of the energy.
  const double tolerance = GetParam().order == 4 ? 1e-5 : 1e-8;
  EXPECT_NEAR(s.velocity(0), velocity * lag, tolerance);
  EXPECT_NEAR(s.position(0), jump * (1 - lag), tolerance);
  const Energies energies = s.energies();
  EXPECT_NEAR(energies.total() - energies.work, 0, kBlockMass * velocity * velocity * tolerance);
  // Within a step: to the order of the step.
  const Simulation within = after(scene, end, 41);
  EXPECT_NEAR(within.position(0), jump * (1 - lag), velocity / 41);
  EXPECT_NEAR(within.velocity(0), velocity * lag, velocity * kd / kBlockMass / 41);
}

// A sampled servo holds its effort, so that the motion is a parabola between samples.
TEST_P(ExplicitServos, HoldTheirSamples) {
  const double kp = 90, kd = 12, ki = 30, period = 0.05;
  SceneBuilder scene = block_on_rail();
  scene::ServoDescription& servo = servo_on(scene, ServoMode::Position, kp, kd, ki);
  servo.set_point = TimeFunction::parse("0.4*sin(3*t)");
  servo.sample_time = period;
  Simulation s(scene.scene, options(GetParam().name, period / 5, 1e-12));
  double x = 0, v = 0, before = 0, integral = 0;
  for (int n = 0; n < 20; ++n) {
    const double time = n * period, set = 0.4 * std::sin(3 * time), last = 0.4 * std::sin(3 * (time - period));
    integral += period * (set - x);
    const double effort = kp * (set - x) + kd * ((set - last) - (x - before)) / period + ki * integral;
    before = x;
    x += period * v + 0.5 * period * period * effort / kBlockMass;
    v += period * effort / kBlockMass;
    run(s, 5);
    ASSERT_NEAR(s.effort(0), effort, 1e-11) << n;
    ASSERT_NEAR(s.position(0), x, 1e-13) << n;
    ASSERT_NEAR(s.velocity(0), v, 1e-12) << n;
  }
}

// Commands act from the next step on; a servo that is off gives no effort.
TEST_P(ExplicitServos, ObeyCommands) {
  const double kp = 50, rate = std::sqrt(kp / kBlockMass);
  SceneBuilder scene = block_on_rail();
  servo_on(scene, ServoMode::Position, kp).set_point = TimeFunction(0.0);
  Simulation s(scene.scene, options(GetParam().name, 1e-3, 1e-12));
  s.command_set_point(0, 0.2);
  run(s, 200);
  const double x = 0.2 * (1 - std::cos(0.2 * rate)), v = 0.2 * rate * std::sin(0.2 * rate);
  EXPECT_NEAR(s.position(0), x, 1e-11);  // (rate h)^4 / 5! of the amplitude
  EXPECT_NEAR(s.velocity(0), v, 1e-10);
  s.switch_servo(0, false);
  run(s, 100);
  EXPECT_EQ(s.effort(0), 0);
  EXPECT_NEAR(s.position(0), x + 0.1 * v, 1e-10);
  s.switch_servo(0, true);
  s.switch_mode(0, ServoMode::Effort);
  s.command_set_point(0, 3);
  run(s, 100);
  EXPECT_EQ(s.effort(0), 3);
  EXPECT_NEAR(s.velocity(0), v + 0.1 * 3 / kBlockMass, 1e-10);
}

// A new law begins with the effort that the motor gave, by its integral. That changes by h (kp v + kd a) in a step.
TEST_P(ExplicitServos, SwitchTheirLawWithoutAJump) {
  const double kp = 50, kd = 6, step = 1e-4;
  SceneBuilder scene = block_on_rail();
  scene::ServoDescription& servo = servo_on(scene, ServoMode::Velocity, kd, 0, kp);
  servo.set_point = TimeFunction(0.8);
  servo.other_modes.push_back({ServoMode::Position, kp, kd, 30});
  Simulation s(scene.scene, options(GetParam().name, step, 1e-12));
  run(s, 1000);
  const double before = s.effort(0), change = step * (kp * s.velocity(0) + kd * before / kBlockMass);
  s.switch_mode(0, ServoMode::Position);
  run(s, 1);
  EXPECT_NEAR(s.effort(0), before - change, 0.1 * change);
}

TEST_P(ExplicitServos, GoOnFromARestoredStateBitByBit) {
  for (const double sample_time : {0.0, 0.02}) {
    SceneBuilder scene = block_on_rail();
    scene::ServoDescription& servo = servo_on(scene, ServoMode::Position, 60, 5, 10);
    servo.set_point = TimeFunction::parse("0.3*sin(5*t)");
    servo.sample_time = sample_time;
    Simulation s = without_memory(scene);
    run(s, 7);
    const Snapshot middle = s.snapshot();
    run(s, 9);
    const double position = s.position(0), velocity = s.velocity(0);
    s.restore(middle);
    run(s, 9);
    EXPECT_EQ(s.position(0), position);
    EXPECT_EQ(s.velocity(0), velocity);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitServos, kExplicitMethods, method_name);

}  // namespace
}  // namespace flexarm::test
