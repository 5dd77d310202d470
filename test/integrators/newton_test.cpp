// Tests when Newton's method ends, and which error it leaves.
#include "integrators/newton.h"

#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "flexarm/scene/urdf_reader.h"
#include "integrators/stepper.h"
#include "simulation/observables.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

constexpr double kStep = 1e-3;
constexpr int kSteps = 100, kJump = 50;

/// A scene that moves freely, until a torque starts at step kJump.
struct Swing {
  Model model;
  Stepper stepper;
  State state = initial_state(model);
  int iterations = 0;

  Swing(const std::string& scene, const StepSettings& settings)
      : model(build_model(*scene::read_scene_file(test::source_path(scene)).scene)),
        stepper(model, schemes().front(), settings) {
    stepper.initialise(state);
    state.commands.assign(state.commands.size(), 0.0);
  }
  void advance(int step) {
    if (step == kJump) state.commands.assign(state.commands.size(), 1.0);
    const StepResult result = stepper.advance(state);
    ASSERT_TRUE(result.converged) << to_string(result.reason);
    iterations += result.iterations;
  }
};

StepSettings modified_newton(double tolerance) {
  StepSettings settings;
  settings.step = kStep;
  settings.tolerance = tolerance;
  return settings;
}

StepSettings full_newton() {
  StepSettings settings = modified_newton(1e-10);
  settings.max_halvings = 5;
  settings.reuse_factorisation = false;
  return settings;
}

/// Compares each step with a step of full Newton from the same state: positions may differ by at most `bound`, relative
/// to the size of the scene. Returns the number of iterations of all steps.
int iterations_within(double bound, const std::string& scene, double tolerance, int steps = kSteps) {
  Swing quick(scene, modified_newton(tolerance)), full(scene, full_newton());
  for (int step = 0; step < steps && !::testing::Test::HasFatalFailure(); ++step) {
    full.state = quick.state;
    full.stepper.invalidate();
    quick.advance(step);
    full.advance(step);
    double largest = 0;
    for (std::size_t i = 0; i < full.state.nodes.size(); ++i)
      largest = std::max(largest, (quick.state.nodes[i].position - full.state.nodes[i].position).norm());
    EXPECT_LE(largest, bound * full.model.length_scale) << scene << ", tolerance " << tolerance << ", step " << step;
  }
  return quick.iterations;
}

// The error left by a solve is at most the square of the tolerance. This also holds if the solve ends after one update
// because an earlier solve has shown that one is enough.
TEST(NewtonIteration, OneUpdateIsEnoughWhereItHasBeenShownToBe) {
  const std::string arm = "config/examples/flexible_two_link_arm.urdf";
  iterations_within(1e-8, arm, 1e-4);
  // It would be two iterations in each step if every solve had to show by itself which error it leaves.
  EXPECT_LT(iterations_within(1e-6, arm, 1e-3), 1.5 * kSteps);
}

// With the default tolerance, the remaining error is the round-off of a double times the condition number, up to 1e4.
// The ratio of the first two updates of a solve underestimates the error of kept factors: a criterion by this ratio
// alone left 3e-11.
TEST(NewtonIteration, KeptFactorsLeaveRoundOff) {
  for (const char* scene :
       {"config/examples/sliding_arm.urdf", "config/examples/cantilever.urdf", "config/speed/double_pendulum.urdf"})
    iterations_within(1e-12, scene, 1e-8, 600);
}

}  // namespace
}  // namespace flexarm
