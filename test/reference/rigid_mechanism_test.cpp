// Tests mechanisms of rigid links against their textbook equations in minimal coordinates.
#include <cstdio>
#include <functional>
#include <vector>

#include "reference/dynamics_runs.h"
#include "reference/ode.h"

namespace flexarm::test {
namespace {

using Eigen::VectorXd;
using scene::JointKind;

/// A mechanism whose coordinates obey q'' = acceleration(q, q').
struct Mechanism {
  std::string name;
  SceneBuilder scene;
  std::vector<std::string> coordinates;
  std::function<VectorXd(const VectorXd& q, const VectorXd& rate)> acceleration;
  VectorXd position, velocity;  ///< at the start
};

/// Adds a body with its centre of mass at `center` and principal inertia about it.
void add_body(SceneBuilder& b, const std::string& name, double mass, const Vector3& center, const Vector3& inertia) {
  b.body(name, mass, center, inertia.asDiagonal());
}

/// Two links in the x-z plane. The first angle is about y from the downward vertical, the second one relative to the
/// first link.
Mechanism double_pendulum() {
  const double m1 = 1.3, m2 = 0.9, l1 = 0.8, a1 = 0.5, a2 = 0.4, j1 = 0.11, j2 = 0.07;
  Mechanism m{"double_pendulum", {}, {"first", "second"}, {}, VectorXd(2), VectorXd(2)};
  m.scene.scene.gravity = {0, 0, -kGravity};
  add_body(m.scene, "upper", m1, {0, 0.1, -a1}, {0.2, j1, 0.2});
  add_body(m.scene, "lower", m2, {0, -0.2, -a2}, {0.2, j2, 0.2});
  m.scene.joint("first", JointKind::Revolute, "world", "upper", {0, 0, 0}, {0, 1, 0});
  m.scene.joint("second", JointKind::Revolute, "upper", "lower", {0, 0.05, -l1}, {0, 1, 0});
  m.acceleration = [=](const VectorXd& q, const VectorXd& rate) {
    const double c = std::cos(q[1]), s = std::sin(q[1]), w1 = rate[0], w2 = rate[0] + rate[1];
    Eigen::Matrix2d mass;  // mass matrix for the absolute angles
    mass << j1 + m1 * a1 * a1 + m2 * l1 * l1, m2 * l1 * a2 * c, m2 * l1 * a2 * c, j2 + m2 * a2 * a2;
    const Eigen::Vector2d force(m2 * l1 * a2 * s * w2 * w2 - (m1 * a1 + m2 * l1) * kGravity * std::sin(q[0]),
                                -m2 * l1 * a2 * s * w1 * w1 - m2 * a2 * kGravity * std::sin(q[0] + q[1]));
    const Eigen::Vector2d absolute = mass.inverse() * force;
    return VectorXd(Eigen::Vector2d(absolute[0], absolute[1] - absolute[0]));
  };
  m.position << 1.2, 0.7;
  m.velocity << 0.5, -1.0;
  return m;
}

/// A mass on a radial rail of a rotating hub; coordinates are angle and radius.
Mechanism radial_slider() {
  const double hub = 0.6, mass = 1.5, spin = 0.08;
  Mechanism m{"prismatic_on_revolute", {}, {"hub", "rail"}, {}, VectorXd(2), VectorXd(2)};
  add_body(m.scene, "rotor", 2, {0, 0, 0}, {hub, hub, hub});
  add_body(m.scene, "slider", mass, {0.3, 0, 0.1}, {0.1, 0.1, spin});
  m.scene.joint("hub", JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  m.scene.joint("rail", JointKind::Prismatic, "rotor", "slider", {0, 0, 0}, {1, 0, 0});
  m.acceleration = [=](const VectorXd& q, const VectorXd& rate) {
    const double r = q[1] + 0.3;
    return VectorXd(
        Eigen::Vector2d(-2 * mass * r * rate[1] * rate[0] / (hub + spin + mass * r * r), r * rate[0] * rate[0]));
  };
  m.position << 0.3, 0.2;
  m.velocity << 2, -0.5;
  return m;
}

/// A pendulum in a universal joint: rotation about the vertical, then tilt about the rotated x axis.
Mechanism universal_pendulum() {
  const double mass = 1.2, length = 0.6;
  const Vector3 about_center(0.12, 0.2, 0.05);
  const double a = about_center.x() + mass * length * length, b = about_center.y() + mass * length * length,
               c = about_center.z();
  Mechanism m{"universal", {}, {"hook/1", "hook/2"}, {}, VectorXd(2), VectorXd(2)};
  m.scene.scene.gravity = {0, 0, -kGravity};
  add_body(m.scene, "bob", mass, {0, 0, -length}, about_center);
  scene::JointDescription& hook = m.scene.joint("hook", JointKind::Universal, "world", "bob", {0, 0, 1}, {0, 0, 1});
  hook.axis2 = Vector3::UnitX();
  m.acceleration = [=](const VectorXd& q, const VectorXd& rate) {
    const double sine = std::sin(q[1]), cosine = std::cos(q[1]);
    return VectorXd(
        Eigen::Vector2d(-2 * (b - c) * sine * cosine * rate[0] * rate[1] / (b * sine * sine + c * cosine * cosine),
                        ((b - c) * sine * cosine * rate[0] * rate[0] - mass * kGravity * length * sine) / a));
  };
  m.position << 0.1, 1.1;
  m.velocity << 2.0, 0.4;
  return m;
}

/// A body that slides down an inclined shaft and swings about it.
Mechanism cylindrical_pendulum() {
  const double mass = 0.7, offset = 0.35, spin = 0.05, tilt = 0.6;
  Mechanism m{"cylindrical", {}, {"shaft/1", "shaft/2"}, {}, VectorXd(2), VectorXd(2)};
  m.scene.scene.gravity = {0, 0, -kGravity};
  add_body(m.scene, "bob", mass, {0, 0.2, -offset}, {0.1, spin, 0.1});
  scene::JointDescription& shaft = m.scene.joint("shaft", JointKind::Cylindrical, "world", "bob", {0, 0, 0}, {0, 1, 0});
  shaft.origin.orientation = Eigen::AngleAxisd(tilt, Vector3::UnitX());  // inclines the axis by the angle `tilt`
  m.acceleration = [=](const VectorXd& q, const VectorXd&) {
    return VectorXd(Eigen::Vector2d(-kGravity * std::sin(tilt), -mass * kGravity * std::cos(tilt) * offset *
                                                                    std::sin(q[1]) / (spin + mass * offset * offset)));
  };
  m.position << 0.5, 1.3;
  m.velocity << 1, -1;
  return m;
}

/// A pendulum whose pin slides in a level slot.
Mechanism sliding_pendulum() {
  const double mass = 0.9, length = 0.5, inertia = 0.06;
  Mechanism m{"pin_slot", {}, {"pin/1", "pin/2"}, {}, VectorXd(2), VectorXd(2)};
  m.scene.scene.gravity = {0, 0, -kGravity};
  add_body(m.scene, "bob", mass, {0, 0.1, -length}, {0.2, inertia, 0.2});
  m.scene.joint("pin", JointKind::PinSlot, "world", "bob", {0, 0, 0}, {1, 0, 0}).axis2 = Vector3::UnitY();
  m.acceleration = [=](const VectorXd& q, const VectorXd& rate) {
    const double lever = mass * length * std::cos(q[1]);
    Eigen::Matrix2d masses;
    masses << mass, -lever, -lever, inertia + mass * length * length;
    const Eigen::Vector2d force(-mass * length * std::sin(q[1]) * rate[1] * rate[1],
                                -mass * kGravity * length * std::sin(q[1]));
    return VectorXd(masses.inverse() * force);
  };
  m.position << 0.2, 1.2;
  m.velocity << 0.5, -1;
  return m;
}

/// A body thrown in a vertical plane. The joint's frame is not at its centre of mass.
Mechanism planar_body() {
  const double offset = 0.4;
  Mechanism m{"planar", {}, {"plane/x", "plane/y", "plane/rz"}, {}, VectorXd(3), VectorXd(3)};
  m.scene.scene.gravity = {0, -kGravity, 0};
  add_body(m.scene, "plate", 1.7, {offset, 0, 0.3}, {0.2, 0.3, 0.4});
  m.scene.joint("plane", JointKind::Planar, "world", "plate", {0, 0, 0}, {0, 0, 1});
  m.acceleration = [=](const VectorXd& q, const VectorXd& rate) {
    // The centre of mass falls freely, and the spin is constant.
    const double w2 = rate[2] * rate[2];
    return VectorXd(Vector3(offset * std::cos(q[2]) * w2, -kGravity + offset * std::sin(q[2]) * w2, 0));
  };
  m.position << 0.2, -0.1, 0.3;
  m.velocity << 1, 5, 3;
  return m;
}

std::vector<Mechanism> mechanisms() {
  return {double_pendulum(),      radial_slider(),    universal_pendulum(),
          cylindrical_pendulum(), sliding_pendulum(), planar_body()};
}

VectorXd exact_positions(const Mechanism& m, double until) {
  const Eigen::Index n = m.position.size();
  VectorXd start(2 * n);
  start << m.position, m.velocity;
  const OdeFunction f = [&](double, const VectorXd& y) {
    VectorXd out(2 * n);
    out << y.tail(n), m.acceleration(y.head(n), y.tail(n));
    return out;
  };
  return solve_ode(f, 0, until, start);
}

class RigidMechanism : public ::testing::TestWithParam<std::tuple<std::string, Mechanism>> {};

TEST_P(RigidMechanism, ConvergesAtSecondOrderToTheTextbookEquations) {
  auto [scheme, m] = GetParam();
  const double until = 2;
  const VectorXd exact = exact_positions(m, until);
  for (std::size_t i = 0; i < m.coordinates.size(); ++i)
    initial_joint(m.scene, m.coordinates[i], m.position[i], m.velocity[i]);
  std::vector<double> error;
  for (const int steps : {250, 500, 1000, 2000}) {
    Simulation simulation(m.scene.scene, options(scheme, until / steps, 1e-11));
    ASSERT_EQ(simulation.degrees_of_freedom(), m.coordinates.size()) << "exactly the joint coordinates are unknown";
    run(simulation, steps);
    VectorXd difference(2 * m.coordinates.size());
    for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
      const std::size_t index = *simulation.find_coordinate(m.coordinates[i]);
      difference[i] = simulation.position(index) - exact[i];
      difference[m.coordinates.size() + i] = simulation.velocity(index) - exact[m.coordinates.size() + i];
    }
    error.push_back(difference.norm());
  }
  const double slope = std::log2(error[2] / error[3]);
  std::printf("%s %s: errors %.2e %.2e %.2e %.2e, slope %.3f\n", scheme.c_str(), m.name.c_str(), error[0], error[1],
              error[2], error[3], slope);
  // Newmark's trapezoidal rule applies to the centres of mass, which the joints constrain. Its error constant is the
  // largest of the three schemes.
  EXPECT_LT(error[3], scheme == "newmark" ? 2e-3 : 2e-4);
  // The slope is larger where the third-order error of published velocities dominates.
  if (error[2] > 1e-9) {
    EXPECT_GT(slope, 1.9);
  }
}
INSTANTIATE_TEST_SUITE_P(Schemes, RigidMechanism,
                         ::testing::Combine(::testing::Values("em", "m1", "newmark"),
                                            ::testing::ValuesIn(mechanisms())),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param).name; });

// Every scheme represents constant acceleration exactly: a block on an inclined rail.
TEST(RigidJoint, BlockOnAnInclinedRailIsExact) {
  for (const std::string scheme : {"em", "em0", "m1", "newmark"}) {
    SceneBuilder b;
    b.scene.gravity = {0, 0, -kGravity};
    b.body("block", 3, {0.1, 0.2, 0.3}, Vector3(1, 2, 3).asDiagonal());
    b.joint("rail", JointKind::Prismatic, "world", "block", {1, 2, 3}, Vector3(0.6, 0, 0.8));
    initial_joint(b, "rail", 0.5, 2);
    Simulation simulation(b.scene, options(scheme, 0.01, 1e-12));
    EXPECT_EQ(simulation.degrees_of_freedom(), 1u);
    run(simulation, 100);
    // Newmark's initial acceleration comes from a short step. Its round-off is about 1e-9.
    EXPECT_NEAR(simulation.position(0), 0.5 + 2 - 0.5 * 0.8 * kGravity, 1e-8) << scheme;
    EXPECT_NEAR(simulation.velocity(0), 2 - 0.8 * kGravity, 1e-8) << scheme;
  }
}

TEST(RigidJoint, RevoluteJointCountsItsTurns) {
  for (const std::string scheme : {"em", "em0", "m1", "newmark"}) {
    SceneBuilder b;
    // Newmark's rule is unstable for centres of mass on a circle, so the rotor is balanced for it.
    const double offset = scheme == "newmark" ? 0.0 : 0.1;
    b.body("rotor", 2, {offset, 0, 0}, Vector3(0.2, 0.2, 0.2).asDiagonal());
    b.body("arm", 1, {offset - 0.3, 0, 0}, Vector3(0.1, 0.1, 0.1).asDiagonal());
    b.joint("shaft", JointKind::Continuous, "world", "rotor", {0, 0, 0}, Vector3(1, 2, 2) / 3);
    b.joint("weld", JointKind::Fixed, "rotor", "arm", {0.3, 0, 0});
    initial_joint(b, "shaft", 0, 25);
    Simulation simulation(b.scene, options(scheme, 0.02, 1e-12));
    run(simulation, 400);
    // Free rotation about a fixed axis is uniform. Tangent scaling slows it down by (w h)^2 / 12 = 2 %.
    EXPECT_GT(simulation.position(0), 100) << scheme;
    EXPECT_NEAR(simulation.position(0), 25 * 8.0, 0.025 * 25 * 8.0) << scheme;
    if (scheme == "em") {
      EXPECT_NEAR(simulation.position(0), 400 * 2 * std::atan(0.5 * 25 * 0.02), 1e-9);
      EXPECT_NEAR(simulation.velocity(0), 25, 1e-9);
    }
    const double angle = simulation.position(0);
    const Quaternion turned(Eigen::AngleAxisd(angle, Vector3(1, 2, 2) / 3));
    EXPECT_LT(turned.angularDistance(simulation.link_pose(1).orientation), 1e-7) << scheme;
  }
}

}  // namespace
}  // namespace flexarm::test
