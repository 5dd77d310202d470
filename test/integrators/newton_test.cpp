// How Newton's method judges that it has arrived.
#include "integrators/newton.h"

#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "flexarm/scene/urdf_reader.h"
#include "integrators/stepper.h"
#include "simulation/observables.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

constexpr double kStep = 1e-3, kTolerance = 1e-3;
constexpr int kSteps = 100, kJump = 50;

/// Arms that swing freely; at step kJump a torque starts.
struct Swing {
  Model model =
      build_model(*scene::read_scene_file(test::source_path("config/examples/flexible_two_link_arm.urdf")).scene);
  Stepper stepper;
  State state = initial_state(model);
  int iterations = 0;

  explicit Swing(const StepSettings& settings) : stepper(model, schemes().front(), settings) {
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

// What a solve leaves is at most the square of the tolerance, also where an earlier one has been taken at its word:
// each step beside one of full Newton from the same state.
TEST(NewtonIteration, OneUpdateIsEnoughWhereItHasBeenShownToBe) {
  Swing quick({kStep, kTolerance}), full({kStep, 1e-10, 20, 5, false});
  const double bound = kTolerance * kTolerance * full.model.length_scale;
  for (int step = 0; step < kSteps; ++step) {
    full.state = quick.state;
    full.stepper.invalidate();
    ASSERT_NO_FATAL_FAILURE(quick.advance(step));
    ASSERT_NO_FATAL_FAILURE(full.advance(step));
    for (std::size_t i = 0; i < full.state.nodes.size(); ++i)
      ASSERT_LE((quick.state.nodes[i].position - full.state.nodes[i].position).norm(), bound) << "step " << step;
  }
  // Two in each step where every solve has to show by itself what it leaves.
  EXPECT_LT(quick.iterations, 1.5 * kSteps);
}

}  // namespace
}  // namespace flexarm
