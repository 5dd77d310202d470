// Tests estimates of the errors of step sizes against runs with much finer steps.
#include "accuracy/step_errors.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr JudgedTimes kHalfSecond{0.02, 25};

scene::SceneDescription pendulum() {
  return scene::read_scene_file(test::source_path("config/examples/rigid_double_pendulum.urdf")).scene.value();
}

/// A scene without kinks, so that errors fall with the order of the scheme.
scene::SceneDescription smooth_arm() {
  return scene::read_scene_file(test::source_path("config/speed/six_joint_arm.urdf")).scene.value();
}

TEST(StepErrors, AreThoseAgainstTheTruth) {
  TrialRuns trials(smooth_arm(), kHalfSecond, {}, {}, {});
  RunSettings settings = settings_of(trials.scene()), fine = settings;
  fine.scheme = "em4";
  fine.step = kHalfSecond.interval / 32;
  fine.tolerance = 1e-10;
  const TrialRun& truth = trials.run(fine);
  const double scale = truth.motion.largest_displacement();
  settings.tolerance = fine.tolerance;
  for (const auto& [scheme, wanted] : {std::pair("em", 1e-4), {"em4", 1e-6}}) {
    settings.scheme = scheme;
    const StepErrors errors = measure_steps(trials, settings, wanted, kInfinity);
    EXPECT_TRUE(errors.is_met) << errors.shortcoming;
    EXPECT_LE(errors.finest(), wanted * scale);
    for (std::size_t i = errors.runs.size() - 2; i < errors.runs.size(); ++i)
      // In the asymptotic range, the next power of the step is at most a quarter of the error.
      EXPECT_NEAR(motion_error(errors.runs[i]->motion, truth.motion, scale), size(errors.errors[i]) / scale,
                  0.25 * size(errors.errors[i]) / scale)
          << scheme;
  }
}

TEST(StepErrors, BetweenRunsFollowTheOrder) {
  TrialRuns trials(pendulum(), kHalfSecond, {}, {}, {});
  const StepErrors errors = measure_steps(trials, settings_of(trials.scene()), 1e-4, kInfinity);
  ASSERT_TRUE(errors.is_met);
  const int finest = errors.parts.back();
  const double last = size(errors.at(finest)), finer = size(errors.at(3 * finest));
  EXPECT_EQ(last, errors.finest());
  EXPECT_NEAR(std::log(last / finer) / std::log(3), 2, 0.2);
  EXPECT_GT(size(errors.at(3 * finest / 4)), last);
  EXPECT_LT(size(errors.at(3 * finest / 4)), size(errors.at(finest / 2)));
}

TEST(StepErrors, EndAtRoundOff) {
  TrialRuns trials(pendulum(), {0.02, 5}, {}, {}, {});
  RunSettings settings = settings_of(trials.scene());
  settings.scheme = "em4";
  const StepErrors errors = measure_steps(trials, settings, 1e-15, kInfinity);
  EXPECT_FALSE(errors.is_met);
  EXPECT_NE(errors.shortcoming.find("smaller steps do not help"), std::string::npos) << errors.shortcoming;
}

TEST(StepErrors, EndWhereRunsTakeTooLong) {
  TrialRuns trials(pendulum(), kHalfSecond, {}, {}, {});
  const StepErrors errors = measure_steps(trials, settings_of(trials.scene()), 1e-12, 1e-3);
  EXPECT_FALSE(errors.is_met);
  EXPECT_NE(errors.shortcoming.find("given up"), std::string::npos) << errors.shortcoming;
}

TEST(JudgedTimes, AreRoundMultiplesOfTheStep) {
  EXPECT_NEAR(judged_times(10, 1e-3, 150).interval, 0.1, 1e-12);
  EXPECT_EQ(judged_times(10, 1e-3, 150).intervals, 100);
  EXPECT_NEAR(judged_times(30, 0.1, 150).interval, 0.2, 1e-12);
  EXPECT_EQ(judged_times(1e-3, 0.01, 150).intervals, 2) << "fewer would not make a trajectory";
}

}  // namespace
}  // namespace flexarm
