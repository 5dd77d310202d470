#include "analysis/statics.h"

#include <cmath>

#include "integrators/newton.h"

namespace flexarm {

StepResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                        State& state, std::vector<double>* update_norms) {
  using Updates = NewtonIteration::Updates;
  StepSystem system(model, statics_of(scheme));
  NewtonIteration newton(system, settings);
  StepResult result;
  State trial = state;
  // Full updates first: a beam that rolls up by several turns needs large rotations at once, and takes them well.
  const auto solve = [&](double factor) {
    for (const Updates updates : {Updates::Full, Updates::Limited}) {
      system.begin_equilibrium(trial, factor);
      if (newton.solve(updates, NewtonIteration::Factors::Fresh, result)) return true;
    }
    return false;
  };
  double factor = 0, increment = 1.0 / load_steps;
  const double smallest = std::ldexp(increment, -settings.max_halvings);
  while (factor < 1) {
    const double next = factor + increment > 1 - 1e-12 ? 1.0 : factor + increment;
    const bool is_solved = solve(next);
    if (update_norms) *update_norms = newton.update_norms();
    if (is_solved) {
      system.accept(trial);
      factor = next;
    } else {
      increment *= 0.5;
      if (increment < smallest) return result;
      ++result.halvings;
    }
  }
  state = trial;
  result.reason = StepResult::Reason::None;
  result.converged = true;
  return result;
}

}  // namespace flexarm
