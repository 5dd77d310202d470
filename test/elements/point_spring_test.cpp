// Tests springs between points: the tangent against differences, momentum and work.
#include "elements/point_spring.h"

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

using Poses = std::vector<NodePose>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Residual, tangent and dissipation of a spring over a step. It acts between node 1 and node 0, or the world; its
/// nodes are {0, 1}.
class PointSprings : public ::testing::TestWithParam<bool> {
 protected:
  struct Action {
    Vector12 residual = Vector12::Zero();
    Matrix12 tangent = Matrix12::Zero();
    double dissipated = 0;
  };

  Action action(const Poses& at_end, const PointSpring& spring) const {
    const std::vector<Vector6> velocities = {0.3 * Vector6::Ones(), Vector6::Zero()};
    ForceStep step{begin, at_end, velocities};
    step.duration = 0.01;
    step.at_end = GetParam();
    if (step.at_end) step.gamma = 0.6;
    Action out;
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(spring.reach().size());
    Eigen::VectorXd residual(size);
    Eigen::MatrixXd tangent(size, size);
    ForceAction action{{residual.data(), size}, {tangent.data(), size, size}};
    spring.evaluate(step, spring.reach().data(), action);
    out.residual.head(size) = residual;
    out.tangent.topLeftCorner(size, size) = tangent;
    out.dissipated = action.dissipated;
    return out;
  }

  // Central differences with the step 1e-6 have truncation errors of 1e-12 times third derivatives, and round-off of
  // 1e-16 / 1e-6 times the forces.
  void expect_tangent(const PointSpring& spring) const {
    const Action here = action(end, spring);
    constexpr double h = 1e-6;
    const int count = 6 * static_cast<int>(spring.reach().size());
    for (int k = 0; k < count; ++k) {
      const auto residual = [&](double way) {
        Vector6 by = Vector6::Zero();
        by[k % 6] = way;
        Poses at = end;
        at[k / 6] = moved(at[k / 6], by);
        return action(at, spring).residual;
      };
      const Vector12 difference = (residual(h) - residual(-h)) / (2 * h);
      EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm()) << k;
    }
  }

  const NodePoint from{1, {-0.05, 0.1, 0.3}}, to{0, {0.1, -0.2, 0.05}};
  const PointSpring::Law law{40, 0.7, 3};
  const PointSpring between{"", from, to, law}, to_world{"", {-1, {0.1, 0.2, 0.9}}, to, law};
  const Poses begin{turned_node({1, 0.4, -0.2}, {-0.1, 0.5, 0.2}), turned_node({0, 0, 0}, {0.2, 0.1, -0.3})};
  const Poses end{turned_node({1.05, 0.42, -0.15}, {-0.1, 0.6, 0.25}),
                  turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3})};
};

TEST_P(PointSprings, HaveTheirTangent) {
  expect_tangent(between);
  expect_tangent(to_world);
}

TEST_P(PointSprings, AddToNoMomentum) {
  const Action here = action(end, between);
  const Vector6 child = here.residual.head<6>(), parent = here.residual.tail<6>();
  EXPECT_LE((child + parent).head<3>().norm(), 1e-14 * child.norm());
  const double weight = GetParam() ? 1 : 0.5;
  const auto mean = [&](int node) {
    return Vector3((1 - weight) * begin[node].position + weight * end[node].position);
  };
  const Vector3 moment =
      mean(0).cross(child.head<3>()) + child.tail<3>() + mean(1).cross(parent.head<3>()) + parent.tail<3>();
  EXPECT_LE(moment.norm(), 1e-13 * child.norm());
}

// The work of the mean force over the step equals the change of energy and the dissipation, to round-off.
TEST_P(PointSprings, OfMeansDoExactWork) {
  if (GetParam()) return;  // does not hold for forces at the end
  for (const PointSpring* spring : {&between, &to_world}) {
    const Action here = action(end, *spring);
    double work = 0;
    for (int node = 0; node < 2; ++node)
      work +=
          here.residual.segment<3>(6 * node).dot(end[node].position - begin[node].position) +
          here.residual.segment<3>(6 * node + 3).dot(cayley::increment(begin[node].orientation, end[node].orientation));
    const auto energy = [&](const Poses& poses) {
      State state;
      for (const NodePose& pose : poses) {
        state.nodes.emplace_back();
        state.nodes.back().position = pose.position;
        state.nodes.back().orientation = pose.orientation;
      }
      return static_cast<const ForceElement*>(spring)->energy(state, nullptr);
    };
    EXPECT_GT(here.dissipated, 0);
    EXPECT_NEAR(work, energy(end) - energy(begin) + here.dissipated, 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(MeansAndEnds, PointSprings, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
