// Compares the tangent of a step with differences of the residual, for friction that grows with the force on the joint:
// slipping, sticking, and in the smooth law.
#include "integrators/scheme_step.h"

namespace flexarm {
namespace {

using namespace test;

/// Size of the updates. Longer updates reach two kinds of kinks: the magnitude of a force that nearly vanishes, and a
/// slider at the border of its element.
constexpr double kShort = 0.03;

class FrictionTangent : public SchemeStep {
 protected:
  Model rubbing_model(bool sticks) const {
    Model model = build_model(every_joint_scene(false));
    for (Coordinate& coordinate : model.coordinates) {
      coordinate.sticks = sticks;
      coordinate.friction_coefficient = coordinate.is_angle ? 0 : 0.4;
      coordinate.static_ratio = 1.7;
      coordinate.stribeck_speed = 0.8;
    }
    return model;
  }
};

TEST_P(FrictionTangent, Slipping) {
  const Model model = rubbing_model(true);
  RandomSource random(21);
  StepSystem system(model, scheme(), BackendChoice::Matrix);
  const State state = prepared(random_state(model, random, 0.15), system, random);
  system.begin(state, 0.2, Guess::Extrapolated);
  system.update(random_update(system.degrees_of_freedom().unknowns, random, 0.1));
  expect_consistent_tangent(system, kShort);
}

TEST_P(FrictionTangent, Held) {
  const Model model = rubbing_model(true);
  RandomSource random(32);
  StepSystem system(model, scheme(), BackendChoice::Matrix);
  State state = prepared(random_state(model, random, 0.15), system, random);
  for (std::size_t i = 0; i < state.rests.size(); ++i) state.rests[i] = i % 2;
  system.begin(state, 0.2, Guess::Unchanged);
  system.update(random_update(system.degrees_of_freedom().unknowns, random, 0.1));
  expect_consistent_tangent(system, kShort);
}

TEST_P(FrictionTangent, Smooth) {
  expect_consistent_tangent_of_a_slow_step(rubbing_model(false), 23);
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, FrictionTangent, ::testing::ValuesIn(with_consistent_tangent()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm
