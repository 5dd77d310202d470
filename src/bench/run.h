#pragma once
/// What all measurements share: a simulation of a scene with a scheme, and runs that may fail.

#include <cmath>
#include <optional>

#include "bench/variants.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {

/// Where a run ended before its time.
struct Failure {
  double time;  ///< [s]
  StepResult::Reason reason;
};

/// What a measurement gave, or why it gave nothing.
template <class Value>
struct Measured {
  std::optional<Failure> failure;
  Value value;
};

/// `tolerance`: of Newton's method; tight, so that what is measured is the scheme.
inline Simulation simulation(scene::SceneDescription scene, const Variant& variant, double step,
                             double tolerance = 1e-11) {
  scene.integrator = variant.integrator;
  scene.integrator.step = step;
  scene.integrator.tolerance = tolerance;
  return Simulation(std::move(scene));
}

/// `steps` steps, observe(result) after each that converged.
template <class Observe>
std::optional<Failure> run(Simulation& simulation, int steps, const Observe& observe) {
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    if (!result.converged) return Failure{simulation.time(), result.reason};
    observe(result);
  }
  return std::nullopt;
}

inline std::optional<Failure> run(Simulation& simulation, int steps) {
  return run(simulation, steps, [](const StepResult&) {});
}

}  // namespace flexarm::bench
