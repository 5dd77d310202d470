// Tests the search for the cheapest run with fixed steps that is accurate enough, as part of the benchmark.
#include "bench/best_fixed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {
namespace {

scene::SceneDescription slider(const std::string& joint, const std::string& rest, const std::string& initial) {
  scene::ReadResult read = scene::read_scene_text(
      R"(<robot name="slider"> <link name="world"/>
<link name="a"> <inertial> <mass value="2"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
<joint name="s" type="prismatic"> <parent link="world"/> <child link="a"/> <axis xyz="1 0 0"/>)" +
          joint + "</joint>" + rest + R"(<simulation> <gravity xyz="0 0 0"/> <initial joint="s" )" + initial +
          R"(/> <probe name="p" link="a"/> </simulation> </robot>)",
      "slider");
  EXPECT_TRUE(read.scene) << scene::to_text(read.diagnostics);
  return std::move(*read.scene);
}

constexpr const char* kFree = R"(<limit lower="-9" upper="9" effort="0" velocity="0"/>)";
constexpr double kFrequency = 5;  // for m = 2 and k = 50 [1/s]

JudgedMotion vibration(const JudgedTimes& times) {
  JudgedMotion motion(1);
  for (int i = 0; i <= times.intervals; ++i) motion.add({Vector3(std::cos(kFrequency * i * times.interval), 0, 0)});
  return motion;
}

/// Parameter: the scheme that the scene names.
class BestFixedOfScheme : public ::testing::TestWithParam<const char*> {};

TEST_P(BestFixedOfScheme, IsAccurateEnoughAndNotByLuck) {
  scene::SceneDescription scene = slider(kFree, R"(<spring joint="s" stiffness="50"/>)", R"(position="1")");
  scene.integrator.scheme = GetParam();
  const JudgedTimes times{0.02, 100};
  int asked = 0;
  FixedRuns runs(scene, times, {}, vibration(times), 100, [&] { ++asked; });
  for (const double error : {1e-2, 1e-4}) {
    const FixedRuns::Run* best = runs.best(error);
    ASSERT_NE(best, nullptr);
    EXPECT_LE(best->error, error);
    EXPECT_GT(best->iterations, 0);
    EXPECT_GT(runs.time_again(*best), 0);
    // The midpoint rule's phase has the relative error (omega h)^2 / 12. Over a time T much longer than a period, the
    // root mean square of the position error is omega T (omega h)^2 / 12 / sqrt 6 of an amplitude. The motion has a
    // range of 2 amplitudes.
    if (best->settings.scheme == "em") {
      const double phase = std::pow(kFrequency * best->settings.step, 2) / 12 * kFrequency * times.until();
      EXPECT_NEAR(best->error, phase / std::sqrt(6) / 2, 0.2 * phase / std::sqrt(6) / 2 + 1e-6);
    }
  }
  EXPECT_GT(asked, 2);
  // Without time, no result is found.
  FixedRuns none(scene, times, {}, vibration(times), -1, [] {});
  EXPECT_EQ(none.best(1e-2), nullptr);
}

INSTANTIATE_TEST_SUITE_P(AutoAndEm, BestFixedOfScheme, ::testing::Values("auto", "em"));

TEST(BestFixed, ShiftedStepsEndWithTheIntervals) {
  const scene::SceneDescription scene = slider(kFree, R"(<spring joint="s" stiffness="50"/>)", R"(position="1")");
  const JudgedTimes times{0.02, 100};
  RunSettings settings = settings_of(scene);
  settings.step = 0.001;
  const std::optional<JudgedMotion> motion = shifted_motion(scene, settings, times, {}, 100);
  ASSERT_TRUE(motion);
  const JudgedMotion truth = vibration(times);
  ASSERT_EQ(motion->points[0].size(), truth.points[0].size());
  const double phase = std::pow(kFrequency * settings.step, 2) / 12 * kFrequency * times.until();
  EXPECT_LT(motion_error(*motion, truth, truth.largest_displacement()), phase / 2);
  EXPECT_FALSE(shifted_motion(scene, settings, times, {}, 0));
}

// In fine steps, a stop has the restitution of the scene (notes/stops.md), i.e. the law that the references solve.
TEST(BestFixed, StopsThrowBackWhatTheSceneSays) {
  for (const double restitution : {0.1, 0.3, 0.7}) {
    const scene::SceneDescription scene =
        slider("<limit lower=\"-9\" upper=\"0.001\" effort=\"0\" velocity=\"0\" restitution=\"" +
                   std::to_string(restitution) + "\"/>",
               "", R"(velocity="1")");
    Simulation simulation(scene);
    simulation.set_step_size(4e-6);  // 1e-3 of the oscillator's angle in a contact of 10 ms
    double before = 0, x = 0;
    for (int i = 0; i < 8000; ++i) {
      ASSERT_TRUE(simulation.step().converged);
      before = x;
      x = simulation.probe_pose(0).position.x();
    }
    // The contact begins and ends within a step, 1e-3 of its angle.
    EXPECT_NEAR((x - before) / 4e-6, -restitution, 5e-3 * restitution + 1e-3);
  }
}

}  // namespace
}  // namespace flexarm::bench
