// Tests the set-valued law of dry friction of one coordinate, and the normal force in a joint.
#include "joints/dry_friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elements/differences.h"
#include "elements/random_element.h"

namespace flexarm::test {
namespace {

/// Solves K x = b - y, where y(x) is the effort of the law. Returns the number of revisions, at most 20.
int solve(StickSlip& law, double K, double b, double capacity, double& increment, double& effort) {
  for (int n = 0; n < 20; ++n) {
    increment = law.is_held() ? law.held_increment() : (b - law.direction() * capacity) / K;
    effort = law.is_held() ? b - K * increment : law.direction() * capacity;
    if (!law.revise(increment, effort, capacity, 1e-10)) return n;
  }
  return 20;
}

/// Smallest and largest effort that the set-valued law allows at the increment x. Its steps are at 0 and at `rest`.
std::pair<double, double> efforts_at(double x, double rest, double capacity) {
  const double low = std::min(rest, 0.0), high = std::max(rest, 0.0);
  const double from = x <= low ? -1 : x <= high ? 0 : 1, to = x < low ? -1 : x < high ? 0 : 1;
  return low == high && x == low ? std::pair{-capacity, capacity} : std::pair{from * capacity, to * capacity};
}

// The solution is found for every first guess, every load, and every increment that stops the coordinate.
TEST(StickSlip, FindsTheSolutionOfAMonotoneProblem) {
  const double K = 3, capacity = 2;
  for (const double rest : {0.0, 0.5, -0.5})
    for (const double rate : {0.0, 1.0, -1.0})
      for (double b = -8; b <= 8; b += 0.25) {
        SCOPED_TRACE("rest " + std::to_string(rest) + " rate " + std::to_string(rate) + " load " + std::to_string(b));
        StickSlip law;
        law.begin(rest, rate);
        double x = 0, effort = 0;
        ASSERT_LE(solve(law, K, b, capacity, x, effort), 4);
        const auto [least, most] = efforts_at(x, rest, capacity);
        EXPECT_GE(effort, least - 1e-9);
        EXPECT_LE(effort, most + 1e-9);
        EXPECT_GE(effort * x, 0) << "friction dissipates";
      }
}

TEST(StickSlip, RestsOnlyWhereItEndsAtRest) {
  StickSlip law;
  double x = 0, effort = 0;
  law.begin(0.5, 1);
  solve(law, 3, 2, 2, x, effort);  // x = 1/2 needs an effort of 1/2
  EXPECT_EQ(x, 0.5);
  EXPECT_TRUE(law.is_stopped());
  law.begin(0.5, 1);
  solve(law, 3, -1, 2, x, effort);  // thrown back: held where it began, which it leaves with the opposite velocity
  EXPECT_EQ(x, 0);
  EXPECT_TRUE(law.is_held());
  EXPECT_FALSE(law.is_stopped());
}

// Without normal force there is no friction on any branch of the law.
TEST(StickSlip, CapacityZeroIsFree) {
  for (const double b : {-1.0, 0.0, 1.0}) {
    StickSlip law;
    law.begin(0, 0);
    double x = 0, effort = 0;
    ASSERT_LE(solve(law, 2, b, 0, x, effort), 2);
    EXPECT_EQ(x, b / 2);
  }
}

TEST(NormalForce, IsNormalToTheWay) {
  RandomSource random(1);
  for (int n = 0; n < 20; ++n) {
    const Vector6 column = random.vector6();
    const Vector3 force = random.vector(), travel = column.head<3>(), axis = column.tail<3>();
    EXPECT_NEAR(normal_force(Contact::Travel, column, force).magnitude, force.cross(travel).norm() / travel.norm(),
                1e-14);
    EXPECT_NEAR(normal_force(Contact::Turn, column, force).magnitude, force.cross(axis).norm() / axis.norm(), 1e-14);
    EXPECT_NEAR(normal_force(Contact::Both, column, force).magnitude, force.norm(), 1e-15);
  }
}

TEST(NormalForce, DerivativesAgreeWithDifferences) {
  RandomSource random(2);
  for (const Contact contact : {Contact::Travel, Contact::Turn, Contact::Both}) {
    const Vector6 column = random.vector6(), turn = random.vector6();
    const Vector3 force = random.vector(), change = random.vector();
    const NormalForce normal = normal_force(contact, column, force);
    const auto magnitude = [&](double h) {
      return normal_force(contact, column + h * turn, force + h * change).magnitude;
    };
    const double expected = normal.direction.dot(change) + normal.along * normal.arm.dot(turn);
    EXPECT_NEAR(scalar_difference(magnitude, 1e-3), expected, 1e-9);
  }
}

TEST(NormalForce, VanishesWithTheForce) {
  const NormalForce normal = normal_force(Contact::Travel, Vector6::Unit(0), Vector3(3, 0, 0));
  EXPECT_EQ(normal.magnitude, 0);
  EXPECT_EQ(normal.direction, Vector3::Zero());
  EXPECT_EQ(normal.arm, Vector6::Zero());
}

}  // namespace
}  // namespace flexarm::test
