// Tests the constraints that close loops: derivatives of their rows, discrete gradient, and conservation of momenta.
#include "joints/closure_maps.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "support/node_poses.h"

namespace flexarm {
namespace {

using namespace test;
using Kind = ClosureConstraint::Kind;

struct RandomClosure {
  RandomClosure(RandomSource& random, Kind kind) {
    closure.parent_arm = random.vector();
    closure.child_arm = random.vector();
    constraint = {kind, random.unit(), random.unit(), 0.3};
    begin = {node_at(random.pose(1, 3)), node_at(random.pose(1, 3))};
    end = {moved(begin.parent, 0.5 * random.vector6()), moved(begin.child, 0.5 * random.vector6())};
  }
  LoopClosure closure;
  ClosureConstraint constraint;
  ClosurePoses begin, end;
};

class ClosureKind : public ::testing::TestWithParam<Kind> {
 protected:
  RandomSource random{3};
};

TEST_P(ClosureKind, RowsAreTheDerivativeOfTheValue) {
  for (int repeat = 0; repeat < 10; ++repeat) {
    const RandomClosure c(random, GetParam());
    const ClosureRows rows = closure_rows(c.closure, c.constraint, c.begin);
    for (int k = 0; k < 6; ++k) {
      const auto value = [&](double h, bool of_parent) {
        ClosurePoses poses = c.begin;
        NodePose& pose = of_parent ? poses.parent : poses.child;
        pose = moved(pose, h * Vector6::Unit(k));
        return Eigen::VectorXd::Constant(1, closure_value(c.closure, c.constraint, poses)).eval();
      };
      EXPECT_NEAR(rows.parent[k], difference([&](double h) { return value(h, true); })[0], difference_tolerance * 10);
      EXPECT_NEAR(rows.child[k], difference([&](double h) { return value(h, false); })[0], difference_tolerance * 10);
    }
  }
}

TEST_P(ClosureKind, BlocksAreTheDerivativesOfTheLeftRows) {
  for (const double weight : {0.5, 1.0}) {
    const RandomClosure c(random, GetParam());
    ClosureMaps maps;
    closure_maps(c.closure, c.constraint, c.begin, c.end, weight, maps);
    for (int k = 0; k < 6; ++k) {
      const auto rows = [&](double h, bool of_parent) {
        ClosurePoses end = c.end;
        NodePose& pose = of_parent ? end.parent : end.child;
        pose = moved(pose, h * Vector6::Unit(k));
        ClosureMaps there;
        closure_maps(c.closure, c.constraint, c.begin, end, weight, there);
        Eigen::VectorXd all(12);
        all << there.left.parent, there.left.child;
        return all;
      };
      const Eigen::VectorXd by_parent = difference([&](double h) { return rows(h, true); });
      const Eigen::VectorXd by_child = difference([&](double h) { return rows(h, false); });
      EXPECT_LE(largest(maps.parent_parent.col(k) - by_parent.head<6>()), difference_tolerance * 10) << k;
      EXPECT_LE(largest(maps.child_parent.col(k) - by_parent.tail<6>()), difference_tolerance * 10) << k;
      EXPECT_LE(largest(maps.parent_child.col(k) - by_child.head<6>()), difference_tolerance * 10) << k;
      EXPECT_LE(largest(maps.child_child.col(k) - by_child.tail<6>()), difference_tolerance * 10) << k;
    }
  }
}

// The mean rows give the exact change of the constraint's value over a step. So a multiplier does no work if the value
// does not change.
TEST_P(ClosureKind, MeanRowsAreADiscreteGradient) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    const RandomClosure c(random, GetParam());
    ClosureMaps maps;
    closure_maps(c.closure, c.constraint, c.begin, c.end, 0.5, maps);
    const auto increment = [](const NodePose& from, const NodePose& to) {
      Vector6 out;
      out << to.position - from.position, cayley::increment(from.orientation, to.orientation);
      return out;
    };
    const double change = maps.value - closure_value(c.closure, c.constraint, c.begin);
    EXPECT_NEAR(maps.left.parent.dot(increment(c.begin.parent, c.end.parent)) +
                    maps.left.child.dot(increment(c.begin.child, c.end.child)),
                change, 1e-14);
  }
}

TEST_P(ClosureKind, ForcesAddUpToNothing) {
  const RandomClosure c(random, GetParam());
  ClosureMaps maps;
  closure_maps(c.closure, c.constraint, c.begin, c.end, 0.5, maps);
  const auto moment = [](const NodePose& a, const NodePose& b, const Vector6& g) {
    const Vector3 arm = 0.5 * (a.position + b.position), force = g.head<3>();
    return Vector3(arm.cross(force) + g.tail<3>());
  };
  EXPECT_LE((maps.left.parent + maps.left.child).head<3>().norm(), 1e-15);
  EXPECT_LE(
      (moment(c.begin.parent, c.end.parent, maps.left.parent) + moment(c.begin.child, c.end.child, maps.left.child))
          .norm(),
      1e-14);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClosureKind, ::testing::Values(Kind::Gap, Kind::Direction));

}  // namespace
}  // namespace flexarm
