#include <algorithm>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/mode_table.h"
#include "cli/page_options.h"
#include "cli/round_off.h"
#include "cli/scene_input.h"
#include "flexarm/scene/scene_description.h"
#include "pictures/page.h"
#include "pictures/still_pictures.h"

namespace flexarm::cli {
namespace {

/// Imaginary parts below this fraction of the largest component are not printed, since they would not affect the
/// digits.
constexpr double kVisibleImaginary = 1e-4;

/// Error of shapes by round-off, relative to the largest component: more than elsewhere, since neighbouring modes mix.
constexpr double kShapeError = 1e-8;

struct ModesArguments {
  SceneInput scene;
  int count = 10;
  Equilibrium wanted = Equilibrium::Stable;
  bool json = false, csv = false;
  PageOptions page;
};

void print_motion(const std::string& name, const Vector6& motion) {
  fmt::print("  {:<24}", name);
  for (int i = 0; i < 6; ++i) fmt::print(" {:>11.4g}", without_round_off(motion[i], 1, kShapeError));
  fmt::print("\n");
}

void print_shape(const Simulation& simulation, const Mode& mode) {
  const auto print = [](const char* kind, const std::vector<NamedMotion>& motions) {
    for (const auto& [name, motion] : motions) {
      print_motion(kind + name, motion.real());
      if (motion.imag().cwiseAbs().maxCoeff() > kVisibleImaginary)
        print_motion("  a quarter period later", -motion.imag());
    }
  };
  print("link ", frame_motions(simulation, mode));
  print("probe ", probe_motions(simulation, mode));
}

bool has_maxwell(const scene::SceneDescription& scene) {
  return std::any_of(scene.links.begin(), scene.links.end(),
                     [](const scene::LinkDescription& link) { return link.beam && !link.beam->maxwell.empty(); });
}

void print_eigenvalue(const Mode& mode) {
  fmt::print("{:.7g} Hz", mode.frequency);
  if (mode.is_free()) fmt::print(" (free: nothing holds this motion)");
  if (mode.rate > 0) fmt::print(", grows by {:.7g} 1/s ({})", mode.rate, kind_of(mode));
  if (mode.rate < 0) fmt::print(", decays by {:.7g} 1/s", -mode.rate);
  if (mode.rate != 0 && mode.frequency > 0) fmt::print(", damping ratio {:.4g}", mode.damping_ratio());
  fmt::print("\n");
}

void print_text(const Simulation& simulation, const std::vector<Mode>& modes, bool is_equilibrium) {
  print_where(simulation, is_equilibrium);
  if (has_maxwell(simulation.scene()))
    fmt::print("(with the stiffness of beams at rest, without their <maxwell> elements)\n");
  for (std::size_t i = 0; i < modes.size(); ++i) {
    fmt::print("mode {}: ", i + 1);
    print_eigenvalue(modes[i]);
    if (i == 0)
      fmt::print("  {:<24} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "place", "x", "y", "z", "about x", "about y",
                 "about z");
    print_shape(simulation, modes[i]);
  }
}

/// "mode 2: 3.21 Hz".
std::string name_of(const Mode& mode, std::size_t number) {
  const std::string name = fmt::format("mode {}: {:.4g} Hz", number, mode.frequency);
  const bool is_oscillation = mode.frequency > 0 && !mode.is_flutter();
  return is_oscillation ? name : fmt::format("mode {}: {}", number, kind_of(mode));
}

pictures::EncodedRun picture_of_modes(const Simulation& simulation, const std::vector<Mode>& modes,
                                      bool is_equilibrium) {
  std::vector<pictures::NamedMode> named;
  named.reserve(modes.size());
  for (const Mode& mode : modes) named.push_back({name_of(mode, named.size() + 1), mode});
  const std::string title = fmt::format("{}: natural modes about {}", simulation.scene().name,
                                        is_equilibrium ? "the equilibrium" : "the initial configuration");
  return pictures::record_modes(simulation, named, title);
}

int solve(const ModesArguments& arguments) {
  const std::string page = page_path(arguments.page, arguments.scene, "_modes");
  Simulation simulation = load_simulation(arguments.scene);
  auto [modes, is_equilibrium] = modes_about_equilibrium(simulation, arguments.count, arguments.wanted);
  modes.resize(std::min<std::size_t>(modes.size(), arguments.count));
  if (arguments.json)
    fmt::print("{}", modes_as_json(simulation, modes));
  else if (arguments.csv)
    fmt::print("{}", modes_as_csv(simulation, modes));
  else
    print_text(simulation, modes, is_equilibrium);
  if (!page.empty())
    write_page(arguments.page, page, {picture_of_modes(simulation, modes, is_equilibrium)},
               arguments.json || arguments.csv ? stderr : stdout);
  return kDone;
}

}  // namespace

void add_modes(CommandLine& line) {
  const auto arguments = std::make_shared<ModesArguments>();
  Command& command = line.command("modes", "Frequencies, growth or decay, and shapes about the equilibrium");
  add_scene(command, arguments->scene);
  add_equilibrium(command, arguments->wanted);
  command.option("--count", arguments->count, "number of modes").shows_default().check(whole_number_between(1, 10000));
  command.flag("--json", arguments->json, "prints JSON with all digits");
  command.flag("--csv", arguments->csv, "prints comma-separated values with all digits").excludes("--json");
  add_page(command, arguments->page);
  command.runs([arguments] { return solve(*arguments); });
}

}  // namespace flexarm::cli
