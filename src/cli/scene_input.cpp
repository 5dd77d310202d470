#include "cli/scene_input.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/commands.h"
#include "flexarm/scene/scene_description.h"
#include "math/parse_number.h"

namespace flexarm::cli {
namespace {

/// Of the largest motion of a node; a joint that moves less is not named.
constexpr double kMoves = 1e-3;
constexpr std::size_t kMostNames = 6;

/// Names of the joints that move in some free motion.
std::vector<std::string> unheld_joints(const Simulation& simulation, const std::vector<Mode>& modes) {
  const auto moves = [&](const std::string& coordinate) {
    const std::size_t index = simulation.find_coordinate(coordinate).value();
    return std::any_of(modes.begin(), modes.end(), [&](const Mode& mode) {
      return mode.is_free() && std::abs(mode.coordinate_motion[index]) > kMoves;
    });
  };
  std::vector<std::string> names;
  const scene::SceneDescription& scene = simulation.scene();
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints) {
      const std::vector<std::string>& suffixes = scene::coordinate_suffixes(joint);
      if (std::any_of(suffixes.begin(), suffixes.end(), [&](const std::string& suffix) {
            const std::string name = joint.name + suffix;
            return simulation.find_coordinate(name) && moves(name);
          }))
        names.push_back(joint.name);
    }
  return names;
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

void add_scene(CLI::App& command, SceneInput& input) {
  command.add_option("scene", input.path, "scene file")->required();
  const auto add_choice = [&](const char* name, const char* value, bool& chosen, const char* description) {
    command
        .add_option_function<std::string>(
            name, [&chosen](const std::string&) { chosen = true; }, description)
        ->check(CLI::IsMember({value}));
  };
  add_choice("--start", "clamp", input.options.clamp_start,
             "joints that would start outside their limits start at the nearest one");
  add_choice("--massless", "lock", input.options.lock_massless, "joints that move nothing with inertia are held");
}

void add_equilibrium(CLI::App& command, Equilibrium& wanted) {
  command.add_flag_callback(
      "--unstable", [&wanted] { wanted = Equilibrium::UnderTheLoads; },
      "takes the equilibrium that the loads lead to, stable or not");
}

Simulation load_simulation(const SceneInput& input, const SimulationOptions& options) {
  scene::ReadResult result = scene::read_scene_file(input.path, input.options);
  std::string findings = scene::to_text(result.diagnostics);
  if (!findings.empty()) findings.pop_back();  // the last line's end, which print and what() supply
  if (!result.scene) throw InputError(findings);
  if (!findings.empty()) fmt::print(stderr, "{}\n", findings);
  Simulation simulation(std::move(*result.scene), options);
  for (const scene::Diagnostic& held : simulation.held_joints()) fmt::print(stderr, "{}\n", held.text());
  return simulation;
}

std::string check_positive(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number && *number > 0 ? "" : "must be a number > 0, got '" + text + "'";
}

std::string check_non_negative(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number && *number >= 0 ? "" : "must be a number >= 0, got '" + text + "'";
}

std::string check_tolerance(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  const bool is_good = number && *number > 0 && *number <= kLargestTolerance;
  return is_good ? "" : fmt::format("must be a number > 0 and at most {}, got '{}'", kLargestTolerance, text);
}

std::vector<Mode> modes_about_equilibrium(Simulation& simulation, int count, Equilibrium wanted) {
  const StaticResult result = simulation.solve_static(kLoadSteps, wanted);
  if (result.converged) {
    warn_of_instability(result, wanted);
    return simulation.natural_modes(count);
  }
  const std::vector<Mode> modes = initial_modes(simulation, count);
  fmt::print(stderr, "flexarm: {}; the modes are those of the initial configuration\n",
             lack_of_equilibrium(simulation, result, modes));
  return modes;
}

void warn_of_instability(const StaticResult& result, Equilibrium wanted) {
  if (!result.falling_link.empty())
    fmt::print(stderr, "flexarm: warning: the equilibrium to which the loads lead is not stable: link '{}' {}\n",
               result.falling_link,
               wanted == Equilibrium::Stable
                   ? "falls from it; this is where it comes to rest (--unstable: the one that it falls from)"
                   : "would fall from it");
  if (!result.loose_link.empty())
    fmt::print(stderr,
               "flexarm: warning: nothing holds link '{}' where it stands: it may stand elsewhere as well (a <motion> "
               "of its joint would hold it)\n",
               result.loose_link);
}

bool are_modes_quick(const Simulation& simulation) {
  constexpr std::size_t kMostUnknowns = 50000, kMostCoordinates = 300;
  return simulation.degrees_of_freedom() <= kMostUnknowns && simulation.coordinate_names().size() <= kMostCoordinates;
}

std::vector<Mode> initial_modes(const Simulation& simulation, int count) {
  return simulation.natural_modes(count + static_cast<int>(simulation.coordinate_names().size()));
}

std::string lack_of_equilibrium(const Simulation& simulation, const StepResult& result,
                                const std::vector<Mode>& modes) {
  const std::vector<std::string> joints = unheld_joints(simulation, modes);
  // The tangent of what moves freely is singular but for round-off.
  const bool is_singular =
      result.reason == StepResult::Reason::SingularTangent || result.reason == StepResult::Reason::NoConvergence ||
      result.reason == StepResult::Reason::NeverRests || result.reason == StepResult::Reason::NotFinite;
  if (!is_singular || joints.empty()) return fmt::format("no equilibrium found ({})", to_string(result.reason));
  const auto free = std::count_if(modes.begin(), modes.end(), [](const Mode& mode) { return mode.is_free(); });
  return fmt::format(
      "no equilibrium: nothing holds {} in the initial configuration ({} free; a <motion> would hold it)",
      listed(joints), free == 1 ? "1 motion is" : fmt::format("{} motions are", free));
}

}  // namespace flexarm::cli
