// Tests simulations that are stepped together: bits, which of them are worked on, and exceptions.
#include "flexarm/simulation/batch.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/refusal.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

Simulation arm(double length) {
  SceneBuilder b;
  b.beam("upper", {{length, 0, 0}}, section(4e3, 2e3, 40, 60, 1, 0.01, 0.005), 2, 2);
  b.joint("shoulder", scene::JointKind::Continuous, "world", "upper", Vector3::Zero(), Vector3::UnitY());
  b.probe("tip", "upper", {length, 0, 0});
  b.scene.gravity = {0, 0, -9.81};
  return Simulation(b.scene);
}

TEST(Batch, HasTheBitsOfSingleSimulations) {
  for (const int threads : {0, 1, 2, 5}) {
    std::vector<std::shared_ptr<Simulation>> arms;
    std::vector<Simulation> alone;
    for (int i = 0; i < 7; ++i) {
      alone.push_back(arm(1 + 0.1 * i));
      alone.back().set_joint_state({{0, 0.1 * i, 1.0}});
      arms.push_back(std::make_shared<Simulation>(alone.back().copy()));
    }
    Batch batch(arms, threads);
    EXPECT_EQ(batch.size(), 7u);
    if (threads > 0) {
      EXPECT_EQ(batch.threads(), threads);
    }
    std::vector<StepResult> results;
    for (int n = 0; n < 30; ++n) {
      for (std::size_t i = 0; i < alone.size(); ++i) {
        alone[i].command_effort(0, 0.1 * n);
        batch[i].command_effort(0, 0.1 * n);
        ASSERT_TRUE(alone[i].step().converged);
      }
      batch.step(results);
      ASSERT_EQ(results.size(), 7u);
      for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_TRUE(results[i].converged);
        EXPECT_EQ(batch[i].probe_pose(0).position, alone[i].probe_pose(0).position) << i;
        EXPECT_EQ(batch[i].energies().total(), alone[i].energies().total()) << i;
      }
    }
  }
}

TEST(Batch, CallsEachOnce) {
  Batch batch(arm(1), 100, 3);
  std::vector<int> calls(100, 0);
  for (int round = 1; round <= 200; ++round) {
    batch.for_each([&](std::size_t i) { ++calls[i]; });
    ASSERT_EQ(calls, std::vector<int>(100, round));
  }
}

TEST(Batch, ThrowsTheFirstExceptionInTheEnd) {
  Batch batch(arm(1), 20, 3);
  std::atomic<int> calls{0};
  const auto work = [&](std::size_t i) {
    ++calls;
    if (i % 5 == 2) throw std::runtime_error(std::to_string(i));
  };
  for (int repeat = 0; repeat < 20; ++repeat) {
    calls = 0;
    EXPECT_EQ(refusal<std::runtime_error>([&] { batch.for_each(work); }), "2");
    EXPECT_EQ(calls, 20);
  }
}

TEST(Batch, RefusesWhatIsNoBatch) {
  const auto one = std::make_shared<Simulation>(arm(1));
  EXPECT_THROW(Batch({}, 1), std::invalid_argument);
  EXPECT_THROW(Batch({one, one}), std::invalid_argument);
  EXPECT_THROW(Batch({one, nullptr}), std::invalid_argument);
  EXPECT_THROW(Batch({one}, -1), std::invalid_argument);
  EXPECT_THROW(Batch(*one, 0), std::invalid_argument);
  EXPECT_THROW(Batch({one})[1], std::out_of_range);
}

}  // namespace
}  // namespace flexarm::test
