#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/page_options.h"
#include "cli/round_off.h"
#include "cli/scene_input.h"
#include "flexarm/simulation/csv_writer.h"
#include "joints/kinematics.h"
#include "pictures/page.h"
#include "pictures/still_pictures.h"
#include "simulation/inside.h"

namespace flexarm::cli {
namespace {

struct StaticArguments {
  SceneInput scene;
  std::string output;
  int load_steps = kLoadSteps;
  Equilibrium wanted = Equilibrium::Stable;
  PageOptions page;
};

void print_equilibrium(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  const double length = model.length_scale;
  const auto print_point = [&](const std::string& name, const Vector3& position) {
    fmt::print("  {:<24}", name);
    for (int i = 0; i < 3; ++i) fmt::print(" {:>14.7g}", without_round_off(position[i], length));
    fmt::print("\n");
  };
  const std::vector<std::string>& names = simulation.coordinate_names();
  if (!names.empty()) fmt::print("joint coordinates [m, rad]\n");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double size = coordinate_scale(model, model.coordinates[i]);
    fmt::print("  {:<24} {:>14.7g}\n", names[i], without_round_off(simulation.position(i), size));
  }
  fmt::print("positions [m]\n");
  for (std::size_t i = 0; i < simulation.link_names().size(); ++i) {
    print_point("link " + simulation.link_names()[i], simulation.link_pose(i).position);
    if (simulation.is_flexible(i))
      print_point("link " + simulation.link_names()[i] + "/tip", simulation.tip_pose(i).position);
  }
  const std::vector<scene::Probe>& probes = simulation.scene().probes;
  for (std::size_t i = 0; i < probes.size(); ++i)
    print_point("probe " + probes[i].name, simulation.probe_pose(i).position);
  const Energies energies = simulation.energies();
  const double size = std::max({std::abs(energies.potential), std::abs(energies.work), energies.strain});
  fmt::print("strain energy {:.7g} J\n", without_round_off(energies.strain, size));
}

int solve(const StaticArguments& arguments) {
  refuse_overwriting("--output", arguments.output, arguments.scene.path);
  require_writable("--output", arguments.output);
  const std::string page = page_path(arguments.page, arguments.scene, "_equilibrium");
  Simulation simulation = load_simulation(arguments.scene);
  const Simulation start = simulation.copy();
  const StaticResult result = simulation.solve_static(arguments.load_steps, arguments.wanted);
  if (!result.converged) {
    fmt::print(stderr, "flexarm: {}\n", lack_of_equilibrium(simulation, result));
    return kFailed;
  }
  warn_of_instability(simulation, result, arguments.wanted);
  std::FILE* const report = is_standard_output(arguments.output) ? stderr : stdout;
  if (report == stdout) print_equilibrium(simulation);
  if (!page.empty()) write_page(arguments.page, page, {pictures::record_equilibrium(start, simulation)}, report);
  if (arguments.output.empty()) return kDone;
  CsvWriter output(arguments.output, ResultColumns(simulation, ResultColumns::Solver::Without));
  output.write_row(simulation);
  output.close();
  return kDone;
}

}  // namespace

void add_static(CommandLine& line) {
  const auto arguments = std::make_shared<StaticArguments>();
  Command& command = line.command("static", "Finds the equilibrium under gravity and the loads at t = 0");
  add_scene(command, arguments->scene);
  command.option("--load-steps", arguments->load_steps, "steps in which gravity and loads grow")
      .shows_default()
      .check(whole_number_between(1, 1000000));
  add_equilibrium(command, arguments->wanted);
  command.option("--output", arguments->output, "CSV file for the equilibrium; -: standard output").shown_as("FILE");
  add_page(command, arguments->page);
  command.runs([arguments] { return solve(*arguments); });
}

}  // namespace flexarm::cli
