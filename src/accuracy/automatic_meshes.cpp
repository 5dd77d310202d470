#include "accuracy/automatic_meshes.h"

#include <algorithm>

#include "accuracy/mesh_errors.h"
#include "accuracy/step_errors.h"

namespace flexarm {
namespace {

/// Relative error of the steps with which meshes are measured.
constexpr double kPilotError = 0.02;
/// Share of the accuracy for the error of the richest mesh, to which the other meshes are compared.
constexpr double kRest = 0.1;
/// Elements of each beam in the pilot run: enough for the motion of the worst beam to be roughly right.
constexpr int kPilotElements = 3;

void choose(TrialRuns& trials, double accuracy, const MeshFreedom& freedom, AutomaticMeshes& out) {
  RunSettings pilot = out.settings;
  for (std::size_t b = 0; b < pilot.beams.size(); ++b)
    if (freedom.is_free[b]) pilot.beams[b] = {kPilotElements, std::max(2, pilot.beams[b].order)};
  const StepErrors steps =
      measure_steps(trials, pilot, std::max(kPilotError, accuracy), std::numeric_limits<double>::infinity());
  if (!steps.has_errors()) {
    out.shortcoming = steps.shortcoming;
    return;
  }
  RunSettings settings = out.settings;
  settings.step = steps.settings.step;
  const double scale = steps.runs.back()->length_of_errors();
  const MeshErrors errors = measure_meshes(trials, settings, freedom, kRest * accuracy * scale);
  out.shortcoming = errors.shortcoming;
  for (const std::vector<MeshError>& beam : errors.beams)
    if (beam.empty()) return;
  if (errors.beams.empty() || !(scale > 0)) return;
  const MeshChoice chosen = cheapest_mesh(mesh_choices(errors), (1 - kRest) * accuracy * scale);
  out.settings.beams = chosen.beams;
  for (std::size_t b = 0; b < freedom.is_free.size(); ++b)
    if (!freedom.is_free[b]) out.settings.beams[b] = settings.beams[b];
  out.is_chosen = true;
  out.error = (size(chosen.error) + errors.rest) / scale;
  out.is_met = out.error <= accuracy;
}

}  // namespace

AutomaticMeshes automatic_meshes(TrialRuns& trials, double accuracy) {
  AutomaticMeshes out;
  out.settings = settings_of(trials.scene());
  MeshFreedom freedom;
  freedom.may_be_rigid = freedom.keeps_orders = true;
  for (const BeamResolution& beam : out.settings.beams) freedom.is_free.push_back(!beam.elements);
  if (std::count(freedom.is_free.begin(), freedom.is_free.end(), true) == 0) {
    out.is_met = true;
    return out;
  }
  const std::size_t runs_before = trials.all().size();
  const double seconds_before = trials.seconds();
  try {
    choose(trials, accuracy, freedom, out);
  } catch (const SearchEnded& ended) {
    out.shortcoming = ended.what();
  }
  out.runs = static_cast<int>(trials.all().size() - runs_before);
  out.seconds = trials.seconds() - seconds_before;
  return out;
}

}  // namespace flexarm
