#include "integrators/dissipative_substitute.h"

#include <algorithm>

#include "integrators/conserving_beams.h"
#include "integrators/energies.h"
#include "model/room_for_wrenches.h"

namespace flexarm {
namespace {

Scheme dissipative_scheme(const Scheme& scheme, double step) {
  Scheme out = *find_scheme("edmc2");
  out.dissipation = numerical_dissipation(out.order, kDefaultRho, step);
  // Dampers and stops have the same constants as in the scheme that is replaced.
  out.damping_relaxation = scheme.damping_relaxation;
  out.blur = scheme.blur;
  out.may_be_planar = scheme.may_be_planar;
  return out;
}

/// Settings for the stepper of the substitute, which must not have a substitute itself.
StepSettings without_substitute(StepSettings settings) {
  settings.on_failure = OnFailure::Stop;
  return settings;
}

}  // namespace

DissipativeSubstitute::DissipativeSubstitute(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : model_(model),
      scheme_(scheme),
      dissipative_(dissipative_scheme(scheme, settings.step)),
      stepper_(model, dissipative_, without_substitute(settings)) {
  begin_.wrenches.reserve(kRoomForWrenches);
  trial_.wrenches.reserve(kRoomForWrenches);
}

bool DissipativeSubstitute::advance(State& state, const Deadline& deadline, StepResult& result) {
  trial_ = begin_;
  trial_.halving_level = 0;
  stepper_.invalidate();
  if (begin_.strain_memory.empty()) trial_.strain_memory = initial_strain_memory(model_, begin_);
  const double memory_at_beginning =
      energies(model_, dissipative_, trial_).strain - energies(model_, scheme_, begin_).strain;
  const StepResult made = stepper_.advance(trial_, deadline);
  result.add_effort(made);
  result.largest_rotation = made.largest_rotation;
  result.turning_node = made.turning_node;
  result.failure.tried_dissipation = true;
  if (!made.converged) return false;

  const double strain_energy = energies(model_, dissipative_, trial_).strain;
  if (begin_.strain_memory.empty()) trial_.strain_memory.clear();
  for (StrainMemory& memory : trial_.strain_memory) memory.average.setZero();
  trial_.dissipated += strain_energy - energies(model_, scheme_, trial_).strain - memory_at_beginning;
  state = trial_;
  result.converged = result.is_dissipated = true;
  result.reason = StepResult::Reason::None;
  result.failure = {};
  return true;
}

}  // namespace flexarm
