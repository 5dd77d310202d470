/// Tests the roll-up of a cantilever by an end moment (case S1) against its closed form, for any number of turns.

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_cantilever.h"

namespace flexarm::test {
namespace {

constexpr double kLength = 3, kBending = 2;

Cantilever roll_up(double turns) {
  Cantilever cantilever;
  cantilever.pieces = {line({kLength, 0, 0})};
  cantilever.section = section(1e3, 1e3, 1, kBending, 1, 1, 1);
  cantilever.moment = {0, 0, 2 * kPi * turns * kBending / kLength};
  return cantilever;
}

/// Number of elements such that no node of an element rotates by more than pi from the reference rotation.
int elements(int turns) {
  return turns < 5 ? 6 : 12;
}

class FullTurns : public testing::TestWithParam<std::tuple<int, int, int>> {};

// The interpolation represents constant curvature exactly, and the Gauss sums over full turns vanish by symmetry. So
// only round-off remains, for any order and any number of load steps.
TEST_P(FullTurns, TipReturnsToTheRootForAnyLoadSteps) {
  const auto [turns, order, load_steps] = GetParam();
  const Pose tip = static_tip(roll_up(turns), elements(turns), order, load_steps);
  EXPECT_LT(tip.position.norm(), 1e-10 * kLength);
  EXPECT_LT(tip.orientation.angularDistance(Quaternion::Identity()), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(RollUp, FullTurns,
                         testing::Combine(testing::Values(1, 2, 5), testing::Values(1, 2, 3, 4),
                                          testing::Values(1, 4, 16)));

// For a partial turn, the section's angle is still exact, and r' = Lambda e_1 holds at the p Gauss points. So the tip
// has the error of Gauss quadrature.
TEST(RollUp, TipOfAPartialTurnHasTheOrderOfGaussQuadrature) {
  const double turns = 0.7, angle = 2 * kPi * turns, radius = kLength / angle;
  const Vector3 exact = radius * Vector3(std::sin(angle), 1 - std::cos(angle), 0);
  const int coarsest[] = {0, 16, 8, 4, 2};
  for (int order = 1; order <= 4; ++order) {
    double errors[2];
    for (int k = 0; k < 2; ++k) {
      const Pose tip = static_tip(roll_up(turns), coarsest[order] << k, order);
      errors[k] = (tip.position - exact).norm();
      const Quaternion turned(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
      EXPECT_LT(tip.orientation.angularDistance(turned), 1e-10);
    }
    EXPECT_NEAR(observed_order(errors[0], errors[1]), 2 * order, kOrderTolerance) << "order " << order;
  }
}

// The quaternions of the nodes keep track of the path, so that an element may bend by nearly 2 pi between its reference
// nodes.
TEST(RollUp, AnElementBendsBeyondPi) {
  for (const double turns : {0.3, 0.6, 0.9})
    for (int order = 1; order <= 4; ++order) {
      const Pose tip = static_tip(roll_up(turns), 1, order, 16);
      const Quaternion turned(Eigen::AngleAxisd(2 * kPi * turns, Vector3::UnitZ()));
      EXPECT_LT(tip.orientation.angularDistance(turned), 1e-10) << turns << " turns, order " << order;
    }
}

TEST(RollUp, SectionsAlongTheBeamLieOnTheCircle) {
  Simulation simulation(cantilever_scene(roll_up(2), 16, 4).scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  std::vector<BeamPoint> points;
  simulation.beam_points(1, 0, points);
  const double curvature = 4 * kPi / kLength;
  for (const BeamPoint& point : points) {
    const double angle = curvature * point.arc_length;
    const Quaternion turned(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
    EXPECT_LT(point.pose.orientation.angularDistance(turned), 1e-10);
    EXPECT_NEAR(point.strain[5], curvature, 1e-10 * curvature);
    EXPECT_NEAR(point.resultant[5], kBending * curvature, 1e-10 * kBending * curvature);
  }
}

}  // namespace
}  // namespace flexarm::test
