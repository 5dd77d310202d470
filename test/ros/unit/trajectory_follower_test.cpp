// Tests paths of joints through points: interpolation, replacement by another path, stops.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stepping/trajectory_follower.h"

namespace flexarm::node {
namespace {

constexpr double kRoundOff = 1e-12;  ///< of polynomials over some seconds with coefficients of about 1
constexpr double kStart = 10;        ///< [s]
const std::vector<double> kTimes = {0.5, 1.25, 2, 3.5};

/// A polynomial in the time since kStart.
JointPoint polynomial(int degree, double time) {
  const double c[] = {0.3, -0.4, 0.7, 0.2, -0.15, 0.03};
  const double t = time - kStart;
  JointPoint out;
  for (int k = 0; k <= degree; ++k) {
    out.position += c[k] * std::pow(t, k);
    if (k > 0) out.velocity += k * c[k] * std::pow(t, k - 1);
    if (k > 1) out.acceleration += k * (k - 1) * c[k] * std::pow(t, k - 2);
  }
  return out;
}

/// A trajectory of one joint through points of this polynomial, with the rates that its degree needs.
JointTrajectory trajectory_of(int degree, std::size_t joint = 0) {
  JointTrajectory out;
  out.joints = {joint};
  out.start = kStart;
  for (const double time : kTimes) {
    const JointPoint point = polynomial(degree, kStart + time);
    out.points.push_back({time, {point.position}, {}, {}});
    if (degree >= 2) out.points.back().velocities = {point.velocity};
    if (degree >= 4) out.points.back().accelerations = {point.acceleration};
  }
  return out;
}

void expect_near(const JointPoint& got, const JointPoint& expected, double time) {
  EXPECT_NEAR(got.position, expected.position, kRoundOff) << time;
  EXPECT_NEAR(got.velocity, expected.velocity, 10 * kRoundOff) << time;
  EXPECT_NEAR(got.acceleration, expected.acceleration, 100 * kRoundOff) << time;
}

// Splines through points of a polynomial of their degree reproduce the polynomial.
TEST(TrajectoryFollower, SplinesAreOfDegreeOneThreeAndFive) {
  for (const int degree : {1, 3, 5}) {
    TrajectoryFollower follower(1);
    const JointTrajectory trajectory = trajectory_of(degree);
    ASSERT_EQ(follower.find_fault(trajectory), "");
    follower.follow(trajectory, kStart, {0.3});
    for (double time = kStart + kTimes.front(); time < kStart + kTimes.back(); time += 0.01)
      expect_near(follower.at(0, time), polynomial(degree, time), time);
    const JointPoint end = polynomial(degree, kStart + kTimes.back());
    expect_near(follower.at(0, kStart + 100), {end.position}, 100);
    EXPECT_EQ(follower.end(0), kStart + kTimes.back());
  }
}

TEST(TrajectoryFollower, BeginsWhereTheJointRests) {
  TrajectoryFollower follower(2);
  follower.follow(trajectory_of(5, 1), kStart, {0.9});
  expect_near(follower.at(1, kStart), {0.9}, kStart);
  EXPECT_NEAR(follower.at(1, kStart + 1e-4).position, 0.9, 1e-6);
  EXPECT_FALSE(follower.follows(0));
}

TEST(TrajectoryFollower, WhatIsPastIsPassedOver) {
  TrajectoryFollower follower(1);
  const JointTrajectory trajectory = trajectory_of(3);
  const double now = kStart + 1.3;
  EXPECT_FALSE(TrajectoryFollower::is_over(trajectory, now));
  follower.follow(trajectory, now, {5.0});
  expect_near(follower.at(0, now), {5.0, 0, follower.at(0, now).acceleration}, now);
  expect_near(follower.at(0, kStart + 2 + 0.5), polynomial(3, kStart + 2.5), 2.5);
  EXPECT_TRUE(TrajectoryFollower::is_over(trajectory, kStart + kTimes.back()));
}

TEST(TrajectoryFollower, AnotherOneReplacesItWhereItBeginsWithoutAJump) {
  for (const int degree : {3, 5}) {
    TrajectoryFollower follower(1);
    follower.follow(trajectory_of(degree), kStart, {0.3});
    JointTrajectory next = trajectory_of(degree);
    next.start = kStart + 1.7;  // in the future at the time 1.0
    for (JointTrajectory::Point& point : next.points) point.positions[0] += 1;
    follower.follow(next, kStart + 1.0, {0.0});
    for (const double time : {1.1, 1.5, 1.6999})
      expect_near(follower.at(0, kStart + time), polynomial(degree, kStart + time), time);
    const double h = 1e-9;
    const JointPoint before = follower.at(0, next.start - 2 * h), after = follower.at(0, next.start + h);
    EXPECT_NEAR(before.position, after.position, 10 * h * (1 + std::abs(before.velocity)));
    EXPECT_NEAR(before.velocity, after.velocity, 10 * h * (1 + std::abs(before.acceleration)) + 100 * h);
    EXPECT_NEAR(follower.at(0, next.start + 0.5).position, next.points[0].positions[0], kRoundOff);
    EXPECT_EQ(follower.end(0), next.start + kTimes.back());
  }
}

TEST(TrajectoryFollower, OtherJointsGoOnAsTheyWere) {
  TrajectoryFollower follower(3);
  follower.follow(trajectory_of(3, 0), kStart, {0.3});
  follower.follow(trajectory_of(5, 2), kStart + 1, {0.0});
  EXPECT_NEAR(follower.at(0, kStart + 2.2).position, polynomial(3, kStart + 2.2).position, kRoundOff);
  EXPECT_NEAR(follower.at(2, kStart + 2.2).position, polynomial(5, kStart + 2.2).position, kRoundOff);
  EXPECT_FALSE(follower.follows(1));
}

TEST(TrajectoryFollower, StopsAtOnceOrAtAConstantDeceleration) {
  TrajectoryFollower follower(1);
  follower.follow(trajectory_of(3), kStart, {0.3});
  const double now = kStart + 1;
  const JointPoint moving = follower.at(0, now);
  TrajectoryFollower other = follower;
  other.stop(0, now, 0);
  expect_near(other.at(0, now), {moving.position}, now);
  expect_near(other.at(0, now + 3), {moving.position}, now + 3);
  const double duration = 0.4;
  follower.stop(0, now, duration);
  for (const double t : {0.0, 0.1, 0.3999}) {
    const double a = -moving.velocity / duration;
    expect_near(follower.at(0, now + t),
                {moving.position + t * (moving.velocity + 0.5 * a * t), moving.velocity + a * t, a}, t);
  }
  expect_near(follower.at(0, now + 9), {moving.position + 0.5 * duration * moving.velocity}, 9);
  EXPECT_EQ(follower.end(0), now + duration);
}

TEST(TrajectoryFollower, LeavesWhatHasArrived) {
  TrajectoryFollower follower(1);
  follower.follow(trajectory_of(1), kStart, {0.3});
  follower.release_arrived(kStart + 3.499);
  EXPECT_TRUE(follower.follows(0));
  follower.release_arrived(kStart + 3.5);
  EXPECT_FALSE(follower.follows(0));
  follower.follow(trajectory_of(1), kStart, {0.3});
  follower.release(0);
  EXPECT_FALSE(follower.follows(0));
}

TEST(TrajectoryFollower, ForgetsOnlyWhatIsOver) {
  TrajectoryFollower follower(1);
  follower.follow(trajectory_of(5), kStart, {0.3});
  const TrajectoryFollower whole = follower;
  for (const double now : {-1.0, 0.0, 0.5, 0.6, 1.9999, 2.0, 3.5, 9.0}) {
    follower.forget_before(kStart + now);
    for (double time = std::max(now, 0.0); time < 10; time += 0.05)
      expect_near(follower.at(0, kStart + time), whole.at(0, kStart + time), time);
    EXPECT_EQ(follower.end(0), whole.end(0));
  }
  EXPECT_EQ(follower.piece_count(0), 1);
}

TEST(TrajectoryFollower, SaysWhatIsWrongWithATrajectory) {
  const TrajectoryFollower follower(2);
  const auto fault = [&](const auto& change) {
    JointTrajectory trajectory = trajectory_of(5);
    change(trajectory);
    return follower.find_fault(trajectory);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault([](JointTrajectory&) {}), "");
  EXPECT_EQ(fault([](JointTrajectory& t) { t.points.clear(); }), "");  // it stops the joints
  EXPECT_EQ(fault([](JointTrajectory& t) { t.joints.clear(); }), "it names no joint");
  EXPECT_EQ(fault([](JointTrajectory& t) { t.joints = {1, 1}; }), "it names a joint twice");
  EXPECT_EQ(fault([](JointTrajectory& t) { t.points[1].positions.clear(); }), "point 2 has 0 positions for 1 joints");
  EXPECT_EQ(fault([](JointTrajectory& t) {
              t.points[0].velocities = {1, 2};
            }),
            "point 1 has 2 velocities for 1 joints");
  EXPECT_EQ(fault([](JointTrajectory& t) {
              t.points[0].accelerations = {1, 2};
            }),
            "point 1 has 2 accelerations for 1 joints");
  EXPECT_EQ(fault([](JointTrajectory& t) { t.points[3].velocities.clear(); }),
            "point 4 has accelerations, but no velocities");
  EXPECT_EQ(fault([=](JointTrajectory& t) { t.points[2].accelerations = {nan}; }),
            "point 3 has a number that is not finite");
  EXPECT_EQ(fault([](JointTrajectory& t) { t.points[1].time = 0.5; }), "point 2 is not later than the one before");
  EXPECT_EQ(fault([=](JointTrajectory& t) { t.points[1].time = nan; }), "the time of point 2 is not a number >= 0");
}

}  // namespace
}  // namespace flexarm::node
