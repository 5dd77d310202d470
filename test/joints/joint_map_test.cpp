// One tester for the maps of all elementary joints.
#include "joints/joint_map.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;

/// A joint over a step.
struct JointStep {
  JointMap joint;
  NodePose master_begin, master_end;
  Released begin, end;

  int released() const { return released_count(joint.kind); }
  /// Scalars that the slave depends on: the released ones, then {dr, spin} of the master where that is a node.
  int columns() const { return released() + (joint.master < 0 ? 0 : 6); }
  NodePose slave_begin() const { return slave_pose(joint, master_begin, begin); }
  NodePose slave_end() const { return slave_pose(joint, master_end, end); }
  /// The same joint without an arm.
  JointStep without_arm() const {
    JointStep out = *this;
    out.joint.arm.setZero();
    return out;
  }

  /// The end displaced by h along one of columns().
  JointStep perturbed(int column, double h) const {
    JointStep out = *this;
    const int count = released();
    if (column < count) {
      out.end = updated(joint, end, h * ReleasedVector::Unit(count, column));
    } else if (column < count + 3) {
      out.master_end.position[column - count] += h;
    } else {
      const Vector3 spin = h * Vector3::Unit(column - count - 3);
      out.master_end.orientation = (so3::exp_quaternion(spin) * master_end.orientation).normalized();
      out.master_end.rotation = out.master_end.orientation.toRotationMatrix();
    }
    return out;
  }
};

NodePose node(const Vector3& position, const Quaternion& orientation) {
  return {position, orientation, orientation.toRotationMatrix()};
}

struct KindOfJoint {
  const char* name;
  JointMapKind kind;
  bool translates, rotates;  // Scalar
  bool by_profile = false;   // its travel
};

const KindOfJoint kKinds[] = {
    {"Rigid", JointMapKind::Rigid, false, false},     {"Revolute", JointMapKind::Scalar, false, true},
    {"Prismatic", JointMapKind::Scalar, true, false}, {"Coupled", JointMapKind::Scalar, true, true},
    {"Cam", JointMapKind::Scalar, true, true, true},  {"Spherical", JointMapKind::Spherical, false, false},
    {"Free", JointMapKind::Free, false, false}};

/// Increments of size `size` in everything; axes are neither unit vectors nor parallel to each other.
JointStep random_step(RandomSource& random, const KindOfJoint& kind, bool world, double size) {
  JointStep out;
  out.joint.kind = kind.kind;
  out.joint.master = world ? -1 : 0;
  out.joint.slave = 1;
  out.joint.origin = random.pose(1, 3);
  out.joint.slave_orientation = random.rotation(3);
  out.joint.arm = random.vector();
  if (kind.translates) out.joint.translation = 0.7 * random.unit();
  if (kind.rotates) out.joint.rotation = 1.2 * random.unit();
  if (kind.kind == JointMapKind::Scalar) place(out.joint, Pose());
  if (kind.by_profile)  // analytic: differences must not cross knots
    out.joint.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.6, 0.1));
  if (!world) {
    out.master_begin = node(random.vector(), random.rotation(3));
    out.master_end = node(out.master_begin.position + size * random.vector(),
                          so3::exp_quaternion(Vector3(size * random.unit())) * out.master_begin.orientation);
  }
  const double sign = random.number() < 0 ? -1 : 1;
  if (kind.kind == JointMapKind::Scalar) {
    out.begin.displacement[0] = 2 * random.number();
    out.end.displacement[0] = out.begin.displacement[0] + sign * size;
  } else if (kind.kind != JointMapKind::Rigid) {
    out.begin.rotation = random.rotation(3);
    out.end.rotation = (so3::exp_quaternion(Vector3(size * random.unit())) * out.begin.rotation).normalized();
    if (kind.kind == JointMapKind::Free) {
      out.begin.displacement = random.vector();
      out.end.displacement = out.begin.displacement + size * random.vector();
    }
  }
  return out;
}

enum class Form { Variational, Incremental };

FoldMaps maps_of(const JointStep& step, const Vector6& g, Form form, bool with_tangent = true,
                 double arm_weight = 0.5) {
  FoldMaps maps;
  const NodePose slave_begin = step.slave_begin(), slave_end = step.slave_end();
  const JointPose begin{step.master_begin, slave_begin, step.begin}, end{step.master_end, slave_end, step.end};
  if (form == Form::Variational)
    variational_maps(step.joint, end, g, maps);
  else
    incremental_maps(step.joint, begin, end, g, maps, with_tangent, arm_weight);
  return maps;
}

/// {released rows, master rows} of the slave's residual.
Eigen::VectorXd folded(const FoldMaps& maps, const Vector6& g) {
  const Vector3 force = g.head<3>(), moment = g.tail<3>();
  Eigen::VectorXd rows(maps.left.cols() + 6);
  rows << maps.left.transpose() * g, force, maps.lever_left.cross(force) + moment;
  return rows;
}
Eigen::VectorXd folded(const JointStep& step, const Vector6& g, Form form) {
  return folded(maps_of(step, g, form), g);
}

/// Increments from tiny to large, on both sides of where a series hands over to a closed form (0.05 / 1.2).
const double kSizes[] = {1e-10, 1e-5, 0.0416, 0.0417, 0.3, 1.0, 1.7};

using Parameter = std::tuple<KindOfJoint, bool>;
class JointMaps : public ::testing::TestWithParam<Parameter> {
 protected:
  JointStep random(double size) { return random_step(source, std::get<0>(GetParam()), std::get<1>(GetParam()), size); }
  RandomSource source{7};
};
class JointMapsOnANode : public JointMaps {};  // the world takes the reactions of the others

// The slave's displacement and tangent-scaled rotation increment are the left map of the released and master
// increments.
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
      // Near half a turn the tangent-scaled vector itself amplifies round-off with its square.
      EXPECT_LE(largest(increment - mapped), 1e-13 * std::max(1.0, increment.squaredNorm())) << "size " << size;
    }
}

// No force on the slave is lost, and moments balance about the mid-step positions (joints.md, section 0).
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

// An arm is a rigid joint behind the joint: what the rigid one passes on is folded as without an arm. (joints.md 1.6)
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
      if (size > 1) continue;  // close to half a turn of the slave the maps change too fast for differences
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

TEST_P(JointMaps, VelocitiesAndRatesAreInverse) {
  const JointStep step = random(0.5);
  const Vector6 master = step.joint.master < 0 ? Vector6(Vector6::Zero()) : source.vector6();
  ReleasedVector rates(step.released());
  for (int k = 0; k < rates.size(); ++k) rates[k] = source.number();
  const NodePose pose = step.slave_end();
  const Vector6 slave = slave_velocity(step.joint, {step.master_end, pose, step.end}, master, rates);
  Vector6 remainder;
  const ReleasedVector found = released_rates(step.joint, {step.master_end, pose, step.end}, master, slave, &remainder);
  EXPECT_LE(largest(found - rates), 1e-13);
  EXPECT_LE(largest(remainder), 1e-13);

  // Against the motion itself.
  const Vector6 expected = difference([&](double h) {
    const Vector3 spin = h * master.tail<3>();
    const NodePose moved_master =
        node(step.master_end.position + h * master.head<3>(), so3::exp_quaternion(spin) * step.master_end.orientation);
    const NodePose moved = slave_pose(step.joint, moved_master, updated(step.joint, step.end, h * rates));
    Vector6 increment;
    increment << moved.position - pose.position, cayley::increment(pose.orientation, moved.orientation);
    return increment;
  });
  EXPECT_LE(largest(slave - expected), difference_tolerance);
}

// A velocity that the joint does not allow: what remains is orthogonal to what it allows (least squares), at the moved
// joint frame's origin.
TEST_P(JointMaps, RemainderIsOrthogonal) {
  const JointStep step = random(0.5);
  const Vector6 slave = source.vector6();
  Vector6 remainder;
  const NodePose pose = step.slave_end();
  const ReleasedVector rates =
      released_rates(step.joint, {step.master_end, pose, step.end}, Vector6::Zero(), slave, &remainder);
  const FoldMaps maps = maps_of(step, Vector6::Zero(), Form::Variational);
  EXPECT_LE(largest(maps.right * rates + remainder - slave), 1e-13);
  Vector6 at_frame = remainder;
  at_frame.head<3>() -= Vector3(remainder.tail<3>()).cross(pose.rotation * step.joint.arm);
  const FoldMaps without_arm = maps_of(step.without_arm(), Vector6::Zero(), Form::Variational);
  EXPECT_LE(largest(without_arm.right.transpose() * at_frame), 1e-13);
}

TEST_P(JointMaps, UpdatesAndIncrementsAgree) {
  const JointStep step = random(0.5);
  const int count = step.released();
  ReleasedVector update(count);
  for (int k = 0; k < count; ++k) update[k] = source.number();
  const Released moved = updated(step.joint, step.begin, update);
  ReleasedVector expected = update;
  if (count >= 3) expected.tail<3>() = cayley::from_rotation_vector(Vector3(update.tail<3>()));
  EXPECT_LE(largest(released_increment(step.joint, step.begin, moved) - expected), 1e-13);
  EXPECT_EQ(released_increment(step.joint, step.begin, step.begin), ReleasedVector(ReleasedVector::Zero(count)));
}

std::string parameter_name(const ::testing::TestParamInfo<Parameter>& info) {
  return std::string(std::get<0>(info.param).name) + (std::get<1>(info.param) ? "OnTheWorld" : "OnANode");
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
  place(joint, {Vector3(1, 0, 0), so3::exp_quaternion(Vector3(0, 0, kPi / 2))});  // the axis is y of the world
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
  EXPECT_LE((slave.position - Vector3(1, 3, 0)).norm(), 1e-15);
}

// A full turn and more: only the step matters, not the angle.
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
