// Tests nodal loads and pulls: derivatives and work.
#include "elements/load.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "support/node_poses.h"

namespace flexarm {
namespace {

using namespace test;

NodalLoad random_load(RandomSource& random, bool follows) {
  NodalLoad load;
  load.arm = random.vector();
  load.force = random.vector();
  load.moment = random.vector();
  load.follows = follows;
  return load;
}

TEST(LoadAction, DerivativeForEveryFrameAndPoint) {
  RandomSource random(1);
  for (const bool follows : {false, true})
    for (const LoadPoint point : {LoadPoint::Mean, LoadPoint::End}) {
      const NodalLoad load = random_load(random, follows);
      const Matrix3 begin = random.rotation(3).toRotationMatrix();
      const Quaternion end = random.rotation(3);
      const LoadAction action = load_action(load, 1.4, begin, end.toRotationMatrix(), point);
      for (int k = 0; k < 3; ++k) {
        const Vector6 expected = difference([&](double h) {
          const Quaternion turned = so3::exp_quaternion(Vector3(h * Vector3::Unit(k))) * end;
          return load_action(load, 1.4, begin, turned.toRotationMatrix(), point).wrench;
        });
        EXPECT_LE(largest(action.derivative.col(k) - expected), difference_tolerance * largest(expected) + 1e-12);
      }
    }
}

// The derivative of a pull has the same three parts as that of a load: change of the force, of its arm, and rotation of
// the arm.
TEST(PullAction, Tangent) {
  RandomSource random(4);
  for (const double step : {0.0, 0.01})
    for (const LoadPoint point : {LoadPoint::Mean, LoadPoint::End}) {
      NodalLoad load = random_load(random, false);
      load.pull = {random.vector(), 40, 3};
      const Pose begin = random.pose(1, 2), end{random.vector(), random.rotation(3)};
      const auto action = [&](const Pose& at_end) {
        return pull_action(load, load.pull.target, node_at(begin), node_at(at_end), step, point);
      };
      const PullAction here = action(end);
      for (int k = 0; k < 6; ++k) {
        const Vector6 expected = difference([&](double h) {
          const Vector6 moved = h * Vector6::Unit(k);
          return action({end.position + moved.head<3>(), so3::exp_quaternion(moved.tail<3>()) * end.orientation})
              .wrench;
        });
        EXPECT_LE(largest(here.derivative.col(k) - expected), difference_tolerance * largest(expected) + 1e-12);
      }
    }
}

// The work of the mean force over the displacement of the point equals the energy that the spring loses, less the
// dissipation of the damper.
TEST(PullAction, Work) {
  RandomSource random(5);
  NodalLoad load = random_load(random, false);
  load.pull = {random.vector(), 40, 3};
  const Pose begin = random.pose(1, 2), end{random.vector(), random.rotation(1.4) * begin.orientation};
  const double step = 0.01;
  const Vector3 from = begin * load.arm, to = end * load.arm;
  const double lost = 20 * ((load.pull.target - from).squaredNorm() - (load.pull.target - to).squaredNorm());
  const double expected = lost - 3 / step * (to - from).squaredNorm();
  for (const LoadPoint point : {LoadPoint::Mean, LoadPoint::End})
    EXPECT_NEAR(pull_action(load, load.pull.target, node_at(begin), node_at(end), step, point).work / expected, 1,
                1e-13);
}

TEST(LoadAction, ForceAtAnArm) {
  RandomSource random(2);
  NodalLoad load = random_load(random, false);
  const Matrix3 rotation = random.rotation(3).toRotationMatrix();
  const Vector6 world = load_action(load, 2.0, rotation, rotation, LoadPoint::End).wrench;
  EXPECT_LE((world.head<3>() - 2 * load.force).norm(), 1e-14);
  EXPECT_LE((world.tail<3>() - 2 * load.moment - (rotation * load.arm).cross(2 * load.force)).norm(), 1e-14);
  load.follows = true;
  const Vector6 follower = load_action(load, 2.0, rotation, rotation, LoadPoint::End).wrench;
  EXPECT_LE((follower.head<3>() - 2 * rotation * load.force).norm(), 1e-14);
  EXPECT_LE((follower.tail<3>() - 2 * rotation * (load.moment + load.arm.cross(load.force))).norm(), 1e-14);
}

// A dead force does the work F . Delta x of its point over the step, for any rotation.
TEST(LoadAction, WorkOfADeadForceIsExact) {
  RandomSource random(3);
  NodalLoad load = random_load(random, false);
  load.moment.setZero();
  const Pose begin = random.pose(1, 2), end{random.vector(), random.rotation(1.4) * begin.orientation};
  const Vector6 wrench =
      load_action(load, 1.0, begin.orientation.toRotationMatrix(), end.orientation.toRotationMatrix(), LoadPoint::Mean)
          .wrench;
  const double work = wrench.head<3>().dot(end.position - begin.position) +
                      wrench.tail<3>().dot(cayley::increment(begin.orientation, end.orientation));
  EXPECT_NEAR(work, load.force.dot(end * load.arm - begin * load.arm), 1e-13);
}

}  // namespace
}  // namespace flexarm
