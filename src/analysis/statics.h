#pragma once
/// Equilibria under gravity and loads.

#include <vector>

#include "flexarm/model/results.h"
#include "integrators/step_settings.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Finds an equilibrium under gravity and loads, with the scheme's interpolation. Prescribed motions are held at time
/// 0, all other released coordinates are solved for. If loads have a potential and joints are not held firmly, the
/// search is a Descent. Otherwise gravity and loads grow in `load_steps` equal steps, and each step is solved by
/// Newton's method or, if that fails, by Settling. An unstable equilibrium is left along its unstable motion, unless
/// `wanted` allows it. On success `state` is at rest in the equilibrium; on failure it is untouched. `update_norms`:
/// those of the last solve.
StaticResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                          Equilibrium wanted, State& state, std::vector<double>* update_norms = nullptr);

/// Refines an equilibrium of solve_static() to one that steps of the scheme leave at rest, up to round-off. This is
/// needed because Newton's tolerance is far above round-off, and because the steps of the EM family test moments by
/// other functions, which makes a difference of the size of the elements' error. Returns false, and leaves `state`
/// untouched, if there is none.
bool sharpen_equilibrium(const Model& model, const Scheme& scheme, const StepSettings& settings, State& state);

}  // namespace flexarm
