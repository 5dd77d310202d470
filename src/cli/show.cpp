#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/other_programs.h"
#include "cli/page_options.h"
#include "cli/simulation_output.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "pictures/page.h"
#include "simulation/checkpoint_scene.h"

namespace flexarm::cli {
namespace {

struct ShowArguments {
  SimulateArguments run;  ///< its scene may be a file of results or a checkpoint
  PageOptions page;
  std::vector<std::string> results;
};

/// Shows results of earlier runs. Python reads their files.
/// @param scene  of all runs; empty: each run names its own
[[noreturn]] void show_results(const ShowArguments& arguments, const std::string& scene, const Words& files) {
  Words words = option_words(arguments.run.scene);
  words.insert(words.end(), {"--output", page_path(arguments.page, arguments.run.scene, ""), "--rate",
                             text_of(arguments.run.page_rate)});
  if (arguments.run.page_time) words.push_back("--at=" + text_of(*arguments.run.page_time));
  if (arguments.page.opens) words.push_back("--open");
  if (!scene.empty()) words.push_back("--scene=" + scene);
  words.push_back("--");
  words.insert(words.end(), files.begin(), files.end());
  become_python("show", "show_runs.py", words);
}

/// Calls `read`, and makes its errors errors of input.
template <class Read>
auto reading(const Read& read) {
  try {
    return read();
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("flexarm: ") + error.what());
  }
}

/// The scene of a checkpoint. What the user sets comes before what the checkpoint names.
SceneInput scene_of_state(const SceneInput& state) {
  const CheckpointScene known = reading([&] { return scene_of_checkpoint(state.path); });
  if (!std::filesystem::exists(known.file))
    throw InputError(fmt::format(
        "flexarm: {}: {}; name it: flexarm show SCENE --resume {}", state.path,
        known.file.empty() ? "does not name its scene" : "its scene '" + known.file + "' is not there any more",
        state.path));
  SceneInput scene = state;
  scene.path = known.file;
  scene.options.parameters.insert(known.parameters.begin(), known.parameters.end());
  return scene;
}

/// Shows a saved state by itself.
int show_state(const ShowArguments& arguments, const SimulateArguments& run) {
  Simulation simulation = load_simulation(run.scene, run.options);
  reading([&] { read_checkpoint(simulation, run.resume); });
  const std::string title = fmt::format("{}, t = {:.6g} s", simulation.scene().name, simulation.time());
  pictures::Recording recording(simulation, {title});
  recording.keep(simulation, {});
  write_page(arguments.page, run.output, {recording.encode()}, stdout);
  return kDone;
}

bool are_results(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".csv" || extension == ".h5" || extension == ".hdf5" || extension == ".bag";
}

int show(const ShowArguments& arguments) {
  const std::string& first = arguments.run.scene.path;
  if (are_results(first)) {
    Words files = {first};
    files.insert(files.end(), arguments.results.begin(), arguments.results.end());
    show_results(arguments, "", files);
  }
  if (!arguments.results.empty()) show_results(arguments, first, arguments.results);
  SimulateArguments run = arguments.run;
  run.output = page_path(arguments.page, run.scene, "");
  const bool is_until_given = !std::isnan(run.until);
  if (!is_until_given) run.until = SimulateArguments().until;
  if (run.resume.empty() && is_checkpoint(first)) {
    run.resume = first;
    run.scene = scene_of_state(run.scene);
    if (!is_until_given) return show_state(arguments, run);
  }
  const int status = simulate(run);
  // If the run failed, the page shows it until then.
  if (!run.quiet || arguments.page.opens) present_page(arguments.page, run.output, stdout);
  return status;
}

}  // namespace

void add_show(CommandLine& line) {
  const auto arguments = std::make_shared<ShowArguments>();
  SimulateArguments& run = arguments->run;
  arguments->page.is_wanted = true;
  Command& command = line.command("show", "Simulates a scene, and writes a page that plays the run in a browser");
  add_scene(command, run.scene, "scene file; or, of an earlier run, results (.csv, .h5, .bag) or a saved state");
  add_commands(command, run);
  add_time_and_accuracy(command, run);
  run.until = std::numeric_limits<double>::quiet_NaN();  // not given: a saved state is shown by itself
  command.heading("The page");
  command
      .option("--output", arguments->page.path,
              "HTML file for the page; by default it has the scene's name, and is in the working folder")
      .shown_as("FILE");
  command.option("--rate", run.page_rate, "instants in the page per second of simulated time")
      .shows_default()
      .check(check_positive);
  command.option("--at", run.page_time, "time that the page shows first [s]; by default that of the largest strain")
      .shown_as("T");
  command.flag("--open", arguments->page.opens, "opens the page in a browser");
  command.flag("--quiet", run.quiet, "no progress bar and no summary");
  command
      .option("--runs", arguments->results, "shows these files of results of the scene, side by side: .csv, .h5, .bag")
      .shown_as("FILE")
      .check(check_existing_file);
  command.heading("States");
  command.option("--resume", run.resume, "state file to start from").shown_as("FILE");
  command.runs([arguments] { return show(*arguments); });
}

}  // namespace flexarm::cli
