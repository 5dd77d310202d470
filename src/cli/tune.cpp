#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "accuracy/run_settings.h"
#include "accuracy/tuning.h"
#include "cli/accurate_simulation.h"
#include "cli/commands.h"
#include "cli/effort_schedule.h"
#include "cli/files.h"
#include "cli/installation.h"
#include "cli/interruptions.h"
#include "cli/page_options.h"
#include "cli/progress_bar.h"
#include "cli/scene_input.h"
#include "cli/tuned_scene.h"
#include "cli/tuning_table.h"
#include "flexarm/scene/scene_description.h"
#include "pictures/page.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

struct TuneArguments {
  SceneInput scene;
  std::string output, commands;
  std::optional<double> accuracy, real_time;
  double margin = 1.5;
  double until = 10;  // s
  TuningFreedom freedom;
  TrialLimits limits;
  PageOptions page;
};

/// Largest number of times at which motions are compared.
constexpr int kMostJudgedTimes = 150;

/// The output file; by default STEM_tuned.urdf in the working folder.
std::string output_of(const TuneArguments& arguments) {
  const fs::path scene = arguments.scene.path;
  return !arguments.output.empty() ? arguments.output : scene.stem().string() + "_tuned" + scene.extension().string();
}

std::string content_of(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The scene; throws if no simulation of it can be built.
scene::SceneDescription read(const SceneInput& input) {
  return load_simulation(input).scene();
}

void check(const TuneArguments& arguments) {
  if (arguments.accuracy.has_value() == arguments.real_time.has_value())
    throw InputError("flexarm: tune: either --accuracy or --real-time is expected");
  const std::string output = output_of(arguments);
  if (is_standard_output(output))
    throw InputError("flexarm: --output: the tuned scene must be a file; for a file called '-', write './-'");
  refuse_overwriting("--output", output, arguments.scene.path);
  require_writable("--output", output);
}

TuningResult search(const TuneArguments& arguments, TrialRuns& trials) {
  ProgressBar bar(0, 1, true, true);
  TuningGoal goal;
  goal.accuracy = arguments.accuracy;
  if (arguments.real_time) goal.load = 1 / (*arguments.real_time * arguments.margin);
  return tune(trials, goal, arguments.freedom, [&](double part, const std::string& what) { bar.show(part, what); });
}

/// Prints the requirements and the results, in sentences.
void print_result(const TuneArguments& arguments, const TuningResult& result, const JudgedTimes& times) {
  fmt::print("{}", tuning_table(result, times));
  if (!result.shortcoming.empty()) fmt::print("{}\n", result.shortcoming);
  fmt::print("{} runs, {:.3g} s of computing\n", result.runs.size(), result.seconds);
  if (!result.best) return;
  const TunedRun& best = result.runs[*result.best];
  fmt::print("error: {:.3g} as estimated, {:.3g} against the reference", result.estimate, best.error);
  if (result.reference) fmt::print(", whose own error is {:.2g}", result.reference_error);
  fmt::print("; 1 is {:.4g} m\n", result.scale);
  fmt::print("{:.3g} times real time\n", times.until() / best.seconds);
  fmt::print("{}", drift_text(best.settings.scheme, best.energy_drift));
  if (!result.is_met)
    fmt::print("{} cannot be met; this is the most accurate run that was found\n",
               arguments.accuracy ? fmt::format("an error of {:g}", *arguments.accuracy)
                                  : fmt::format("{:g} times real time", *arguments.real_time));
}

/// A run of the scene; if it fails or is interrupted, until then.
pictures::EncodedRun recorded(const TuneArguments& arguments, const scene::SceneDescription& scene,
                              const std::string& title) {
  Simulation simulation(scene);
  const std::function<void(Simulation&)> command = effort_commands(arguments.commands)(simulation);
  pictures::Recording recording(simulation, {title});
  recording.run(simulation, arguments.until, [&](Simulation& commanded) {
    command(commanded);
    return interruption() == 0;
  });
  return recording.encode();
}

/// Writes a page that plays the scene as it was beside the tuned one.
void write_tuning_page(const TuneArguments& arguments, const std::string& path, const scene::SceneDescription& scene,
                       const RunSettings& settings) {
  write_page(arguments.page, path,
             {recorded(arguments, scene, scene.name),
              recorded(arguments, with_settings(scene, settings), scene.name + ", tuned")},
             stdout);
}

int tune_scene(const TuneArguments& arguments) {
  check(arguments);
  const std::string page = page_path(arguments.page, arguments.scene, "_tuned");
  const scene::SceneDescription scene = read(arguments.scene);
  catch_interruptions();
  const JudgedTimes times = judged_times(arguments.until, scene.integrator.step, kMostJudgedTimes);
  TrialRuns trials(scene, times, arguments.limits, effort_commands(arguments.commands),
                   [] { return interruption() == 0; });
  const TuningResult result = search(arguments, trials);
  print_result(arguments, result, times);

  const fs::path output = output_of(arguments);
  const std::string data = fs::path(output).replace_extension(".csv").string(),
                    picture = fs::path(output).replace_extension(".png").string();
  write_file(data, tuning_csv(result, times));
  if (result.is_met) {
    write_file(output.string(),
               tuned_text(content_of(arguments.scene.path), scene, result.runs[*result.best].settings));
    fmt::print("{}\n", output.string());
  }
  fmt::print("{}\n", data);
  if (draw("plot_tuning.py", data, picture))
    fmt::print("{}\n", picture);
  else
    fmt::print(stderr, "flexarm: no picture: it needs python3-matplotlib\n");
  if (!page.empty() && result.best) write_tuning_page(arguments, page, scene, result.runs[*result.best].settings);
  if (interruption() != 0)
    throw Interrupted(result.is_met ? "interrupted; the best settings so far are written"
                                    : "interrupted; no scene is written");
  return result.is_met ? kDone : kFailed;
}

}  // namespace

void add_tune(CommandLine& line) {
  const auto arguments = std::make_shared<TuneArguments>();
  Command& command = line.command(
      "tune",
      "Finds the cheapest meshes, scheme, step and tolerance for an accuracy, or the most accurate for a speed");
  add_scene(command, arguments->scene);
  command.heading("Goal: --accuracy or --real-time");
  command.option("--accuracy", arguments->accuracy, "error of the probes, relative to their largest displacement")
      .check(check_positive);
  command
      .option("--real-time", arguments->real_time,
              "finds the most accurate settings for this speed, as a multiple of real time")
      .check(check_positive);
  command.option("--margin", arguments->margin, "safety factor for --real-time: runs must be this many times faster")
      .shows_default()
      .check(check_positive);
  command.heading("Search");
  command.option("--until", arguments->until, "end of the motion with which settings are compared [s]")
      .shows_default()
      .check(check_positive);
  command.option("--commands", arguments->commands, "file of efforts, like config/demo_commands.yaml")
      .shown_as("FILE")
      .check(check_existing_file);
  command.flag("--any-scheme", arguments->freedom.any_scheme,
               "also tries schemes that do not conserve what the scene's scheme conserves");
  command.option("--budget", arguments->limits.seconds, "limit of the search's processor time [s]")
      .shows_default()
      .check(check_positive);
  command.heading("Output");
  command
      .option("--output", arguments->output,
              "file for the tuned scene (SCENE_tuned.urdf); a table and a picture go beside it")
      .shown_as("FILE");
  add_page(command, arguments->page);
  command.runs([arguments] { return tune_scene(*arguments); });
}

}  // namespace flexarm::cli
