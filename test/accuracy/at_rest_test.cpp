/// Tests runs to an accuracy, and the search for settings, where nothing moves.

#include "accuracy/automatic_meshes.h"
#include "accuracy/tuning.h"
#include "flexarm/accuracy/accurate_run.h"
#include "simulation/inside.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// A link on a hinge without weight.
std::string link_at_rest(const std::string& scheme, const std::string& more = "") {
  return robot(body("a", 1, Vector3::Constant(0.05), {0.5, 0, 0}) +
                   joint("h", "revolute", "world", "a",
                         "<axis xyz='0 -1 0'/> <limit lower='-3' upper='3' effort='100' velocity='5'/>") +
                   more,
               gravity({0, 0, more.empty() ? 0 : -9.81}) + "<integrator scheme='" + scheme +
                   "'/> <initial equilibrium='true'/> <probe name='tip' link='a' at='1 0 0'/>");
}

const char* const kServo = R"(<servo joint="h" mode="position" kp="400" kd="20" ki="800" set_point="0.3"/>)";

/// A beam with a load at its end that rests in its equilibrium, with a mesh that the search may choose.
std::string hanging_beam() {
  return robot(R"(<link name="beam"> <beam> <centerline> <line to="0.6 0 0"/> </centerline> <circle radius="0.006"/>
      <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>)" +
                   body("hand", 1, Vector3::Constant(1e-3)) + joint("clamp", "fixed", "world", "beam") +
                   joint("grip", "fixed", "beam", "hand", "<origin xyz='0.6 0 0'/>"),
               "<initial equilibrium='true'/> <probe name='hand' link='hand'/>");
}

AccurateRun run_of(const scene::SceneDescription& scene, double accuracy) {
  Simulation simulation(scene);
  RunWatcher nobody;
  return run_to_accuracy(simulation, {accuracy, 1}, nobody);
}

/// The true motion is none. Errors are relative to the size of the mechanism.
TEST(AtRest, EndsAtOnceWithEachScheme) {
  for (const char* scheme : {"auto", "em", "em4", "rk4", "dop853", "newmark"})
    for (const char* servo : {"", kServo}) {
      const scene::SceneDescription scene = scene_of(link_at_rest(scheme, servo));
      const AccurateRun run = run_of(scene, 1e-4);
      EXPECT_EQ(run.end, AccurateRun::End::Met) << scheme << servo;
      EXPECT_LE(run.steps, 1000) << scheme << servo;
      EXPECT_LT(run.estimate(), 1e-9) << scheme << servo;
      EXPECT_LT(run.motion.largest_displacement(), 1e-9) << scheme << servo;
      EXPECT_EQ(run.scale, model_of(Simulation(scene)).length_scale) << scheme << servo;
    }
}

/// What the equilibrium has left swings undamped, with periods down to microseconds that no try resolves.
TEST(AtRest, EndsAtOnceInAnEquilibrium) {
  const AccurateRun run = run_of(scene_of(hanging_beam()), 1e-4);
  EXPECT_EQ(run.end, AccurateRun::End::Met);
  EXPECT_LE(run.steps, 1000);
  EXPECT_LT(run.motion.largest_displacement(), 1e-8);
  EXPECT_LT(run.estimate(), 1e-8);
}

/// Only shapes at rest can differ between meshes. Elements of order 2 have no error for the shape of a beam with a load
/// at its end that bends little (docs/notes/tuning.md 3), and this one hardly bends by its own weight.
TEST(AtRest, MeshesAreChosenByShapes) {
  TrialRuns trials(scene_of(hanging_beam()), {0.01, 100}, {}, {}, {});
  const AutomaticMeshes meshes = automatic_meshes(trials, 1e-4);
  EXPECT_TRUE(meshes.is_met) << meshes.shortcoming;
  EXPECT_LE(meshes.settings.beams.at(0).elements.value_or(99), 4);
  EXPECT_LT(meshes.error, 1e-4);
  EXPECT_LE(meshes.runs, 12);
}

/// No motion shows which settings are good.
TEST(AtRest, TuningRefusesAtOnce) {
  TrialRuns trials(scene_of(hanging_beam()), {0.01, 100}, {}, {}, {});
  TuningGoal goal;
  goal.accuracy = 1e-4;
  const TuningResult result = tune(trials, goal, {}, [](double, const std::string&) {});
  EXPECT_FALSE(result.is_met);
  EXPECT_NE(result.shortcoming.find("no probe or tip moves"), std::string::npos) << result.shortcoming;
  EXPECT_LE(result.runs.size(), 5u);
}

}  // namespace
}  // namespace flexarm::test
