#include "simulation/start.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/modes.h"
#include "analysis/statics.h"
#include "building/model_builder.h"
#include "flexarm/model/model_error.h"
#include "model/degrees_of_freedom.h"
#include "simulation/equilibrium_text.h"

namespace flexarm {
namespace {

/// Error of rates of functions of time, which are computed by differences [1/s, for a function of size 1].
constexpr double kRateRoundOff = 1e-6;

scene::Diagnostic warning(const scene::SourceLocation& place, const std::string& element, const std::string& text,
                          const std::string& got = "") {
  return {scene::Diagnostic::Severity::Warning, place.file, place.line, element, got, text};
}

scene::SourceLocation place_of_integrator(const scene::SceneDescription& scene) {
  return scene.integrator_location.line > 0 ? scene.integrator_location : scene::SourceLocation{scene.file};
}

/// @throws ModelError that names the first initial velocity.
void require_rest(const scene::SceneDescription& scene) {
  const auto refuse = [](const scene::SourceLocation& place, const std::string& what) {
    throw ModelError(
        fmt::format("{}:{}: <initial> of {}: a velocity is given, but the simulation is to start at rest in "
                    "its equilibrium (<initial equilibrium=\"true\"/> or --start equilibrium)",
                    place.file, place.line, what));
  };
  for (const scene::InitialJoint& initial : scene.initial_joints)
    if (initial.velocity != 0) refuse(initial.location, "joint '" + initial.coordinate + "'");
  for (const scene::InitialLink& initial : scene.initial_links)
    if (!initial.linear.isZero(0) || !initial.angular.isZero(0))
      refuse(initial.location, "link '" + initial.link + "'");
}

void warn_of_blows(const scene::SceneDescription& scene, scene::Diagnostics& warnings) {
  for (const scene::PrescribedMotion& motion : scene.motions) {
    const double rate = motion.position.derivative(0);
    if (std::abs(rate) > kRateRoundOff * (1 + std::abs(motion.position(0))))
      warnings.push_back(
          warning(motion.location, "<motion> of '" + motion.coordinate + "'",
                  "moves at t = 0, which is an impact on a mechanism that starts at rest in its equilibrium",
                  fmt::format("'{:.3g}' rad/s or m/s", rate)));
  }
}

}  // namespace

std::set<std::string> hidden_coordinates(const scene::SceneDescription& scene) {
  std::set<std::string> hidden;
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints)
      for (const std::string& suffix : scene::coordinate_suffixes(joint))
        if (joint.is_hidden) hidden.insert(joint.name + suffix);
  return hidden;
}

scene::Diagnostics held_joints(const scene::SceneDescription& scene, const Model& model) {
  std::set<std::string> driven;
  for (const scene::PrescribedMotion& motion : scene.motions) driven.insert(motion.coordinate);
  std::set<std::string> held, all;
  for (const Coordinate& coordinate : model.coordinates) {
    all.insert(coordinate.name);
    if (coordinate.motion >= 0 && driven.count(coordinate.name) == 0) held.insert(coordinate.name);
  }
  scene::Diagnostics findings;
  const auto tell = [&](const scene::JointDescription& joint, const std::string& suffix) {
    findings.push_back(warning(joint.location, "<joint> '" + joint.name + suffix + "'",
                               "is held where it starts, since it moves nothing that has inertia"));
  };
  for (const scene::JointDescription& joint : scene.joints) {
    const std::vector<std::string>& suffixes = scene::coordinate_suffixes(joint);
    if (!suffixes.empty() && all.count(joint.name + suffixes.front()) == 0)
      tell(joint, "");  // it was made a fixed joint
    for (const std::string& suffix : suffixes)
      if (held.count(joint.name + suffix) > 0) tell(joint, suffix);
  }
  return findings;
}

scene::Diagnostics hidden_inertia(const scene::SceneDescription& scene, const Model& model) {
  std::set<std::string> names;
  for (const int coordinate : coordinates_of_hidden_inertia(model)) names.insert(model.coordinates[coordinate].name);
  std::string listed;
  const scene::JointDescription* last = nullptr;
  for (const scene::JointDescription& joint : scene.joints)
    for (const std::string& suffix : scene::coordinate_suffixes(joint)) {
      if (names.count(joint.name + suffix) == 0) continue;
      listed += fmt::format("{}'{}{}'", listed.empty() ? "" : ", ", joint.name, suffix);
      last = &joint;
    }
  if (!last) return {};
  return {
      warning(last->location, fmt::format("<joint> '{}'", last->name),
              "can move together with others against nearly no inertia: their mass matrix is singular within "
              "round-off, so that their accelerations have no digits; give links between them inertia, or armatures",
              listed)};
}

scene::Diagnostics doubts_about_scheme(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme) {
  const bool damps_nothing = !scheme.is_incremental() && scheme.gamma <= 0.5 && scheme.alpha == 0;
  const bool has_joints =
      !model.closures.empty() || std::any_of(model.joints.begin(), model.joints.end(), [](const JointMap& joint) {
        return joint.kind != JointMapKind::Rigid && joint.kind != JointMapKind::Free;
      });
  if (!damps_nothing || !has_joints) return {};
  return {warning(place_of_integrator(scene), "<integrator>",
                  "accelerations across joints grow from step to step and spoil the motion after some hundred steps; "
                  "take 'em', 'hht2' or gamma above 0.5",
                  fmt::format("'{}' with gamma {:g}", scheme.name, scheme.gamma))};
}

scene::Diagnostics overlaps(const scene::SceneDescription& scene, const Model& model, const State& state) {
  const std::vector<Vector6> still(state.nodes.size(), Vector6::Zero());
  scene::Diagnostics findings;
  for (const TouchingPair& pair : model.touching_pairs) {
    double gap = 0;
    for (const auto& [index, begin] : pair.elements) {
      const ForceElement& element = *model.force_elements[index];
      const double* memory = state.force_memory.data() + begin;
      if (element.remembers(memory))  // it remembers how deep the overlap was at the start
        gap = std::min(gap, element.touch({state, still, memory}, [](const TouchingPoint&) {}));
    }
    if (gap < 0)
      findings.push_back(warning({scene.file}, fmt::format("<contact> of '{}' and '{}'", pair.first, pair.second),
                                 "they penetrate each other at the start, and are separated gradually",
                                 fmt::format("'{:.3g}' m", -gap)));
  }
  return findings;
}

scene::Diagnostic unknown_accelerations(const scene::SceneDescription& scene, const std::string& failure) {
  return warning(
      place_of_integrator(scene), "start",
      "has zero accelerations, which is inaccurate for the scheme, since the scene's accelerations cannot be "
      "found: " +
          failure);
}

void start_in_equilibrium(const scene::SceneDescription& scene, const Model& model, const Scheme& scheme,
                          const StepSettings& settings, State& state, scene::Diagnostics& warnings) {
  require_rest(scene);
  warn_of_blows(scene, warnings);
  StaticResult result = solve_static(model, scheme, settings, kLoadSteps, Equilibrium::Stable, state);
  if (result.converged && !sharpen_equilibrium(model, scheme, settings, state)) {
    result.converged = false;
    result.reason = StepResult::Reason::NoConvergence;
  }
  if (!result.converged) {
    const int coordinates = static_cast<int>(model.coordinates.size());
    const bool is_quick = are_modes_quick(DegreesOfFreedom(model).unknowns, coordinates);
    std::vector<Mode> modes;
    // A mechanism without an equilibrium may have no modes either, if its numbers are out of all bounds.
    try {
      if (is_quick) modes = natural_modes(model, state, 1 + coordinates);
    } catch (const std::runtime_error&) {
    }
    const std::string lack = lack_of_equilibrium(scene, model, result, modes);
    const scene::Diagnostic error{scene::Diagnostic::Severity::Error,
                                  scene.file,
                                  scene.equilibrium_location.line,
                                  "",
                                  "",
                                  "the simulation is to start in its equilibrium: " + lack};
    throw ModelError(error.text());
  }
  for (const std::string& doubt : doubts_about_equilibrium(
           model, state, result, "falls from it; the simulation starts in the equilibrium in which it comes to rest"))
    warnings.push_back(warning({scene.file}, "start in equilibrium", doubt));
}

}  // namespace flexarm
