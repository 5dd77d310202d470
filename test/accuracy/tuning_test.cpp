// Tests the search for the cheapest meshes and steps of a given accuracy, by the error of the result against a finer
// run.
#include "accuracy/tuning.h"

#include <gtest/gtest.h>

#include "accuracy/ramped_cantilever.h"
#include "flexarm/scene/urdf_reader.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

scene::SceneDescription scene_of(const std::string& path) {
  return scene::read_scene_file(test::source_path(path)).scene.value();
}

TuningResult tuned(TrialRuns& trials, const TuningGoal& goal) {
  return tune(trials, goal, {}, [](double, const std::string&) {});
}

/// Error against a run of another order, with a mesh and steps that are much finer than all that tuning tried.
double true_error(TrialRuns& trials, RunSettings settings) {
  const TrialRun& run = trials.run(settings);
  for (BeamResolution& beam : settings.beams) beam = {8, 4};
  settings.scheme = "em4";
  settings.step = trials.times().interval / 16;
  settings.tolerance = 1e-9;
  const TrialRun& truth = trials.run(settings);
  EXPECT_TRUE(truth.is_complete()) << truth.failure;
  return motion_error(run.motion, truth.motion, truth.motion.largest_displacement());
}

TEST(Tuning, KeepsTheAccuracyAndSavesTime) {
  for (const char* path : {"config/examples/rigid_double_pendulum.urdf", "config/speed/double_pendulum.urdf"})
    for (const double accuracy : {1e-2, 1e-4}) {
      TrialRuns trials(scene_of(path), test::kOneSecond, {}, {}, {});
      TuningGoal goal;
      goal.accuracy = accuracy;
      const TuningResult result = tuned(trials, goal);
      ASSERT_TRUE(result.is_met) << path << ": " << result.shortcoming;
      const TunedRun& best = result.runs.at(*result.best);
      EXPECT_LE(best.error, accuracy);
      EXPECT_LE(true_error(trials, best.settings), accuracy) << path;
      EXPECT_LT(result.reference_error, 0.2 * accuracy);
      EXPECT_LT(best.steps, result.runs.front().steps) << "the scene as it stands has steps of 1 or 2 ms";
      EXPECT_TRUE(result.shortcoming.empty()) << result.shortcoming;
    }
}

TEST(Tuning, SaysWhatWasReachedWhereTheAccuracyIsBeyondRoundOff) {
  TrialLimits limits;
  limits.seconds = 5;
  TrialRuns trials(scene_of("config/examples/rigid_double_pendulum.urdf"), {0.02, 5}, limits, {}, {});
  TuningGoal goal;
  goal.accuracy = 1e-16;
  const TuningResult result = tuned(trials, goal);
  EXPECT_FALSE(result.is_met);
  EXPECT_FALSE(result.shortcoming.empty());
  ASSERT_TRUE(result.best);
  EXPECT_LT(result.runs.at(*result.best).error, 1e-6) << "the most accurate run";
}

TEST(Tuning, EndsWithTheBestSoFar) {
  TuningGoal goal;
  goal.accuracy = 1e-2;
  int last_count = 0;
  for (const int most : {1, 8, 16}) {
    TrialLimits limits;
    limits.runs = most;
    TrialRuns trials(test::ramped_cantilever(""), test::kOneSecond, limits, {}, {});
    const TuningResult result = tuned(trials, goal);
    EXPECT_LE(static_cast<int>(result.runs.size()), most + 1);
    EXPECT_GE(static_cast<int>(result.runs.size()), last_count);
    last_count = static_cast<int>(result.runs.size());
    EXPECT_NE(result.shortcoming.find("the limit of the search"), std::string::npos) << result.shortcoming;
    EXPECT_EQ(result.best.has_value(), result.runs.size() > 1);
  }
}

TEST(Tuning, RefusesWhatDoesNotMove) {
  scene::SceneDescription scene = test::ramped_cantilever("");
  scene.loads.clear();
  TrialRuns trials(scene, test::kOneSecond, {}, {}, {});
  TuningGoal goal;
  goal.accuracy = 1e-2;
  const TuningResult result = tuned(trials, goal);
  EXPECT_FALSE(result.is_met);
  EXPECT_NE(result.shortcoming.find("no probe or tip moves"), std::string::npos) << result.shortcoming;
}

TEST(Tuning, KeepsWhatTheSceneConserves) {
  IntegratorDescription integrator;
  EXPECT_EQ(schemes_alike(integrator, false), (std::vector<std::string>{"auto", "em4", "rk4", "dop853"}));
  integrator.rho_infinity = 0.5;
  EXPECT_EQ(schemes_alike(integrator, false), (std::vector<std::string>{"auto"}));
  integrator = with_scheme(integrator, "newmark");
  EXPECT_EQ(schemes_alike(integrator, false), (std::vector<std::string>{"newmark"}));
  integrator = with_scheme(integrator, "em0");
  EXPECT_EQ(schemes_alike(integrator, false), (std::vector<std::string>{"em0", "em", "em4"}));
  EXPECT_GT(schemes_alike(integrator, true).size(), 4u);
}

}  // namespace
}  // namespace flexarm
