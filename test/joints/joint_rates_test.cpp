// Tests velocities, rates and updates of all elementary joints.
#include <gtest/gtest.h>

#include "elements/differences.h"
#include "joints/joint_step.h"
#include "support/node_poses.h"

namespace flexarm {
namespace {

using namespace test;

class JointRates : public OfEveryJoint {};

TEST_P(JointRates, VelocitiesAndRatesAreInverse) {
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

  // Compares the velocity with a difference of the motion itself.
  const Vector6 expected = difference([&](double h) {
    const Vector3 spin = h * master.tail<3>();
    const NodePose moved_master = node_at(step.master_end.position + h * master.head<3>(),
                                          so3::exp_quaternion(spin) * step.master_end.orientation);
    const NodePose moved = slave_pose(step.joint, moved_master, updated(step.joint, step.end, h * rates));
    Vector6 increment;
    increment << moved.position - pose.position, cayley::increment(pose.orientation, moved.orientation);
    return increment;
  });
  EXPECT_LE(largest(slave - expected), difference_tolerance);
}

// For a velocity that the joint does not allow, the remainder is orthogonal to the allowed velocities (least squares),
// at the origin of the moved joint frame.
TEST_P(JointRates, RemainderIsOrthogonal) {
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

TEST_P(JointRates, UpdatesAndIncrementsAgree) {
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

INSTANTIATE_TEST_SUITE_P(All, JointRates, ::testing::Combine(::testing::ValuesIn(kKinds), ::testing::Bool()),
                         parameter_name);

}  // namespace
}  // namespace flexarm
