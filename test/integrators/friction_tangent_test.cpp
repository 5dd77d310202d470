// The tangent of a step with friction that grows with the force on the joint: slipping, held, and in the smooth law.
#include <gtest/gtest.h>

#include "integrators/consistent_tangent.h"
#include "integrators/mechanism.h"
#include "support/scheme_variants.h"

namespace flexarm {
namespace {

using namespace test;

/// Over longer updates the magnitude of a force that nearly vanishes bends, and a slider comes to the border of its
/// element, where the line's tangent has a kink.
constexpr double kShort = 0.03;

class FrictionTangent : public ::testing::TestWithParam<SchemeVariant> {
 protected:
  const Scheme& scheme() const { return GetParam().scheme; }
  Model rubbing_model(bool sticks) const {
    Model model = build_model(every_joint_scene(false));
    for (Coordinate& coordinate : model.coordinates) {
      coordinate.sticks = sticks;
      coordinate.friction_coefficient = coordinate.is_angle ? 0 : 0.4;
    }
    return model;
  }
  State prepared(State state, StepSystem& system, RandomSource& random) const {
    system.initialise(state);
    for (StrainMemory& memory : state.strain_memory) memory = {0.1 * random.vector6(), random.vector6()};
    for (Vector6& force : state.forces) force = random.vector6();
    if (scheme().hht != HhtForm::None) state.reactions.resize(state.nodes.size());
    for (Vector6& reaction : state.reactions) reaction = random.vector6();
    for (Vector3& rate : state.momentum_rates) rate = random.vector();
    for (Vector3& rotation : state.total_rotations) rotation = 0.1 * random.vector();
    return state;
  }
};

/// The tangent of symmetric middle functions leaves their variation out; compositions refuse friction that sticks.
std::vector<SchemeVariant> with_consistent_tangent() {
  std::vector<SchemeVariant> variants;
  for (const SchemeVariant& variant : scheme_variants(0.2))
    if (variant.scheme.mid_functions == MidFunctions::Explicit) variants.push_back(variant);
  return variants;
}

TEST_P(FrictionTangent, Slipping) {
  const Model model = rubbing_model(true);
  RandomSource random(21);
  StepSystem system(model, scheme());
  const State state = prepared(random_state(model, random, 0.15), system, random);
  system.begin(state, 0.2, StepSystem::Guess::Extrapolated);
  system.update(random_update(system.assembler().unknowns(), random, 0.1));
  expect_consistent_tangent(system, kShort);
}

TEST_P(FrictionTangent, Held) {
  const Model model = rubbing_model(true);
  RandomSource random(32);
  StepSystem system(model, scheme());
  State state = prepared(random_state(model, random, 0.15), system, random);
  for (std::size_t i = 0; i < state.rests.size(); ++i) state.rests[i] = i % 2;
  system.begin(state, 0.2, StepSystem::Guess::Unchanged);
  system.update(random_update(system.assembler().unknowns(), random, 0.1));
  expect_consistent_tangent(system, kShort);
}

// Slow enough that the smooth law is not saturated; the increment over which it changes is step * speed = 0.03.
TEST_P(FrictionTangent, Smooth) {
  const Model model = rubbing_model(false);
  RandomSource random(23);
  StepSystem system(model, scheme());
  State state = prepared(random_state(model, random, 0.05), system, random);
  for (NodeState& node : state.nodes) {
    node.velocity *= 1e-3;
    node.angular_velocity *= 1e-3;
    node.acceleration.setZero();
    node.angular_acceleration.setZero();
  }
  system.begin(state, 30.0, StepSystem::Guess::Unchanged);
  system.update(random_update(system.assembler().unknowns(), random, 0.01));
  // A beta correction divides by a work of the increments, here 0.01: the residual changes its shape over a part of
  // that.
  const bool divides =
      scheme().correction == EnergyCorrection::AxialBeta || scheme().correction == EnergyCorrection::FullBeta;
  expect_consistent_tangent(system, divides ? 0.001 : 0.03);
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, FrictionTangent, ::testing::ValuesIn(with_consistent_tangent()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace flexarm
