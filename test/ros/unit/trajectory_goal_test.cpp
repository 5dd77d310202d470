// Tests the outcome of a goal: tolerances on the path, at its end, and for some time after it.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "ros/trajectory_goal.h"

namespace flexarm::node {
namespace {

using Verdict = TrajectoryGoal::Verdict;

constexpr double kEnd = 5, kPatience = 0.5;  // [s]

/// A goal of two joints, the second of which has no tolerance.
TrajectoryGoal goal() {
  return {{3, 7}, {{0.1, 0.5}, {}}, {{0.01, 0.05}, {-1, -1}}, kEnd, kPatience};
}

TrajectoryGoal::Judgement judge(double time, double position, double velocity) {
  return goal().judge(time, {{1, 2}, {1, 2}}, {{1 + position, 2 + velocity}, {50, -60}});
}

TEST(TrajectoryGoal, IsOffItsPathBeyondItsTolerances) {
  EXPECT_EQ(judge(1, 0.099, -0.499).verdict, Verdict::Underway);
  const TrajectoryGoal::Judgement place = judge(1, -0.11, 0), rate = judge(1, 0, 0.6);
  EXPECT_EQ(place.verdict, Verdict::OffPath);
  EXPECT_EQ(place.joint, 0u);
  EXPECT_STREQ(place.quantity, "position");
  EXPECT_NEAR(place.error, 0.11, 1e-15);
  EXPECT_EQ(place.allowed, 0.1);
  EXPECT_EQ(rate.verdict, Verdict::OffPath);
  EXPECT_STREQ(rate.quantity, "velocity");
}

TEST(TrajectoryGoal, IsReachedWithinItsTolerancesInTime) {
  EXPECT_EQ(judge(kEnd, 0.009, 0.04).verdict, Verdict::Reached);
  for (const double time : {kEnd, kEnd + kPatience - 1e-6}) {
    EXPECT_EQ(judge(time, 0.05, 0).verdict, Verdict::Underway);
    EXPECT_EQ(judge(time, 0, 0.06).verdict, Verdict::Underway);
    EXPECT_EQ(judge(time, 0.2, 0).verdict, Verdict::Underway) << "the path is at its end";
  }
  EXPECT_EQ(judge(kEnd + kPatience, 0.05, 0).verdict, Verdict::NotReached);
  EXPECT_EQ(judge(kEnd + kPatience, 0, 0.06).verdict, Verdict::NotReached);
  EXPECT_EQ(judge(kEnd + kPatience, 0, 0).verdict, Verdict::Reached);
}

control::JointTolerance tolerance(const std::string& joint, double position, double velocity) {
  control::JointTolerance out;
  out.name = joint;
  out.position = position;
  out.velocity = velocity;
  return out;
}

TEST(TrajectoryGoal, ToleranceIsOfTheJointThatItNames) {
  const std::vector<control::JointTolerance> given = {tolerance("elbow", 0.1, 0.2), tolerance("wrist", 0.3, 0.4)};
  EXPECT_EQ(fault_of_tolerances(given, {"shoulder", "wrist", "elbow"}), "");
  // A goal without points stops all moving joints, whichever joints it names.
  const std::vector<JointTolerance> of_moving = tolerances_of(given, {"wrist", "shoulder"});
  ASSERT_EQ(of_moving.size(), 2u);
  EXPECT_EQ(of_moving[0].position, 0.3);
  EXPECT_EQ(of_moving[0].velocity, 0.4);
  EXPECT_EQ(of_moving[1].position, 0) << "as far as it likes";
  EXPECT_TRUE(tolerances_of(given, {}).empty());
}

TEST(TrajectoryGoal, TolerancesOfOthersAreRefused) {
  EXPECT_NE(fault_of_tolerances({tolerance("elbow", 0.1, 0)}, {"wrist"}).find("'elbow'"), std::string::npos);
  EXPECT_NE(fault_of_tolerances({tolerance("elbow", NAN, 0)}, {"elbow"}).find("not finite"), std::string::npos);
}

TEST(TrajectoryGoal, WantsATolerancePerJoint) {
  const TrajectoryGoal two_for_one{{0}, {{}, {0.1, 0}}, {{}}, kEnd, 0};
  EXPECT_THROW(two_for_one.judge(kEnd, {{}}, {{}}), std::invalid_argument);
  EXPECT_THROW(goal().judge(1, {{1, 2}}, {{1, 2}}), std::invalid_argument);
}

TEST(TrajectoryGoal, WithoutTolerancesItIsReachedAtItsEnd) {
  const TrajectoryGoal any{{0}, {{}}, {{}}, kEnd, 0};
  EXPECT_EQ(any.judge(kEnd - 1e-3, {{}}, {{9, 9}}).verdict, Verdict::Underway);
  EXPECT_EQ(any.judge(kEnd, {{}}, {{9, 9}}).verdict, Verdict::Reached);
}

}  // namespace
}  // namespace flexarm::node
