// Tests the maps of all elementary joints against kinematics and differences.
#include <limits>

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "joints/joint_step.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;

/// The slave's residual g, folded into {released rows, master rows}.
Eigen::VectorXd folded(const FoldMaps& maps, const Vector6& g) {
  const Vector3 force = g.head<3>(), moment = g.tail<3>();
  Eigen::VectorXd rows(maps.left.cols() + 6);
  rows << maps.left.transpose() * g, force, maps.lever_left.cross(force) + moment;
  return rows;
}
Eigen::VectorXd folded(const JointStep& step, const Vector6& g, Form form) {
  return folded(maps_of(step, g, form), g);
}

/// Sizes of increments, from tiny to large, and on both sides of the switch from a series to a closed form (at 0.05 /
/// 1.2).
const double kSizes[] = {1e-10, 1e-5, 0.0416, 0.0417, 0.3, 1.0, 1.7};

class JointMaps : public OfEveryJoint {};
class JointMapsOnANode : public OfEveryJoint {};  // on the world the reactions would not be found in any row

// The left map, applied to the released and the master's increments, gives exactly the slave's displacement and
// tangent-scaled rotation increment.
TEST_P(JointMaps, IncrementsAreMappedExactly) {
  for (const double size : kSizes)
    for (int repeat = 0; repeat < 5; ++repeat) {
      const JointStep step = random(size);
      const FoldMaps maps = maps_of(step, Vector6::Zero(), Form::Incremental);
      const NodePose begin = step.slave_begin(), end = step.slave_end();
      Vector6 increment, mapped;
      increment << end.position - begin.position, cayley::increment(begin.orientation, end.orientation);
      const Vector3 turn = cayley::increment(step.master_begin.orientation, step.master_end.orientation);
      mapped << step.master_end.position - step.master_begin.position + turn.cross(maps.lever_left), turn;
      mapped += maps.left * released_increment(step.joint, step.begin, step.end);
      // Near half a turn, the tangent-scaled vector amplifies round-off with its square.
      EXPECT_LE(largest(increment - mapped), 1e-13 * std::max(1.0, increment.squaredNorm())) << "size " << size;
    }
}

// Folded forces have the same resultant as the slave's, and moments balance about the mid-step positions (joints.md,
// section 0).
TEST_P(JointMapsOnANode, FoldedForcesKeepTheirResultants) {
  for (const double size : kSizes) {
    const JointStep step = random(size);
    const Vector6 g = source.vector6();
    const FoldMaps maps = maps_of(step, g, Form::Incremental);
    const Vector3 force = g.head<3>(), moment = g.tail<3>();
    const Vector3 arm_master = 0.5 * (step.master_begin.position + step.master_end.position);
    const Vector3 arm_slave = 0.5 * (step.slave_begin().position + step.slave_end().position);
    const Vector3 on_master = arm_master.cross(force) + maps.lever_left.cross(force) + moment;
    EXPECT_LE((on_master - arm_slave.cross(force) - moment).norm(), 1e-14);
  }
}

// An arm is a rigid joint outboard of the joint. So folding with an arm equals folding through a rigid joint, then
// through the joint without an arm (joints.md 1.6).
TEST_P(JointMaps, AnArmIsARigidJointBehind) {
  for (const double arm_weight : {0.5, 0.0})
    for (const Form form : {Form::Variational, Form::Incremental}) {
      const JointStep step = random(0.3), bare = step.without_arm();
      JointStep rigid;
      rigid.joint.master = 1;
      rigid.joint.origin.position = step.joint.slave_orientation * step.joint.arm;
      rigid.joint.slave_orientation = step.joint.slave_orientation;
      JointStep hinge = bare;
      hinge.joint.slave_orientation = Quaternion::Identity();
      rigid.master_begin = hinge.slave_begin();
      rigid.master_end = hinge.slave_end();
      EXPECT_LE((rigid.slave_end().position - step.slave_end().position).norm(), 1e-14);
      EXPECT_LE((rigid.slave_end().rotation - step.slave_end().rotation).norm(), 1e-14);
      const Vector6 g = source.vector6();
      const Vector6 passed_on = folded(maps_of(rigid, g, form, true, arm_weight), g);
      const Eigen::VectorXd expected = folded(maps_of(bare, passed_on, form, true, arm_weight), passed_on);
      EXPECT_LE(largest(folded(maps_of(step, g, form, true, arm_weight), g) - expected), 1e-13);
    }
}

TEST_P(JointMaps, ColumnsAreTheDerivativeOfTheSlave) {
  for (const Form form : {Form::Variational, Form::Incremental})
    for (const double size : kSizes) {
      const JointStep step = random(size);
      const FoldMaps maps = maps_of(step, Vector6::Zero(), form);
      Eigen::Matrix<double, 6, Eigen::Dynamic> columns(6, step.columns());
      columns.leftCols(step.released()) = maps.right;
      if (step.joint.master >= 0) {
        columns.rightCols<6>().setIdentity();
        columns.topRightCorner<3, 3>() = -so3::hat(maps.lever_right);
      }
      const NodePose slave = step.slave_end();
      for (int column = 0; column < step.columns(); ++column) {
        const Vector6 expected = difference([&](double h) {
          const NodePose moved = step.perturbed(column, h).slave_end();
          Vector6 increment;
          increment << moved.position - slave.position, cayley::increment(slave.orientation, moved.orientation);
          return increment;
        });
        EXPECT_LE(largest(columns.col(column) - expected), difference_tolerance) << "column " << column;
      }
    }
}

TEST_P(JointMaps, GeometricBlocksAreTheDerivativeOfTheFoldedResidual) {
  for (const Form form : {Form::Variational, Form::Incremental})
    for (const double size : kSizes) {
      if (size > 1) continue;  // near half a turn of the slave, the maps change too fast for differences
      const JointStep step = random(size);
      const Vector6 g = source.vector6();
      const FoldMaps maps = maps_of(step, g, form);
      const int count = step.released();
      Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(count + 6, count + 6);
      blocks.topLeftCorner(count, count) = maps.released_released;
      blocks.topRightCorner(count, 3) = maps.released_spin;
      blocks.bottomLeftCorner(3, count) = maps.moment_released;
      blocks.bottomRightCorner<3, 3>() = maps.moment_spin;
      for (int column = 0; column < step.columns(); ++column) {
        const Eigen::VectorXd expected =
            difference([&](double h) { return folded(step.perturbed(column, h), g, form); });
        const double scale = std::max(1.0, largest(blocks));
        EXPECT_LE(largest(blocks.col(column) - expected), 10 * difference_tolerance * scale)
            << "column " << column << ", size " << size;
      }
    }
}

TEST_P(JointMaps, IncrementalFormStartsAsTheVariationalOne) {
  JointStep step = random(0.3);
  step.end = step.begin;
  step.master_end = step.master_begin;
  const FoldMaps variational = maps_of(step, Vector6::Zero(), Form::Variational);
  const FoldMaps incremental = maps_of(step, Vector6::Zero(), Form::Incremental);
  EXPECT_LE(largest(variational.left - incremental.left), 1e-14);
  EXPECT_LE(largest(variational.right - incremental.right), 1e-14);
  EXPECT_LE(largest(variational.lever_left - incremental.lever_left), 1e-14);
}

TEST_P(JointMaps, LeftMapsAreTheSameWithoutATangent) {
  const JointStep step = random(0.7);
  const Vector6 g = source.vector6();
  const FoldMaps with = maps_of(step, g, Form::Incremental), without = maps_of(step, g, Form::Incremental, false);
  EXPECT_EQ(with.left, without.left);
  EXPECT_EQ(with.lever_left, without.lever_left);
}

INSTANTIATE_TEST_SUITE_P(All, JointMaps, ::testing::Combine(::testing::ValuesIn(kKinds), ::testing::Bool()),
                         parameter_name);
INSTANTIATE_TEST_SUITE_P(All, JointMapsOnANode,
                         ::testing::Combine(::testing::ValuesIn(kKinds), ::testing::Values(false)), parameter_name);

// ---------------------------------------------------------------- kinematics by hand

TEST(SlavePose, RevoluteJointTurnsAboutItsAxis) {
  JointMap joint;
  joint.kind = JointMapKind::Scalar;
  joint.rotation = Vector3::UnitX();
  place(joint, {Vector3(1, 0, 0), so3::exp_quaternion(Vector3(0, 0, kPi / 2))});  // the axis is the y axis of the world
  Released released;
  released.displacement[0] = kPi / 2;
  const NodePose slave = slave_pose(joint, NodePose(), released);
  EXPECT_LE((slave.position - Vector3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((slave.rotation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-15);
  // The joint frame's y axis, -x of the world, turns about +y by a quarter turn into the frame's z, +z of the world.
  EXPECT_LE((slave.rotation.col(1) - Vector3::UnitZ()).norm(), 1e-15);
  EXPECT_LE((slave.rotation * slave.rotation.transpose() - Matrix3::Identity()).norm(), 1e-14);
}

TEST(SlavePose, PrismaticJointShiftsAlongItsAxis) {
  JointMap joint;
  joint.kind = JointMapKind::Scalar;
  joint.translation = Vector3::UnitX();
  place(joint, {Vector3(1, 0, 0), so3::exp_quaternion(Vector3(0, 0, kPi / 2))});
  Released released;
  released.displacement[0] = 3;
  const NodePose slave = slave_pose(joint, NodePose(), released);
  // The round-off of a quaternion's four entries rotates the travel of 3 m.
  EXPECT_LE((slave.position - Vector3(1, 3, 0)).norm(), 4 * 3 * std::numeric_limits<double>::epsilon());
}

// Angles of more than a full turn: only the increment in a step is limited, not the angle.
TEST(SlavePose, AnglesMayExceedATurn) {
  JointMap joint;
  joint.kind = JointMapKind::Scalar;
  joint.rotation = Vector3::UnitZ();
  Released one, many;
  one.displacement[0] = 0.3;
  many.displacement[0] = 0.3 + 20 * kPi;
  EXPECT_LE((slave_pose(joint, NodePose(), one).rotation - slave_pose(joint, NodePose(), many).rotation).norm(), 1e-13);
}

}  // namespace
}  // namespace flexarm
