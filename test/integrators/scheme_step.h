#pragma once
/// Test fixture: steps of every scheme from random states, to test residual and tangent of a step.

#include <gtest/gtest.h>

#include "integrators/consistent_tangent.h"
#include "integrators/mechanism.h"
#include "support/scheme_variants.h"

namespace flexarm::test {

/// The schemes with a consistent tangent. Symmetric middle functions are left out: their tangent neglects their
/// variation.
inline std::vector<SchemeVariant> with_consistent_tangent() {
  std::vector<SchemeVariant> variants;
  for (const SchemeVariant& variant : scheme_variants(0.2))
    if (variant.scheme.mid_functions == MidFunctions::Explicit) variants.push_back(variant);
  return variants;
}

class SchemeStep : public ::testing::TestWithParam<SchemeVariant> {
 protected:
  const Scheme& scheme() const { return GetParam().scheme; }

  /// Adds the scheme's own data to the state, with random values where possible.
  State prepared(State state, StepSystem& system, RandomSource& random) const {
    system.initialise(state);
    RandomSource of_memory(7);  // a generator of its own, so that all other random values are the same for all schemes
    for (StrainMemory& memory : state.strain_memory)
      memory = {0.1 * of_memory.vector6(), of_memory.vector6(), of_memory.vector6()};
    for (Vector6& force : state.study.forces) force = random.vector6();
    if (scheme().hht != HhtForm::None) state.study.reactions.resize(state.nodes.size());
    for (Vector6& reaction : state.study.reactions) reaction = random.vector6();
    for (Vector3& rate : state.study.momentum_rates) rate = random.vector();
    for (Vector3& rotation : state.study.total_rotations) rotation = 0.1 * random.vector();
    return state;
  }

  /// Compares tangent and differences in a step slow enough that smooth friction is not saturated and its slope counts.
  /// Friction changes over an increment of step * speed = 0.03.
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
  /// Whether the scheme has a beta correction. It divides by a work of the increments, so that the residual is
  /// nonlinear over a small part of the increments.
  bool divides_by_work() const {
    return scheme().correction == EnergyCorrection::AxialBeta || scheme().correction == EnergyCorrection::FullBeta;
  }
};

}  // namespace flexarm::test
