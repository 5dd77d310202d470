#pragma once
/// Code that all measurements share: a simulation of a scene with a scheme, and runs that may fail.

#include <cmath>
#include <optional>

#include "bench/variants.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::bench {

/// The failure that ended a run early.
struct Failure {
  double time;  ///< [s]
  StepResult::Reason reason;
};

/// The result of a measurement, or the failure that prevented it.
template <class Value>
struct Measured {
  std::optional<Failure> failure;
  Value value;
};

/// Makes a simulation. `tolerance`: of Newton's method; it is tight, so that only errors of the scheme are measured.
inline Simulation simulation(scene::SceneDescription scene, const Variant& variant, double step,
                             double tolerance = 1e-11) {
  scene.integrator = variant.integrator;
  scene.integrator.step = step;
  scene.integrator.tolerance = tolerance;
  return Simulation(std::move(scene));
}

/// Makes `steps` steps; calls observe(result) after each step that converged.
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
