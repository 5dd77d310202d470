#include "elements/spring_action.h"

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

NodePose turned_node(const Vector3& position, const Vector3& rotation) {
  return node_at(position, so3::exp_quaternion(rotation));
}

class SpringActions : public ::testing::TestWithParam<bool> {
 protected:
  SpringActions() {
    ends.child_arm = {0.1, -0.2, 0.05};
    ends.parent_arm = {-0.05, 0.1, 0.3};
  }
  SpringAction action(const ClosurePoses& at_end) const {
    CoordinateStep change;
    change.begin = spring_length(ends, begin);
    change.end = spring_length(ends, at_end);
    change.increment = change.end - change.begin;
    change.step = 0.01;
    change.at_end = GetParam();
    if (change.at_end) change.gamma = 0.6, change.begin_rate = 0.3;
    return spring_action(spring, ends, begin, at_end, change);
  }

  LoopClosure ends;
  PointSpring spring{0, 40, 0.7, 3};
  ClosurePoses begin{turned_node({0, 0, 0}, {0.2, 0.1, -0.3}), turned_node({1, 0.4, -0.2}, {-0.1, 0.5, 0.2})};
  ClosurePoses end{turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3}),
                   turned_node({1.05, 0.42, -0.15}, {-0.1, 0.6, 0.25})};
};

// Central differences with a step of 1e-6 have errors of 1e-12 of third derivatives, and of 1e-16 / 1e-6 of the forces.
TEST_P(SpringActions, HaveTheirTangent) {
  const SpringAction here = action(end);
  constexpr double h = 1e-6;
  for (int k = 0; k < 12; ++k) {
    const auto residual = [&](double way) {
      Vector6 by = Vector6::Zero();
      by[k % 6] = way;
      ClosurePoses at = end;
      NodePose& node = k < 6 ? at.child : at.parent;
      node = moved(node, by);
      const SpringAction there = action(at);
      Eigen::Matrix<double, 12, 1> out;
      out << there.child, there.parent;
      return out;
    };
    const Eigen::Matrix<double, 12, 1> difference = (residual(h) - residual(-h)) / (2 * h);
    EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm()) << k;
  }
}

TEST_P(SpringActions, AddToNoMomentum) {
  const SpringAction here = action(end);
  EXPECT_LE((here.child + here.parent).head<3>().norm(), 1e-14 * here.child.norm());
  const double weight = GetParam() ? 1 : 0.5;
  const auto mean = [&](const NodePose& a, const NodePose& b) {
    return Vector3((1 - weight) * a.position + weight * b.position);
  };
  const Vector3 child = mean(begin.child, end.child), parent = mean(begin.parent, end.parent);
  const Vector3 moment = child.cross(here.child.head<3>()) + here.child.tail<3>() +
                         parent.cross(here.parent.head<3>()) + here.parent.tail<3>();
  EXPECT_LE(moment.norm(), 1e-13 * here.child.norm());
}

// What its mean force does over the step is what it stores and dissipates, to round-off.
TEST_P(SpringActions, OfMeansDoExactWork) {
  if (GetParam()) return;  // forces at the end do not
  CoordinateStep change;
  change.begin = spring_length(ends, begin);
  change.end = spring_length(ends, end);
  change.increment = change.end - change.begin;
  change.step = 0.01;
  const SpringAction here = spring_action(spring, ends, begin, end, change);
  const auto work = [](const Vector6& force, const NodePose& from, const NodePose& to) {
    return force.head<3>().dot(to.position - from.position) +
           force.tail<3>().dot(cayley::increment(from.orientation, to.orientation));
  };
  const auto energy = [&](double length) { return 20 * (length - 0.7) * (length - 0.7); };
  EXPECT_GT(here.dissipated, 0);
  EXPECT_NEAR(work(here.child, begin.child, end.child) + work(here.parent, begin.parent, end.parent),
              energy(change.end) - energy(change.begin) + here.dissipated, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(MeansAndEnds, SpringActions, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
