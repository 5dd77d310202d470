#include "flexarm/simulation/run_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "model/place.h"
#include "schemes/scheme.h"
#include "simulation/failure_text.h"
#include "simulation/inside.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// Rotation of a node in a step above which there is a warning [rad]. With tangent-scaled increments, a free rotation
/// lags by a twelfth of the squared angle (2 %). For larger rotations, second order in the step says little about the
/// error.
constexpr double kLargestRotation = 0.5;
/// Strain above which there is a warning. Materials of arms fail, and their linear law ceases to hold, far below it.
constexpr double kLargestStrain = 0.1;
/// Bending of an element above which there is a warning, by its order [rad]: there its compliance is wrong by about 3
/// %. (docs/notes/refinement.md 1)
constexpr double kLargestBending[] = {0, 1.0, 2.1, 3.6, 5.5};
/// Largest defect of the energy account of a conserving or explicit scheme, relative to the largest energy. It is far
/// above the error that the tolerance of Newton's method leaves.
constexpr double kLargestEnergyDefect = 1e-3;
/// Displacements in a step that count as rest, relative to the mechanism's length.
constexpr double kRest = 1e-8;

/// Kinetic energy of a mechanism that moves as slowly as that [J].
double energy_of_rest(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  const double speed = kRest * model.length_scale / simulation.step_size();
  return 0.5 * simulation.mass() * speed * speed;
}

}  // namespace

RunSummary::RunSummary(const Simulation& simulation)
    : conserves_energy_(scheme_of(simulation).conserves_energy),
      is_explicit_(scheme_of(simulation).tableau != nullptr),
      start_(simulation.energies()),
      energy_scale_(energy_of_rest(simulation)) {
  look_at_bending(simulation);
  look(simulation);
}

void RunSummary::count(const Simulation& simulation, const StepResult& result) {
  counts_.add(result);
  if (result.largest_rotation > rotation_.amount)
    rotation_ = {result.largest_rotation, simulation.time(), -1, 0,
                 place_of_node(model_of(simulation), state_of(simulation), result.turning_node)};
  look_at_bending(simulation);
}

void RunSummary::look_at_bending(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const std::optional<BeamLink>& beam = model.links[link].beam;
    if (!beam) continue;
    const double limit = std::max(bending_.amount, kLargestBending[beam->order]);
    const ElementBending most = most_bent_element(model, state_of(simulation), *beam, limit);
    if (most.angle == 0) continue;
    bending_ = {most.angle, simulation.time(), static_cast<int>(link), 0, {}};
    bending_.place.link = bending_.index;
    bending_.place.element = beam->parts[most.element].element;
  }
}

void RunSummary::look(const Simulation& simulation) {
  const double time = simulation.time();
  const std::vector<LinkFrame>& links = model_of(simulation).links;
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (!links[link].beam) continue;
    const EdgeStrain strain = largest_edge_strain(model_of(simulation), state_of(simulation), *links[link].beam);
    if (strain.amount > strain_.amount) strain_ = {strain.amount, time, static_cast<int>(link), strain.arc_length, {}};
  }
  const Energies e = simulation.energies();
  energy_scale_ = std::max(
      {energy_scale_, e.kinetic, e.strain, std::abs(e.potential - start_.potential), std::abs(e.work - start_.work)});
  const double defect = std::abs(account(e) - account(start_));
  if (defect > energy_.amount) energy_ = {defect, time, -1, 0, {}};
}

std::string RunSummary::rotation_warning(const Simulation& simulation) const {
  const double angle = 2 * std::atan(0.5 * rotation_.amount);
  if (angle <= kLargestRotation) return "";
  const std::string place = place_name(model_of(simulation), rotation_.place);
  const double lag = 1 - angle / rotation_.amount;
  return fmt::format(
      "{} turned by up to {:.2g} rad in the step to t = {:.6g} s: free rotations are {:.2g} % too slow there; use a "
      "smaller step, in which it turns by less than {} rad",
      place.empty() ? "a node" : place, angle, rotation_.time, 100 * lag, kLargestRotation);
}

std::string RunSummary::bending_warning(const Simulation& simulation) const {
  if (bending_.amount == 0) return "";
  const Model& model = model_of(simulation);
  const BeamLink& beam = *model.links[bending_.index].beam;
  return fmt::format(
      "{} was bent by up to {:.2g} rad, at t = {:.6g} s: beyond {} rad, elements of order {} are wrong by 3 % and soon "
      "by "
      "much more; use {}",
      place_name(model, bending_.place), bending_.amount, bending_.time, kLargestBending[beam.order], beam.order,
      bending_advice(beam));
}

std::string RunSummary::strain_warning(const Simulation& simulation) const {
  if (strain_.amount <= kLargestStrain) return "";
  return fmt::format(
      "link '{}' was strained by up to {:.2g}, {:.4g} m from its beginning, at t = {:.6g} s: the linear material law "
      "is not valid there; check loads and stiffness, or refine the mesh if it is coarse there",
      simulation.link_names()[strain_.index], strain_.amount, strain_.arc_length, strain_.time);
}

std::string RunSummary::energy_warning() const {
  const bool keeps_account = conserves_energy_ || is_explicit_;
  if (!keeps_account || energy_.amount <= kLargestEnergyDefect * energy_scale_) return "";
  return fmt::format(
      "energy - work + dissipation changed by up to {:.2g} J at t = {:.6g} s, {:.2g} % of the largest energy, {}",
      energy_.amount, energy_.time, 100 * energy_.amount / energy_scale_,
      is_explicit_
          ? "by errors of the explicit scheme: a smaller step helps, or the scheme em"
          : "with a scheme that conserves it: a smaller step helps, or a smaller tolerance if it is above 3e-8");
}

std::vector<std::string> RunSummary::warnings(const Simulation& simulation) const {
  std::vector<std::string> warnings = {rotation_warning(simulation), bending_warning(simulation),
                                       strain_warning(simulation), energy_warning()};
  warnings.erase(std::remove(warnings.begin(), warnings.end(), ""), warnings.end());
  return warnings;
}

}  // namespace flexarm
