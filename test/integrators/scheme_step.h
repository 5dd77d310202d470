#pragma once
/// Steps of every scheme from random states, for tests of the step's residual and tangent.

#include <gtest/gtest.h>

#include "integrators/consistent_tangent.h"
#include "integrators/mechanism.h"
#include "support/scheme_variants.h"

namespace flexarm::test {

/// The variants whose tangent is that of the residual: that of symmetric middle functions leaves their variation out.
inline std::vector<SchemeVariant> with_consistent_tangent() {
  std::vector<SchemeVariant> variants;
  for (const SchemeVariant& variant : scheme_variants(0.2))
    if (variant.scheme.mid_functions == MidFunctions::Explicit) variants.push_back(variant);
  return variants;
}

class SchemeStep : public ::testing::TestWithParam<SchemeVariant> {
 protected:
  const Scheme& scheme() const { return GetParam().scheme; }

  /// The state with what the scheme keeps in it, random where it may be.
  State prepared(State state, StepSystem& system, RandomSource& random) const {
    system.initialise(state);
    RandomSource of_memory(7);  // its own, so that all schemes that keep no more than this step from the same state
    for (StrainMemory& memory : state.strain_memory)
      memory = {0.1 * of_memory.vector6(), of_memory.vector6(), of_memory.vector6()};
    for (Vector6& force : state.forces) force = random.vector6();
    if (scheme().hht != HhtForm::None) state.reactions.resize(state.nodes.size());
    for (Vector6& reaction : state.reactions) reaction = random.vector6();
    for (Vector3& rate : state.momentum_rates) rate = random.vector();
    for (Vector3& rotation : state.total_rotations) rotation = 0.1 * random.vector();
    return state;
  }

  /// Slow enough that smooth friction is not saturated: its slope counts. The increment over which it changes is
  /// step * speed = 0.03.
  void expect_consistent_tangent_of_a_slow_step(const Model& model, unsigned seed) const {
    RandomSource random(seed);
    StepSystem system(model, scheme(), BackendChoice::Matrix);
    State state = prepared(random_state(model, random, 0.05), system, random);
    for (NodeState& node : state.nodes) {
      node.velocity *= 1e-3;
      node.angular_velocity *= 1e-3;
      node.acceleration.setZero();
      node.angular_acceleration.setZero();
    }
    system.begin(state, 30.0, Guess::Unchanged);
    system.update(random_update(system.degrees_of_freedom().unknowns, random, 0.01));
    expect_consistent_tangent(system, divides_by_work() ? 0.001 : 0.03);
  }
  /// A beta correction divides by a work of the increments: the residual changes its shape over a part of them.
  bool divides_by_work() const {
    return scheme().correction == EnergyCorrection::AxialBeta || scheme().correction == EnergyCorrection::FullBeta;
  }
};

}  // namespace flexarm::test
