// Tests the measure of the error between two motions by examples whose error is known.
#include "flexarm/accuracy/trajectory.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

/// `intervals` + 1 points on a straight line of 8 m.
Trajectory line(int intervals) {
  Trajectory points;
  for (int i = 0; i <= intervals; ++i) points.emplace_back(1 + 8.0 * i / intervals, 2, 3);
  return points;
}

TEST(TrajectoryError, OfAnOffsetIsTheOffset) {
  const Trajectory reference = line(10);
  EXPECT_EQ(trajectory_error(reference, reference), 0);
  Trajectory moved = reference;
  for (Vector3& point : moved) point += Vector3(0, 0.3, -0.4);
  EXPECT_NEAR(trajectory_error(moved, reference), 0.5 / 8, 1e-15);
}

TEST(TrajectoryError, OfADriftIsItsRootMeanSquare) {
  for (const int n : {1, 2, 10, 100}) {
    const Trajectory reference = line(n);
    Trajectory drifting = reference;
    for (int i = 0; i <= n; ++i) drifting[i].z() += 0.8 * i / n;
    // The trapezoidal rule gives 1/3 + 1/(6 n^2) for x^2 on [0, 1].
    EXPECT_NEAR(trajectory_error(drifting, reference), 0.1 * std::sqrt(1.0 / 3 + 1.0 / (6.0 * n * n)), 1e-15) << n;
  }
}

TEST(TrajectoryError, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(trajectory_error(line(9), line(10)), std::invalid_argument);
  EXPECT_THROW(trajectory_error({{0, 0, 0}}, {{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(trajectory_error(line(1), {{1, 1, 1}, {1, 1, 1}}), std::invalid_argument);
}

TEST(MotionError, IsThatOfTheWorstPointOnOneScale) {
  JudgedMotion reference(2);
  for (const Vector3& point : line(10)) reference.add({point, Vector3(0, 0, 0)});
  EXPECT_EQ(reference.largest_displacement(), 8);
  JudgedMotion moved = reference;
  for (Vector3& point : moved.points[1]) point.x() += 0.1;
  for (Vector3& point : moved.points[0]) point.x() += 0.02;
  EXPECT_NEAR(motion_error(moved, reference, reference.largest_displacement()), 0.1 / 8, 1e-15);
  EXPECT_THROW(motion_error(moved, reference, 0), std::invalid_argument);
  EXPECT_THROW(motion_error(JudgedMotion(1), reference, 1), std::invalid_argument);
}

TEST(JudgedMotion, TakesAPositionForEachPoint) {
  JudgedMotion motion(2);
  EXPECT_THROW(motion.add({Vector3(0, 0, 0)}), std::invalid_argument);
  EXPECT_TRUE(motion.points[0].empty());
}

}  // namespace
}  // namespace flexarm
