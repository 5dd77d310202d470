/// Tries one text as a scene; see try_scene.h.
#include "fuzz/try_scene.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::fuzz {
namespace {

constexpr int kSteps = 3;

/// Returns the first error of `name` without a line number, except errors about the file or scene as a whole.
std::string without_line(const scene::Diagnostics& findings) {
  for (const scene::Diagnostic& finding : findings) {
    const bool is_of_whole = finding.element.empty() || finding.element == "scene";
    if (finding.line <= 0 && !is_of_whole) return "no line: " + finding.text();
  }
  return "";
}

/// Returns whether a message contains "NAME:LINE: ".
bool tells_line(const std::string& message, const std::string& name) {
  const std::size_t place = message.find(name + ":");
  const std::size_t line = place + name.size() + 1;
  return place != std::string::npos && line < message.size() && message[line] >= '1' && message[line] <= '9';
}

bool is_finite(const Simulation& simulation) {
  const Energies energies = simulation.energies();
  double sum = simulation.time() + energies.total() + energies.work + energies.dissipated;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    sum += simulation.position(i) + simulation.velocity(i) + simulation.effort(i);
  for (std::size_t i = 0; i < simulation.link_names().size(); ++i) sum += simulation.tip_pose(i).position.sum();
  return std::isfinite(sum);
}

/// Returns about how many elements a scene has: the given numbers, plus those that an automatic mesh needs for twisted
/// pieces.
double elements_of(const scene::SceneDescription& scene) {
  double count = 0;
  for (const scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    if (link.beam->elements) count += *link.beam->elements;
    for (const scene::CentrelinePiece& piece : link.beam->centreline) count += 1 + std::abs(piece.twist);
  }
  return count;
}

Trial run(scene::SceneDescription scene) {
  Simulation simulation(std::move(scene));
  for (int n = 0; n < kSteps; ++n) {
    const StepResult result = simulation.step();
    if (!result.converged) {
      const bool is_diagnosed = result.reason != StepResult::Reason::None;
      return {Trial::End::Failed, to_string(result.reason), is_diagnosed ? "" : "a failure without a reason"};
    }
    if (!is_finite(simulation)) return {Trial::End::Ran, "", "results that are not finite"};
  }
  return {};
}

}  // namespace

Trial try_scene(const std::string& text, const std::string& name, const Limits& limits) {
  scene::ReadResult result = scene::read_scene_text(text, name);
  const std::string said = result.diagnostics.empty() ? "" : result.diagnostics.front().text();
  Trial trial{Trial::End::Refused, said, without_line(result.diagnostics)};
  if (result.scene.has_value() == scene::has_errors(result.diagnostics))
    trial.wrong = "a scene with errors, or none without";
  if (!result.scene || !trial.wrong.empty() || elements_of(*result.scene) > limits.elements) return trial;
  int& halvings = result.scene->integrator.max_halvings;
  halvings = std::min(halvings, limits.halvings);
  try {
    return run(std::move(*result.scene));
  } catch (const ModelError& error) {
    return {Trial::End::Refused, error.what(), tells_line(error.what(), name) ? "" : "an error without a line"};
  } catch (const std::exception& error) {
    return {Trial::End::Refused, error.what(), std::string("an exception that nobody expects: ") + error.what()};
  }
}

}  // namespace flexarm::fuzz
