// Tests forward dynamics by articulated bodies: kinematics by differences, and the balance by the principle of virtual
// power.
#include "joints/articulated_bodies.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "math/so3.h"

namespace flexarm::test {
namespace {

Quaternion turned(RandomSource& random) {
  return random.rotation(3);
}

Eigen::VectorXd numbers(int count, RandomSource& random) {
  return Eigen::VectorXd::NullaryExpr(count, [&] { return random.number(); });
}

JointMap joint(JointMapKind kind, int master, int slave, RandomSource& random) {
  JointMap out;
  out.kind = kind, out.master = master, out.slave = slave;
  out.origin = random.pose(1, 3);
  out.slave_orientation = turned(random);
  out.arm = random.vector();
  out.translation = 0.4 * random.vector();
  out.rotation = random.vector();
  place(out, Pose());
  return out;
}

/// A tree with two branches and joints of each kind.
Model tree() {
  RandomSource random(11);
  Model model;
  model.gravity = {1, -2, 3};
  const auto add = [&](JointMapKind kind, int master) {
    model.joints.push_back(joint(kind, master, static_cast<int>(model.nodes.size()), random));
    model.nodes.emplace_back();
    NodalInertia inertia;
    inertia.mass = 1 + 0.3 * random.vector()[0];
    const Matrix3 turn = turned(random).toRotationMatrix();
    inertia.rotary = turn * Vector3(0.3, 0.4, 0.5).asDiagonal() * turn.transpose();
    model.inertias.push_back(inertia);
  };
  add(JointMapKind::Free, -1);
  add(JointMapKind::Scalar, 0);
  add(JointMapKind::Spherical, 1);
  add(JointMapKind::Rigid, 2);
  add(JointMapKind::Scalar, 0);
  add(JointMapKind::Scalar, 4);
  add(JointMapKind::Scalar, -1);
  return model;
}

std::vector<Released> somewhere(const Model& model, RandomSource& random) {
  std::vector<Released> released(model.joints.size());
  for (std::size_t j = 0; j < released.size(); ++j) {
    const JointMapKind kind = model.joints[j].kind;
    if (kind == JointMapKind::Scalar) released[j].displacement[0] = random.number();
    if (kind == JointMapKind::Free) released[j].displacement = random.vector();
    if (kind == JointMapKind::Free || kind == JointMapKind::Spherical) released[j].rotation = turned(random);
  }
  return released;
}

/// The released coordinates after a time with these rates.
std::vector<Released> moved(const Model& model, std::vector<Released> released, const double* rates, double time) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int count = released_count(model.joints[j].kind);
    if (count > 0)
      released[j] = updated(model.joints[j], released[j], time * Eigen::Map<const Eigen::VectorXd>(rates, count));
    rates += count;
  }
  return released;
}

// Poses are those of slave_pose(). Velocities and accelerations are their derivatives: central differences over 1e-4,
// of which the error is of the order of 1e-8.
TEST(ArticulatedBodies, MoveAsJointsDo) {
  const Model model = tree();
  RandomSource random(5);
  ArticulatedBodies bodies(model);
  const int count = bodies.rate_count();
  ASSERT_EQ(count, 6 + 1 + 3 + 1 + 1 + 1);
  const std::vector<Released> released = somewhere(model, random);
  const Eigen::VectorXd rates = 0.5 * numbers(count, random), efforts = numbers(count, random),
                        none = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd changes(count);
  bodies.set(released, rates.data());
  bodies.accelerate(efforts.data(), none.data(), changes.data());
  constexpr double h = 1e-4;
  ArticulatedBodies at[2] = {bodies, bodies};
  for (int side = 0; side < 2; ++side) {
    const double time = side == 0 ? -h : h;
    const Eigen::VectorXd mean = rates + 0.5 * time * changes, then = rates + time * changes;
    at[side].set(moved(model, released, mean.data(), time), then.data());
  }
  std::vector<NodePose> poses(model.nodes.size());
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const int master = model.joints[j].master, node = model.joints[j].slave;
    poses[node] = slave_pose(model.joints[j], master < 0 ? NodePose() : poses[master], released[j]);
    EXPECT_LT((poses[node].position - bodies.position(node)).norm(), 1e-13);
    EXPECT_LT((poses[node].rotation - bodies.rotation(node)).norm(), 1e-13);
    const Vector3 velocity = (at[1].position(node) - at[0].position(node)) / (2 * h);
    const Matrix3 turning = (at[1].rotation(node) - at[0].rotation(node)) / (2 * h);
    EXPECT_LT((velocity - bodies.velocity(node).head<3>()).norm(), 1e-6) << node;
    EXPECT_LT((turning * bodies.rotation(node).transpose() - so3::hat(Vector3(bodies.velocity(node).tail<3>()))).norm(),
              1e-6)
        << node;
    const Vector6 acceleration = (at[1].velocity(node) - at[0].velocity(node)) / (2 * h);
    EXPECT_LT((acceleration - bodies.acceleration(node)).norm(), 1e-6) << node;
  }
}

/// A tree somewhere, and what moves and accelerates it: numbers of the order of 1.
struct MovingTree {
  explicit MovingTree(unsigned seed) : random(seed) {}

  const Model model = tree();
  RandomSource random;
  ArticulatedBodies bodies{model};
  const int count = bodies.rate_count();
  const std::vector<Released> released = somewhere(model, random);
  const Eigen::VectorXd rates = numbers(count, random), efforts = numbers(count, random),
                        armatures = numbers(count, random).cwiseAbs();
  const Vector6 force = random.vector6();
};

// For each rate, the power of the forces minus d(momentum)/dt on the velocities that it causes is the effort, minus the
// armature's share.
TEST(ArticulatedBodies, AreInBalance) {
  MovingTree at(7);
  Eigen::VectorXd changes(at.count);
  at.bodies.set(somewhere(at.model, at.random), at.efforts.data());  // nothing of it may stay
  at.bodies.set(at.released, at.rates.data());
  at.bodies.add_force(2, at.force);
  at.bodies.accelerate(at.efforts.data(), at.armatures.data(), changes.data());
  std::vector<Vector6> lacks;  // per node: forces minus the change of momentum
  for (int node = 0; node < static_cast<int>(at.model.nodes.size()); ++node) {
    const Matrix3 rotary =
        at.bodies.rotation(node) * at.model.inertias[node].rotary * at.bodies.rotation(node).transpose();
    const Vector3 spin = at.bodies.velocity(node).tail<3>();
    Vector6 lack;
    lack << at.model.inertias[node].mass * (at.model.gravity - at.bodies.acceleration(node).head<3>()),
        -rotary * at.bodies.acceleration(node).tail<3>() - spin.cross(rotary * spin);
    lacks.push_back(node == 2 ? Vector6(lack + at.force) : lack);
  }
  for (int k = 0; k < at.count; ++k) {
    ArticulatedBodies alone(at.model);
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(at.count, k);
    alone.set(at.released, one.data());
    double power = at.efforts[k] - at.armatures[k] * changes[k];
    for (std::size_t node = 0; node < lacks.size(); ++node)
      power += lacks[node].dot(alone.velocity(static_cast<int>(node)));
    EXPECT_NEAR(power, 0, 1e-12) << k;
  }
}

// Inverse dynamics needs the efforts that forward dynamics was given. The mass matrix has the differences of efforts
// for unit changes of rates. Round-off of numbers of the order of 10.
TEST(ArticulatedBodies, NeedTheEffortsThatAccelerateThem) {
  MovingTree at(9);
  Eigen::VectorXd changes(at.count), needed(at.count), more(at.count);
  const auto set = [&] {
    at.bodies.set(at.released, at.rates.data());
    at.bodies.add_force(3, at.force);
  };
  set();
  at.bodies.accelerate(at.efforts.data(), at.armatures.data(), changes.data());
  const Vector6 acceleration = at.bodies.acceleration(6);
  set();
  at.bodies.set_accelerations(changes.data());
  EXPECT_LT((at.bodies.acceleration(6) - acceleration).norm(), 1e-12);
  at.bodies.find_needed_efforts(changes.data(), at.armatures.data(), needed.data());
  EXPECT_LT((needed - at.efforts).norm(), 1e-12);
  Eigen::MatrixXd mass(at.count, at.count);
  at.bodies.find_mass_matrix(at.armatures.data(), mass);
  for (int k = 0; k < at.count; ++k) {
    const Eigen::VectorXd other = changes + Eigen::VectorXd::Unit(at.count, k);
    set();
    at.bodies.set_accelerations(other.data());
    at.bodies.find_needed_efforts(other.data(), at.armatures.data(), more.data());
    EXPECT_LT((more - needed - mass.col(k)).norm(), 1e-11) << k;
  }
  // A row of powers is the velocity that each rate gives the node.
  Eigen::VectorXd row = Eigen::VectorXd::Zero(at.count);
  set();
  at.bodies.add_power(3, at.force, row.data());
  at.bodies.add_power(-1, at.force, row.data());
  EXPECT_NEAR(row.dot(at.rates), at.force.dot(at.bodies.velocity(3)), 1e-12);
}

}  // namespace
}  // namespace flexarm::test
