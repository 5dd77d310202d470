// Tests elastic gears, with play, friction and gyroscopic rotors, under explicit schemes.
#include <cmath>

#include <Eigen/Eigenvalues>

#include "reference/explicit_runs.h"
#include "reference/one_coordinate_scenes.h"

namespace flexarm::test {
namespace {

class ExplicitDrives : public ExplicitRuns {
 protected:
  /// Expects error(simulation at `end`) to fall with `order` from `steps` to twice as many.
  template <class Error>
  void expect_order(const SceneBuilder& b, double end, int steps, double order, const Error& error) const {
    const double coarse = error(after(b, end, steps)), fine = error(after(b, end, 2 * steps));
    EXPECT_GT(fine, 1e-14);
    EXPECT_GT(observed_order(coarse, fine), order - 0.5) << coarse << " " << fine;
    EXPECT_LT(observed_order(coarse, fine), order + 1) << coarse << " " << fine << ": terms of higher order are left";
  }
};

constexpr double kRotor = 0.1, kGearStiffness = 9.0;  // kg m^2, N m/rad

/// A wheel behind an elastic gear.
SceneBuilder geared_wheel(double damping, double velocity = 0) {
  SceneBuilder b = wheel_on_shaft(velocity);
  scene::DriveDescription& drive = b.drive("shaft", 1, kRotor);
  drive.stiffness = kGearStiffness;
  drive.damping = damping;
  return b;
}

// A constant effort M moves the centre of inertia by M t^2 / 2 (J + I). The twist is a damped oscillation about
// M / (J w^2), with w^2 = k (1/J + 1/I).
TEST_P(ExplicitDrives, TwistAGear) {
  const double motor = 2, damping = 0.1, end = 1, sum = kRotor + kWheelInertia;
  const double mobility = 1 / kRotor + 1 / kWheelInertia, delta = 0.5 * damping * mobility;
  const double rest = motor / kRotor / (kGearStiffness * mobility),
               w = std::sqrt(kGearStiffness * mobility - delta * delta);
  SceneBuilder b = geared_wheel(damping);
  b.scene.efforts.push_back({"shaft", TimeFunction(motor), {}});
  const double decay = std::exp(-delta * end), sine = std::sin(w * end), cosine = std::cos(w * end);
  const double twist = rest * (1 - decay * (cosine + delta / w * sine)),
               rate = rest * decay * (w + delta * delta / w) * sine;
  const double position = 0.5 * motor * end * end / sum - kRotor * twist / sum,
               velocity = motor * end / sum - kRotor * rate / sum;
  expect_order(b, end, static_cast<int>(GetParam().steps * end), GetParam().order, [&](const Simulation& s) {
    const ActuatorState& rotor = state_of(s).actuators[0];
    const Energies energies = s.energies();
    EXPECT_EQ(s.effort(0), motor);
    EXPECT_NEAR(energies.work, motor * rotor.angle, 1e-12);
    return std::hypot(s.position(0) - position, s.velocity(0) - velocity) +
           std::hypot(rotor.angle - position - twist, rotor.rate - velocity - rate) + std::abs(energy_account(s));
  });
}

/// exp(matrix) of a matrix whose eigenvalues are distinct.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& matrix) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> parts(matrix.cast<std::complex<double>>());
  const Eigen::MatrixXcd& vectors = parts.eigenvectors();
  return (vectors * parts.eigenvalues().array().exp().matrix().asDiagonal() * vectors.inverse()).real();
}

// A servo measures the rotor or the wheel, and always moves the rotor. Its set point jumps in the middle, where the
// derivative strikes the rotor. The equations are linear: {q, theta, q', theta', I} about the set point.
TEST_P(ExplicitDrives, FollowAServoOnEitherSide) {
  const double kp = 4, kd = 0.5, ki = 3, first = 0.3, second = 0.7, end = 1, damping = 0.1;
  for (const bool on_link : {false, true}) {
    SceneBuilder b = geared_wheel(damping);
    scene::ServoDescription& servo = b.servo("shaft", kp, kd, ki);
    servo.set_point = TimeFunction::parse("t < 0.5 ? 0.3 : 0.7");
    if (on_link) servo.side = scene::ServoDescription::Side::Link;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(5, 5);
    system(0, 2) = system(1, 3) = 1;
    system.row(2) << -kGearStiffness, kGearStiffness, -damping, damping, 0;
    system.row(3) = -system.row(2);
    const int measured = on_link ? 0 : 1;
    system(3, measured) -= kp, system(3, measured + 2) -= kd, system(3, 4) += ki;
    system.row(2) /= kWheelInertia, system.row(3) /= kRotor;
    system(4, measured) = -1;
    const Eigen::MatrixXd half = exponential(0.5 * end * system);
    Eigen::VectorXd x(5);
    x << -first, -first, 0, 0, 0;
    x = half * x;
    x.head<2>().array() -= second - first;
    x[3] += kd * (second - first) / kRotor;
    x = half * x;
    expect_order(b, end, static_cast<int>(GetParam().steps * end), GetParam().order, [&](const Simulation& s) {
      const ActuatorState& rotor = state_of(s).actuators[0];
      Eigen::VectorXd now(5);
      now << s.position(0) - second, rotor.angle - second, s.velocity(0), rotor.rate, rotor.servo.integral;
      return (now - x).norm() + std::abs(energy_account(s));
    });
  }
}

// Within the play the motor accelerates the rotor alone. At t = 1/4, when the gear has closed, an oscillation begins.
TEST_P(ExplicitDrives, CloseThePlay) {
  const double motor = 2, end = 0.5, mobility = 1 / kRotor + 1 / kWheelInertia,
               w = std::sqrt(kGearStiffness * mobility);
  const double closed = 0.25, hit = motor / kRotor * closed, rest = motor / kRotor / (w * w), t = end - closed;
  SceneBuilder b = geared_wheel(0);
  b.scene.drives[0].backlash = motor / kRotor * closed * closed;
  b.scene.efforts.push_back({"shaft", TimeFunction(motor), {}});
  const double beyond = rest * (1 - std::cos(w * t)) + hit / w * std::sin(w * t),
               rate = rest * w * std::sin(w * t) + hit * std::cos(w * t);
  const double twist = 0.5 * b.scene.drives[0].backlash + beyond, sum = kRotor + kWheelInertia;
  const double position = (0.5 * motor * end * end - kRotor * twist) / sum,
               velocity = (motor * end - kRotor * rate) / sum;
  const auto error = [&](const Simulation& s) {
    const Energies energies = s.energies();
    return std::hypot(s.position(0) - position, s.velocity(0) - velocity) + std::abs(energies.total() - energies.work);
  };
  // A step ends where the gear closes: the order of the method.
  expect_order(b, end, static_cast<int>(GetParam().steps * end), GetParam().order, error);
  // It closes in the middle of a step, and at the same place of a step a quarter as long: at least second order.
  const double coarse = error(after(b, end, 25)), fine = error(after(b, end, 101));
  EXPECT_GT(std::log(coarse / fine) / std::log(101.0 / 25), 1.5) << coarse << " " << fine;
  EXPECT_LT(coarse, 0.5 * kGearStiffness / kRotor * hit * std::pow(end / 25, 2));
}

// A motor moves a wheel to and fro in the play of its gear, which has a damper d: its effort jumps by d v where it
// closes or opens with the speed v of about 1. Angles at 0.4 and 0.8 s are those of scipy, which finds these times
// (docs/notes/accuracy.md 7); later ones depend on them too much.
TEST_P(ExplicitDrives, RattleInThePlay) {
  const double inertia = 0.35, damping = 1, end = 0.8, step = 1e-4, expected[] = {0.202694884, 0.649019776};
  SceneBuilder b;
  b.body("wheel", 1, Vector3::Zero(), inertia * Matrix3::Identity());
  b.joint("shaft", scene::JointKind::Continuous, "world", "wheel");
  scene::DriveDescription& drive = b.drive("shaft", 60, 3e-5);
  drive.stiffness = 2000, drive.damping = damping, drive.backlash = 0.05;
  b.scene.efforts.push_back({"shaft", TimeFunction::parse("2*sin(6*t)"), {}});
  Simulation s(b.scene, options(GetParam().name, step, 1e-12));
  constexpr int kTimes = 14;  // that it closes or opens
  for (const double sine : expected) {
    run(s, 4000);
    // Each time the momentum has an error of half a step's impulse.
    EXPECT_NEAR(std::sin(s.position(0)), sine, kTimes * 0.5 * damping * step / inertia * end);
  }
}

// Friction of the rotor F and of the gear mu |S| while the motor drives: once the gear has settled, the wheel is
// accelerated by (M - F) / (J + I (1 + mu)).
TEST_P(ExplicitDrives, LoseEffortInGearAndMotor) {
  const double motor = 2, friction = 0.3, efficiency = 0.8;
  SceneBuilder b = geared_wheel(2.0, 1.0);  // at rest smooth friction is stiff
  b.scene.drives[0].friction = friction;
  b.scene.drives[0].efficiency = efficiency;
  b.scene.efforts.push_back({"shaft", TimeFunction(motor), {}});
  Simulation s(b.scene, options(GetParam().name, 5e-3, 1e-12));
  const double start = energy_account(s);
  run(s, 800);
  const double before = s.velocity(0);
  run(s, 200);
  EXPECT_NEAR(s.velocity(0) - before, (motor - friction) / (kRotor + kWheelInertia / efficiency), 1e-9);
  EXPECT_GT(s.energies().dissipated, 1);
  EXPECT_NEAR(energy_account(s), start, 1e-5 * s.energies().work);
}

/// A top on a ball joint whose wheel spins about the axis z of the housing. With `is_rotor`, most of the wheel's axial
/// inertia belongs to a rotor behind an elastic gear.
SceneBuilder spinning_top(bool is_rotor) {
  const double axial = 0.02, small = 1e-3;
  SceneBuilder b;
  b.scene.gravity = {0, 0, -kGravity};
  b.body("housing", 0.8, {0, 0, 0.3}, Vector3(0.01, 0.012, 0.008).asDiagonal());
  b.joint("ball", scene::JointKind::Spherical, "world", "housing");
  b.body("wheel", 0.5, {0, 0, 0}, Vector3(0.006, 0.006, is_rotor ? small : axial).asDiagonal());
  b.joint("shaft", scene::JointKind::Revolute, "housing", "wheel", {0, 0, 0.4}, {0, 0, 1});
  initial_joint(b, "ball/ry", 0.5, 0);
  initial_joint(b, "shaft", 0, 60);
  if (is_rotor) {
    scene::DriveDescription& drive = b.drive("shaft", 1, axial - small);
    drive.axis = Vector3::UnitZ();
    drive.stiffness = 0.2;
  }
  return b;
}

// Wheel and rotor keep their axial momenta, so the gear is never twisted, and the top moves as that with a wheel.
TEST_P(ExplicitDrives, PrecessWithASpinningRotor) {
  const double end = 2;
  Simulation body(spinning_top(false).scene, options("dop853", 1e-3, 1e-12));
  const Quaternion start = body.link_pose(1).orientation;
  run(body, 2000);
  EXPECT_GT(body.link_pose(1).orientation.angularDistance(start), 0.1) << "it precesses";
  const int steps = GetParam().order == 4 ? 200 : 32;
  expect_order(spinning_top(true), end, steps, GetParam().order, [&](const Simulation& s) {
    EXPECT_NEAR(state_of(s).actuators[0].angle, s.position(*s.find_coordinate("shaft")), 1e-6);
    return s.link_pose(1).orientation.angularDistance(body.link_pose(1).orientation);
  });
}

// In free flight energy account and angular momentum are kept to the order of the method, while motors twist the gears
// of rotors with axes and gear ratios.
TEST_P(ExplicitDrives, KeepMomentumAndAccountInFreeFlight) {
  SceneBuilder b;
  b.body("frame", 1.5, {0.05, 0.02, 0}, Vector3(0.03, 0.05, 0.06).asDiagonal());
  b.joint("flight", scene::JointKind::Floating, "world", "frame");
  b.body("arm", 0.7, {0.2, 0, 0}, Vector3(0.004, 0.02, 0.02).asDiagonal());
  b.joint("shoulder", scene::JointKind::Revolute, "frame", "arm", {0.1, 0, 0}, {0, 1, 0});
  b.body("hand", 0.4, {0.1, 0.03, 0}, Vector3(2e-3, 3e-3, 2e-3).asDiagonal());
  b.joint("elbow", scene::JointKind::Revolute, "arm", "hand", {0.5, 0, 0}, {0, 0.6, 0.8});
  for (const char* joint : {"shoulder", "elbow"}) {
    scene::DriveDescription& drive = b.drive(joint, 3, 2e-3);
    drive.axis = Vector3(0.6, 0, 0.8);
    drive.stiffness = 20;
    drive.damping = 0.05;
  }
  b.servo("elbow", 5, 0.1).set_point = TimeFunction::parse("t < 0.25 ? 0 : 0.5");
  initial_field(b, "frame", {0, 0, 0}, {1, -2, 3});
  b.scene.efforts.push_back({"shoulder", TimeFunction::parse("3*sin(9*t)"), {}});
  const Simulation start(b.scene);
  const double account = energy_account(start);
  expect_order(b, 0.5, GetParam().order == 4 ? 400 : 40, GetParam().order, [&](const Simulation& s) {
    EXPECT_GT(std::abs(s.energies().work), 0.1);
    return std::abs(energy_account(s) - account) + (s.angular_momentum() - start.angular_momentum()).norm();
  });
}

TEST_P(ExplicitDrives, GoOnFromARestoredStateBitByBit) {
  SceneBuilder b = geared_wheel(0.1);
  b.scene.drives[0].backlash = 0.01;
  b.servo("shaft", 4, 0.5, 3).set_point = TimeFunction::parse("0.3*sin(5*t)");
  Simulation s = without_memory(b);
  run(s, 17);
  const Snapshot middle = s.snapshot();
  run(s, 19);
  const double position = s.position(0), velocity = s.velocity(0), angle = state_of(s).actuators[0].angle;
  s.restore(middle);
  run(s, 19);
  EXPECT_EQ(s.position(0), position);
  EXPECT_EQ(s.velocity(0), velocity);
  EXPECT_EQ(state_of(s).actuators[0].angle, angle);
}

INSTANTIATE_TEST_SUITE_P(Methods, ExplicitDrives, kExplicitMethods, method_name);

}  // namespace
}  // namespace flexarm::test
