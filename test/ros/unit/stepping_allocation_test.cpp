// Tests that the thread that steps allocates nothing, with commands and wrenches that begin and end.
#include <exception>
#include <utility>

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
