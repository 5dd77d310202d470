#include "simulation/equilibrium_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/descent.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// A joint is named if it moves by more than this part of the mode's largest nodal motion.
constexpr double kMoves = 1e-3;
constexpr std::size_t kMostNames = 6;
/// Uncertainty of a coordinate above which it is reported [rad or m].
constexpr double kWeak = 1e-6;

/// Names of the joints that move in at least one free mode: first those on the root link, which carry the others.
std::vector<std::string> unheld_joints(const scene::SceneDescription& scene, const Model& model,
                                       const std::vector<Mode>& modes) {
  const auto moves = [&](const std::string& name) {
    const auto coordinate = std::find_if(model.coordinates.begin(), model.coordinates.end(),
                                         [&](const Coordinate& candidate) { return candidate.name == name; });
    return coordinate != model.coordinates.end() && std::any_of(modes.begin(), modes.end(), [&](const Mode& mode) {
             return mode.is_free() && std::abs(mode.coordinate_motion[coordinate - model.coordinates.begin()]) > kMoves;
           });
  };
  std::vector<std::string> names, carried;
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints) {
      const std::vector<std::string>& suffixes = scene::coordinate_suffixes(joint);
      if (std::any_of(suffixes.begin(), suffixes.end(),
                      [&](const std::string& suffix) { return moves(joint.name + suffix); }))
        (joint.parent == scene.root_link ? names : carried).push_back(joint.name);
    }
  names.insert(names.end(), carried.begin(), carried.end());
  return names;
}

std::string unheld_part(const Model& model, const StepResult::Place& place) {
  if (place.coordinate >= 0) return fmt::format("joint '{}'", model.coordinates[place.coordinate].name);
  return fmt::format("link '{}'", model.links[place.link].name);
}

/// "joint 'a'", or "joints 'a', 'b' and 3 others".
std::string listed(const std::vector<std::string>& names) {
  std::string text = names.size() == 1 ? "joint" : "joints";
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    text += fmt::format("{} '{}'", i > 0 ? "," : "", names[i]);
  if (names.size() > kMostNames) text += fmt::format(" and {} others", names.size() - kMostNames);
  return text;
}

}  // namespace

bool are_modes_quick(std::size_t unknowns, std::size_t coordinates) {
  constexpr std::size_t kMostUnknowns = 50000, kMostCoordinates = 300;
  return unknowns <= kMostUnknowns && coordinates <= kMostCoordinates;
}

std::string lack_of_equilibrium(const scene::SceneDescription& scene, const Model& model, const StepResult& result,
                                const std::vector<Mode>& modes) {
  const std::vector<std::string> joints = unheld_joints(scene, model, modes);
  // If something can move freely, the tangent is singular up to round-off, so that the solver may fail in any of these
  // ways.
  const bool is_singular =
      result.reason == StepResult::Reason::SingularTangent || result.reason == StepResult::Reason::NoConvergence ||
      result.reason == StepResult::Reason::NeverRests || result.reason == StepResult::Reason::NotFinite;
  if (joints.empty() && result.reason == StepResult::Reason::NeverRests && result.failure.place.is_known())
    return fmt::format("no equilibrium: the loads move {} without limit: nothing holds it",
                       unheld_part(model, result.failure.place));
  if (!is_singular || joints.empty()) return fmt::format("no equilibrium found ({})", to_string(result.reason));
  const auto free = std::count_if(modes.begin(), modes.end(), [](const Mode& mode) { return mode.is_free(); });
  return fmt::format(
      "no equilibrium: nothing holds {} in the initial configuration ({} free; a <motion> would hold it)",
      listed(joints), free == 1 ? "1 motion is" : fmt::format("{} motions are", free));
}

std::string lack_of_equilibrium(const Simulation& simulation, const StepResult& result) {
  const std::size_t coordinates = simulation.coordinate_names().size();
  std::vector<Mode> modes;
  if (are_modes_quick(simulation.degrees_of_freedom(), coordinates))
    modes = simulation.natural_modes(1 + static_cast<int>(coordinates));
  return lack_of_equilibrium(simulation.scene(), model_of(simulation), result, modes);
}

std::vector<std::string> doubts_about_equilibrium(const Model& model, const State& equilibrium,
                                                  const StaticResult& result, const std::string& consequence) {
  std::vector<std::string> doubts;
  if (!result.falling_link.empty())
    doubts.push_back(fmt::format("the equilibrium to which the loads lead is not stable: link '{}' {}",
                                 result.falling_link, consequence));
  const JointHold hold = joint_hold(model, equilibrium);
  std::vector<std::string> free;
  for (const std::size_t coordinate : hold.free) free.push_back(model.coordinates[coordinate].name);
  if (!free.empty())
    doubts.push_back(
        fmt::format("nothing holds {}: {} where the start put {}, but other positions are equilibria, too (a "
                    "<motion> would hold {})",
                    listed(free), free.size() == 1 ? "it stays" : "they stay", free.size() == 1 ? "it" : "them",
                    free.size() == 1 ? "it" : "them"));
  else if (!result.loose_link.empty())
    doubts.push_back(fmt::format(
        "nothing holds link '{}' in its position: other positions are equilibria, too (a <motion> of its joint "
        "would hold it)",
        result.loose_link));
  if (hold.weakness > kWeak)
    doubts.push_back(fmt::format("joint '{}' is held so weakly that round-off may move it by {:.1g} {}",
                                 model.coordinates[hold.weakest].name, hold.weakness,
                                 is_rotation(model, model.coordinates[hold.weakest]) ? "rad" : "m"));
  return doubts;
}

std::vector<std::string> doubts_about_equilibrium(const Simulation& simulation, const StaticResult& result,
                                                  const std::string& consequence) {
  return doubts_about_equilibrium(model_of(simulation), state_of(simulation), result, consequence);
}

}  // namespace flexarm
