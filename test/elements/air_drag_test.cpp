// Tests the drag on links: the tangent against differences, work, and what small motions see of it.
#include "elements/air_drag.h"

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

using Poses = std::vector<NodePose>;

constexpr double kDuration = 0.01;

struct DragAction {
  Eigen::VectorXd residual;
  Eigen::MatrixXd tangent, in_pieces;
  double dissipated = 0;
};

/// Drag on a section of a beam and on a body, over a step. Parameter: forces at the end, else means.
class AirDrags : public ::testing::TestWithParam<bool> {
 protected:
  DragAction action(const Poses& at_end) const {
    ForceStep step{begin, at_end, velocities};
    step.duration = kDuration;
    step.at_end = GetParam();
    if (step.at_end) step.gamma = 0.6;
    DragAction out{Eigen::VectorXd(12), Eigen::MatrixXd(12, 12), {}};
    std::vector<double> numbers(PieceTangent::size(drag.pieces()));
    ForceAction action{
        {out.residual.data(), 12}, {out.tangent.data(), 12, 12}, PieceTangent::in(numbers.data(), drag.pieces())};
    drag.evaluate(step, drag.reach().data(), action);
    out.in_pieces = action.pieces.sum(drag.pieces(), 2);
    out.dissipated = action.dissipated;
    return out;
  }

  const AirDrag drag{"arm",
                     {{{0, {0.1, -0.2, 0.05}}, {0, 0.3, 0.7}},
                      {{1, {-0.05, 0.1, 0.3}, so3::exp_quaternion(Vector3(0.3, -0.2, 0.5))}, {0.2, 0.5, 0.4}}}};
  const std::vector<Vector6> velocities = {0.3 * Vector6::Ones(), -2 * Vector6::Ones()};
  const Poses begin{turned_node({0, 0, 0}, {0.2, 0.1, -0.3}), turned_node({1, 0.4, -0.2}, {-0.1, 0.5, 0.2})};
  const Poses end{turned_node({0.02, -0.01, 0.03}, {0.25, 0.05, -0.3}),
                  turned_node({1.05, 0.42, -0.15}, {-0.1, 0.6, 0.25})};
};

// Central differences with the step 1e-6 have truncation errors of 1e-12 times third derivatives, which grow with the
// square of the rate's slope, 1e4, and round-off of 1e-16 / 1e-6 times the forces.
TEST_P(AirDrags, HaveTheirTangent) {
  const DragAction here = action(end);
  constexpr double h = 1e-6;
  for (int k = 0; k < 12; ++k) {
    const auto residual = [&](double way) {
      Vector6 by = Vector6::Zero();
      by[k % 6] = way;
      Poses at = end;
      at[k / 6] = moved(at[k / 6], by);
      return action(at).residual;
    };
    const Eigen::VectorXd difference = (residual(h) - residual(-h)) / (2 * h);
    EXPECT_LE((difference - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm()) << k;
  }
  EXPECT_EQ(here.tangent, here.in_pieces);
}

// The force of means takes exactly what it dissipates, whatever the step.
TEST_P(AirDrags, OfMeansDoExactWork) {
  if (GetParam()) return;  // does not hold for forces at the end
  const DragAction here = action(end);
  double work = 0;
  for (int node = 0; node < 2; ++node)
    work +=
        here.residual.segment<3>(6 * node).dot(end[node].position - begin[node].position) +
        here.residual.segment<3>(6 * node + 3).dot(cayley::increment(begin[node].orientation, end[node].orientation));
  EXPECT_GT(here.dissipated, 0);
  EXPECT_NEAR(work, here.dissipated, 1e-14 * here.residual.norm());
}

TEST_P(AirDrags, RestIsWithoutForce) {
  if (GetParam()) return;
  const DragAction here = action(begin);
  EXPECT_EQ(here.residual.norm(), 0);
  EXPECT_EQ(here.tangent.norm(), 0);
}

// Without turning, the force is -|u| sum c_i u_i e_i; what has no resistance does not count.
TEST_P(AirDrags, FollowTheirLaw) {
  if (GetParam()) return;
  Poses shifted = begin;
  const Vector3 velocity(3, -2, 1);
  for (NodePose& pose : shifted) pose.position += kDuration * velocity;
  const Matrix3 axes = begin[0].rotation;
  const Vector3 along = axes.transpose() * velocity;
  const Vector3 expected = axes * (along.tail<2>().norm() * Vector3(0, 0.3 * along[1], 0.7 * along[2]));
  EXPECT_LE((action(shifted).residual.head<3>() - expected).norm(), 1e-12);
}

// For small motions, the tensions of dampers and their slopes.
TEST_P(AirDrags, HaveDampers) {
  if (GetParam()) return;
  const State state = state_at(begin);
  const ForceMeasures measures = drag.measures(state, nullptr, drag.reach().data());
  EXPECT_EQ(measures.stiffness.norm(), 0);
  Eigen::VectorXd motion(12);
  motion << velocities[0], velocities[1];
  const Eigen::VectorXd rates = measures.rows * motion;
  const DamperTensions here = drag.dampers(state, nullptr, rates);
  constexpr double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Eigen::VectorXd way = h * Eigen::VectorXd::Unit(6, k);
    const Eigen::VectorXd difference =
        (drag.dampers(state, nullptr, rates + way).tension - drag.dampers(state, nullptr, rates - way).tension) /
        (2 * h);
    EXPECT_LE((difference - here.slope.col(k)).norm(), 1e-8 * here.slope.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(MeansAndEnds, AirDrags, ::testing::Bool());

}  // namespace
}  // namespace flexarm::test
