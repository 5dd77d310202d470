#include "cli/scene_input.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cli/commands.h"
#include "flexarm/scene/scene_description.h"
#include "integrators/explicit_limit.h"
#include "math/number_text.h"
#include "simulation/failure_text.h"
#include "simulation/inside.h"

namespace flexarm::cli {

namespace {

std::string check_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return "must be NAME=VALUE, got '" + text + "'" + (equals == 0 ? "" : " (write the scene before --set)");
  if (parse_number(text.substr(equals + 1))) return "";
  return "the value of a parameter must be a finite number, got '" + text + "'";
}

std::string read_settings(const Words& settings, scene::ParameterValues& values) {
  for (const std::string& setting : settings) {
    const std::string name = setting.substr(0, setting.find('='));
    if (!values.emplace(name, *parse_number(std::string_view(setting).substr(name.size() + 1))).second)
      return "'" + name + "' must be set once";
  }
  return "";
}

}  // namespace

void add_scene(Command& command, SceneInput& input, const std::string& help) {
  command.argument("scene", input.path, help);
  command.heading("The scene");
  command
      .option_of_words(
          "--set", [&input](const Words& settings) { return read_settings(settings, input.options.parameters); },
          "values of the scene's parameters, which replace those of the file")
      .shown_as("NAME=VALUE")
      .check(check_setting);
  command
      .option("--xacro-args", input.options.xacro_arguments,
              "arguments for xacro, which expands a scene *.xacro if it is installed")
      .shown_as("\"NAME=VALUE ...\"");
  command
      .option_of_words(
          "--start",
          [&input](const Words& choices) {
            for (const std::string& choice : choices)
              (choice == "clamp" ? input.options.clamp_start : input.options.equilibrium_start) = true;
            return "";
          },
          "clamp: joints that would start outside their limits start at the nearest limit; equilibrium: everything "
          "starts at rest in the equilibrium of loads, gravity and servos; or both, separated by a comma")
      .takes(1)
      .with_commas()
      .choices({"clamp", "equilibrium"});
  command
      .option_of_words(
          "--massless",
          [&input](const Words&) {
            input.options.lock_massless = true;
            return "";
          },
          "lock: joints that move nothing with inertia are held instead of refused")
      .takes(1)
      .choices({"lock"});
  command.heading("Options");
}

Words option_words(const SceneInput& input) {
  const scene::ReadOptions& options = input.options;
  Words words;
  for (const auto& [name, value] : options.parameters) words.push_back(fmt::format("--set={}={:.17g}", name, value));
  if (!options.xacro_arguments.empty()) words.push_back("--xacro-args=" + options.xacro_arguments);
  if (options.clamp_start || options.equilibrium_start)
    words.push_back(!options.equilibrium_start ? "--start=clamp"
                    : options.clamp_start      ? "--start=clamp,equilibrium"
                                               : "--start=equilibrium");
  if (options.lock_massless) words.push_back("--massless=lock");
  return words;
}

void add_equilibrium(Command& command, Equilibrium& wanted) {
  command.flag(
      "--unstable", [&wanted] { wanted = Equilibrium::UnderTheLoads; },
      "takes the equilibrium to which the loads lead, even if it is unstable");
}

scene::ReadResult read_scene(const SceneInput& input) {
  scene::ReadResult result = scene::read_scene_file(input.path, input.options);
  std::string findings = scene::to_text(result.diagnostics);
  if (!findings.empty())
    findings.pop_back();  // the last newline, which fmt::print and the printing of what() add again
  if (!result.scene) throw InputError(findings);
  if (!findings.empty()) fmt::print(stderr, "{}\n", findings);
  return result;
}

Simulation load_simulation(const SceneInput& input, const SimulationOptions& options) {
  return started(std::move(*read_scene(input).scene), options);
}

Simulation started(scene::SceneDescription scene, const SimulationOptions& options) {
  Simulation simulation(std::move(scene), options);
  for (const scene::Diagnostic& warning : simulation.start_warnings()) fmt::print(stderr, "{}\n", warning.text());
  return simulation;
}

std::string check_part(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number && *number > 0 && *number < 1 ? "" : "must be a number between 0 and 1, got '" + text + "'";
}

std::string check_tolerance(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  const bool is_good = number && *number > 0 && *number <= kLargestTolerance;
  return is_good ? "" : fmt::format("must be a number > 0 and at most {}, got '{}'", kLargestTolerance, text);
}

Words scheme_choices() {
  return {scheme_names().begin(), scheme_names().end()};
}

ModesAbout modes_about_equilibrium(Simulation& simulation, int count, Equilibrium wanted) {
  const StaticResult result = simulation.solve_static(kLoadSteps, wanted);
  if (result.converged) {
    warn_of_instability(simulation, result, wanted);
    return {simulation.natural_modes(count), true};
  }
  std::vector<Mode> modes = simulation.natural_modes(count + static_cast<int>(simulation.coordinate_names().size()));
  fmt::print(stderr, "flexarm: {}; the modes are those of the initial configuration\n",
             lack_of_equilibrium(simulation.scene(), model_of(simulation), result, modes));
  return {std::move(modes), false};
}

namespace {

/// "pressed on its upper limit, 3"; empty if a coordinate is between its limits, or has none.
std::string limit_text(const scene::SceneDescription& scene, const std::string& coordinate, double position) {
  const scene::JointLimits* const limits = scene::limits_of(scene, coordinate);
  if (limits && position >= limits->upper) return fmt::format("pressed on its upper limit, {:g}", limits->upper);
  if (limits && position <= limits->lower) return fmt::format("pressed on its lower limit, {:g}", limits->lower);
  return "";
}

}  // namespace

void print_where(const Simulation& simulation, bool is_equilibrium) {
  constexpr std::size_t kMostShown = 12;
  const std::vector<std::string>& names = simulation.coordinate_names();
  fmt::print("{}{}\n",
             is_equilibrium ? "the equilibrium under gravity and the loads at t = 0" : "the initial configuration",
             names.empty() ? "" : ": joints at [m, rad]");
  std::size_t shown = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double position = simulation.position(i);
    const std::string limit = limit_text(simulation.scene(), names[i], position);
    if (++shown > kMostShown && limit.empty()) continue;
    fmt::print("  {:<24} {:>14.7g}{}{}\n", names[i], position, limit.empty() ? "" : "  ", limit);
  }
  if (names.size() > kMostShown)
    fmt::print("  (the first {} of {}, and those at their limits)\n", kMostShown, names.size());
}

void warn_of_instability(const Simulation& simulation, const StaticResult& result, Equilibrium wanted) {
  const char* consequence =
      wanted == Equilibrium::Stable
          ? "falls from it; this is the equilibrium in which it comes to rest (for the unstable one: --unstable)"
          : "would fall from it";
  for (const std::string& doubt : doubts_about_equilibrium(simulation, result, consequence))
    fmt::print(stderr, "flexarm: warning: {}\n", doubt);
}

void warn_of_growth(const Simulation& simulation) {
  if (!scheme_of(simulation).tableau) return;
  const ExplicitLimit limit =
      explicit_limit(model_of(simulation), scheme_of(simulation), state_of(simulation), simulation.step_size());
  if (limit.step < simulation.step_size())
    fmt::print(stderr,
               "flexarm: warning: the step, {} s, is too long for the explicit scheme {}, so that motions grow: {}\n",
               simulation.step_size(), simulation.scheme(), growth_text(model_of(simulation), limit));
}

void warn_of_long_step(const Simulation& simulation, const std::vector<Mode>& modes) {
  constexpr double kStepsInAPeriod = 10;  // the period that em computes is then 3 % too long
  double slowest = std::numeric_limits<double>::infinity();
  for (const Mode& mode : modes)
    if (mode.frequency > 0 && mode.rate <= 0) slowest = std::min(slowest, mode.frequency);
  const double step = simulation.step_size();
  if (!std::isfinite(slowest) || kStepsInAPeriod * step * slowest <= 1 || simulation.scene().integrator.accuracy)
    return;
  fmt::print(
      stderr,
      "flexarm: warning: the step, {} s, is long for the first mode, whose period is {:.3g} s: take ten steps in a "
      "period, or more\n",
      step, 1 / slowest);
}

bool are_modes_quick(const Simulation& simulation) {
  return flexarm::are_modes_quick(simulation.degrees_of_freedom(), simulation.coordinate_names().size());
}

}  // namespace flexarm::cli
