#include "cli/scene_input.h"

#include <set>

#include <fmt/format.h>

#include "cli/commands.h"
#include "math/parse_number.h"

namespace flexarm::cli {
namespace {

/// Names the joints that are held because they move nothing with inertia, which only the model knows.
void report_held(const Simulation& simulation) {
  const scene::SceneDescription& scene = simulation.scene();
  std::set<std::string> driven;
  for (const scene::PrescribedMotion& motion : scene.motions) driven.insert(motion.coordinate);
  std::set<std::string> held;
  for (const Coordinate& coordinate : simulation.model().coordinates)
    if (coordinate.motion >= 0 && driven.count(coordinate.name) == 0) held.insert(coordinate.name);
  for (const scene::JointDescription& joint : scene.joints)
    for (const std::string& suffix : scene::coordinate_suffixes(joint))
      if (held.count(joint.name + suffix) > 0)
        fmt::print(stderr,
                   "{}:{}: warning: <joint> '{}': is held where it starts, since it moves nothing that has inertia\n",
                   joint.location.file, joint.location.line, joint.name + suffix);
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

Simulation load_simulation(const SceneInput& input, const SimulationOptions& options) {
  scene::ReadResult result = scene::read_scene_file(input.path, input.options);
  std::string findings = scene::to_text(result.diagnostics);
  if (!findings.empty()) findings.pop_back();  // the last line's end, which print and what() supply
  if (!result.scene) throw InputError(findings);
  if (!findings.empty()) fmt::print(stderr, "{}\n", findings);
  Simulation simulation(std::move(*result.scene), options);
  report_held(simulation);
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

void seek_equilibrium(Simulation& simulation) {
  constexpr int kLoadSteps = 10;
  const StepResult result = simulation.solve_static(kLoadSteps);
  if (!result.converged)
    fmt::print(stderr, "flexarm: no equilibrium found ({}); what follows is about the initial configuration\n",
               to_string(result.reason));
}

}  // namespace flexarm::cli
