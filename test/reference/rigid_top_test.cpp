// Tests a rigid body about a fixed point and in free flight against Euler's equations, for rotations far beyond 2 pi.
#include <cstdio>
#include <vector>

#include "reference/dynamics_runs.h"
#include "reference/ode.h"

namespace flexarm::test {
namespace {

using Eigen::VectorXd;
using scene::JointKind;

constexpr double kMass = 1.4;

struct Top {
  Matrix3 inertia;  ///< about the fixed point, body axes
  Vector3 center;   ///< centre of mass, from the fixed point
  Vector3 gravity;
  Vector3 spin;  ///< at the start, when body axes = world axes
};

/// Orientation (w x y z) and body angular velocity at `until`.
VectorXd exact_motion(const Top& top, double until) {
  const OdeFunction f = [&](double, const VectorXd& y) {
    const Quaternion q(y[0], y[1], y[2], y[3]);
    const Vector3 w = y.tail<3>();
    const Quaternion rate = q * Quaternion(0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z());
    const Vector3 torque = kMass * top.center.cross(q.normalized().conjugate() * top.gravity);
    VectorXd out(7);
    out << rate.w(), rate.vec(), top.inertia.inverse() * (torque - w.cross(top.inertia * w));
    return out;
  };
  VectorXd start(7);
  start << 1, 0, 0, 0, top.spin;
  return solve_ode(f, 0, until, start);
}

/// Expects that orientation errors [rad] at `until` have second order.
void expect_second_order(const SceneBuilder& builder, const Top& top, double until, const std::string& scheme,
                         std::initializer_list<int> step_counts) {
  const VectorXd exact = exact_motion(top, until);
  const Quaternion orientation = Quaternion(exact[0], exact[1], exact[2], exact[3]).normalized();
  std::vector<double> error;
  for (const int steps : step_counts) {
    Simulation simulation(builder.scene, options(scheme, until / steps, 1e-11));
    run(simulation, steps);
    error.push_back(orientation.angularDistance(simulation.link_pose(1).orientation));
  }
  const std::size_t n = error.size();
  const double slope = std::log2(error[n - 2] / error[n - 1]);
  std::printf("%s: errors %.2e %.2e rad, slope %.3f\n", scheme.c_str(), error[n - 2], error[n - 1], slope);
  EXPECT_NEAR(slope, 2, 0.1) << scheme;
  EXPECT_LT(error[n - 1], 2e-3) << scheme;
}

Matrix3 asymmetric_inertia() {
  const Quaternion tilt(Eigen::AngleAxisd(0.4, Vector3(1, 2, 3).normalized()));
  return tilt.toRotationMatrix() * Vector3(0.5, 0.8, 1.1).asDiagonal() * tilt.toRotationMatrix().transpose();
}

class RigidTop : public ::testing::TestWithParam<std::string> {};

TEST_P(RigidTop, TorqueFreeAsymmetricTopOnASphericalJoint) {
  const Top top{asymmetric_inertia(), Vector3::Zero(), Vector3::Zero(), {3, 4, -2}};
  SceneBuilder b;
  b.body("top", kMass, Vector3::Zero(), top.inertia);
  b.joint("ball", JointKind::Spherical, "world", "top", {1, 2, 3});
  initial_field(b, "top", Vector3::Zero(), top.spin);
  ASSERT_EQ(Simulation(b.scene).degrees_of_freedom(), 3u);
  expect_second_order(b, top, 10, GetParam(), {5000, 10000});  // about 50 rad
}

TEST_P(RigidTop, FreeBodyWithOffsetCentreOfMass) {
  const Top top{asymmetric_inertia(), Vector3::Zero(), Vector3::Zero(), {1.5, 2, -1}};
  const Vector3 center(0.3, -0.2, 0.4);
  SceneBuilder b;
  b.scene.gravity = {0, 0, -9.81};  // has no influence on the rotation
  b.body("body", kMass, center, top.inertia);
  b.joint("free", JointKind::Floating, "world", "body");
  initial_field(b, "body", {1, 0, 5}, top.spin);
  b.probe("center", "body", center);
  ASSERT_EQ(Simulation(b.scene).degrees_of_freedom(), 6u);
  expect_second_order(b, top, 4, GetParam(), {2000, 4000});

  Simulation simulation(b.scene, options(GetParam(), 0.01, 1e-12));
  run(simulation, 100);
  const Vector3 fall = center + Vector3(1, 0, 5) + top.spin.cross(center) - Vector3(0, 0, 0.5 * 9.81);
  // Newmark's initial accelerations have round-off of about 1e-16 * |x| / h^2 = 1e-8.
  const double tolerance = GetParam() == "newmark" ? 1e-7 : 1e-9;
  EXPECT_LT((simulation.probe(0).pose.position - fall).norm(), tolerance) << "the centre of mass falls on a parabola";
}

TEST_P(RigidTop, HeavyTopPrecesses) {
  const Vector3 center(0, 0, 0.3);
  const Matrix3 about_center = Vector3(0.2, 0.2, 0.1).asDiagonal();
  Top top{about_center, center, {3, 0, -9}, {0.3, 0, 12}};
  top.inertia += kMass * 0.09 * Vector3(1, 1, 0).asDiagonal().toDenseMatrix();
  SceneBuilder b;
  b.scene.gravity = top.gravity;
  b.body("top", kMass, center, about_center);
  b.joint("ball", JointKind::Spherical, "world", "top");
  initial_field(b, "top", Vector3::Zero(), top.spin);
  // Newmark's rule is unstable for a centre of mass on a sphere (an index-3 constraint). Only short times show its
  // order.
  const double until = GetParam() == "newmark" ? 0.5 : 3;
  expect_second_order(b, top, until, GetParam(), {3000, 6000});
}

// Energy and both momenta of a torque-free body are constant to round-off over hundreds of turns.
TEST(FreeRigidBody, TorqueFreeBodyConservesOverManyTurns) {
  SceneBuilder b;
  b.body("body", kMass, {0.2, 0.1, 0}, asymmetric_inertia());
  b.joint("free", JointKind::Floating, "world", "body");
  initial_field(b, "body", Vector3::Zero(), {3, 4, -2});
  set_drift(b, Vector3::Zero());
  Simulation simulation(b.scene, options("em", 0.05, 1e-12));
  InvariantDrift drift(simulation);
  run(simulation, 10000, [&] { drift.observe(); });
  EXPECT_LT(drift.energy(), 1e-9);
  EXPECT_LT(drift.momentum(), 1e-10);
  EXPECT_LT(drift.angular_momentum(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Schemes, RigidTop, ::testing::Values("em", "m1", "newmark"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace flexarm::test
