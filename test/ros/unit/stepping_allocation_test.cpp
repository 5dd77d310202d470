// Tests that the thread that steps allocates nothing, with commands and wrenches that begin and end, and that streamed
// points need no more and more memory.
#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "stepping/stepping_thread.h"
#include "support/allocations.h"
#include "support/scene_builder.h"

namespace flexarm::node {
namespace {

/// A rotor with a servo.
Simulation rotor() {
  test::SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", scene::JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  scene::ServoDescription servo;
  servo.coordinate = "shaft";
  servo.kp = 100;
  servo.kd = 20;
  b.scene.servos.push_back(servo);
  return Simulation(b.scene);
}

TEST(SteppingThread, AllocatesNothingWhereWrenchesAndCommandsBeginAndEnd) {
  if (!test::kCountsAllocations) GTEST_SKIP() << "this C library's allocator cannot be counted";
  constexpr double kStep = 0.001;
  SteppingThread thread(rotor(), {}, [] {});
  ASSERT_TRUE(thread.advance());
  const std::size_t link = 1;
  for (int i = 0; i < 16; ++i)  // they begin one after the other, act together, and end
    thread.wrenches().add({link, {0.1, 0, 0}, {{0, 0.1, 0}, {0, 0, 0}}, false}, 2 * i * kStep, (100 + 2 * i) * kStep);
  thread.trajectories().follow({{0}, 0, {{0.1, {0.5}, {}, {}}}}, 0, {0.0});
  int steps = 0;
  EXPECT_EQ(test::allocations_in([&] {
              for (int n = 0; n < 200; ++n) {
                thread.take_commands();
                steps += thread.advance();
              }
            }),
            0);
  EXPECT_EQ(steps, 200);
  EXPECT_GT(thread.simulation().position(0), 0) << "what was asked for acts";
}

// A client streams points: each message replaces the one before, half of a period before that would be over. Two
// polynomials are kept at most: the one that is followed, and the one that replaces it.
TEST(TrajectoryFollower, StreamedPointsNeedNoMoreMemoryFromMessageToMessage) {
  if (!test::kCountsAllocations) GTEST_SKIP() << "this C library's allocator cannot be counted";
  constexpr double kPeriod = 0.02;  // [s]
  TrajectoryFollower follower(1);
  JointTrajectory trajectory{{0}, 10.0, {{1.5 * kPeriod, {0.3}, {0.0}, {}}}};
  const std::vector<double> set_points = {0.3};
  double largest_error = 0;
  std::size_t most_pieces = 0;
  const auto stream = [&](int messages) {
    for (int n = 0; n < messages; ++n) {
      const double now = trajectory.start += kPeriod;
      const JointPoint before = follower.follows(0) ? follower.at(0, now) : JointPoint{0.3};
      trajectory.points[0].positions[0] = 0.3 + 0.1 * std::sin(now);
      follower.follow(trajectory, now, set_points);
      follower.forget_before(now);
      largest_error = std::max(largest_error, std::abs(follower.at(0, now).position - before.position));
      most_pieces = std::max(most_pieces, follower.piece_count(0));
    }
  };
  stream(10);
  EXPECT_EQ(test::allocations_in([&] { stream(10000); }), 0);
  EXPECT_LE(most_pieces, 2);
  EXPECT_LE(largest_error, 1e-12);
}

TEST(SteppingThread, ThrowsWhatKeepsItFromBeginning) {
  if (!test::kCountsAllocations) GTEST_SKIP() << "this C library's allocator cannot be made to fail";
  constexpr long kStride = 37;
  int thrown = 0;
  for (long number = 0, is_over = 0; !is_over; number += kStride) {
    Simulation simulation = rotor();
    const bool came_to_it = test::without_allocation(number, [&] {
      try {
        SteppingThread thread(std::move(simulation), {}, [] {});
      } catch (const std::exception&) {  // the exception is caught, so the program continues
        ++thrown;
      }
    });
    is_over = !came_to_it;
  }
  EXPECT_GT(thrown, 10);
}

}  // namespace
}  // namespace flexarm::node
