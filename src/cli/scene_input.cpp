#include "cli/scene_input.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "math/parse_number.h"

namespace flexarm::cli {

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
  return Simulation(std::move(*result.scene), options);
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
