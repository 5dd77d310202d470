#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/accurate_simulation.h"
#include "cli/commands.h"
#include "cli/effort_schedule.h"
#include "cli/files.h"
#include "cli/interruptions.h"
#include "cli/progress_bar.h"
#include "cli/scene_input.h"
#include "cli/simulation_output.h"
#include "flexarm/accuracy/companion.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/run_summary.h"
#include "pictures/picture.h"
#include "simulation/inside.h"
#include "simulation/refinement.h"

namespace flexarm::cli {
namespace {

void check_places(const SimulateArguments& arguments) {
  for (const auto& [option, path] : {std::pair("--checkpoint", &arguments.checkpoint), {"--resume", &arguments.resume}})
    if (is_standard_output(*path))
      throw InputError(
          fmt::format("flexarm: {}: a state must be a file, not a stream; for a file called '-', write './-'", option));
  for (const std::string& other : {arguments.scene.path, arguments.resume, arguments.checkpoint})
    refuse_overwriting("--output", arguments.output, other);
  refuse_overwriting("--checkpoint", arguments.checkpoint, arguments.scene.path);
  if (is_standard_output(arguments.vtk))
    throw InputError("flexarm: --vtk: expected a folder, got '-'; for a folder called '-', write './-'");
  if (!arguments.columns.empty() && is_bag(arguments.output))
    throw InputError("flexarm: --columns: a bag has messages, not columns");
  if (!arguments.columns.empty() && is_page(arguments.output))
    throw InputError("flexarm: --columns: a page has all columns");
  warn_of_unknown_ending(arguments.output);
}

/// Refuses more steps than a double can count in time.
void check_duration(const SimulateArguments& arguments, const Simulation& simulation) {
  constexpr double kMostSteps = 1e15;
  const double steps = (arguments.until - simulation.time()) / simulation.step_size();
  if (steps > kMostSteps)
    throw InputError(fmt::format("flexarm: {:.3g} steps of {} s until --until {} s are more than the limit of {:.0e}",
                                 steps, simulation.step_size(), arguments.until, kMostSteps));
}

/// When intermediate checkpoints are due, in simulated time.
class CheckpointTimes {
 public:
  CheckpointTimes(double begin, double every)
      : every_(every), next_(every > 0 ? begin + every : std::numeric_limits<double>::infinity()) {}

  /// Whether a checkpoint is due at `time`; `step`: length of a step [s].
  bool is_due(double time, double step) {
    if (time < next_ - 0.5 * step) return false;
    next_ = std::max(next_ + every_, time);
    return true;
  }

 private:
  double every_, next_;
};

/// The last time at which a step may begin [s]. A later step would only make up for round-off.
double last_beginning(double until, double step) {
  const double round_off = 4 * std::numeric_limits<double>::epsilon() * until;
  return until - std::clamp(round_off, 1e-6 * step, 0.5 * step);
}

/// Empty if no error should be estimated.
std::optional<Companion> companion_of(const SimulateArguments& arguments, const Simulation& simulation) {
  if (!arguments.estimates_error) return std::nullopt;
  try {
    return std::optional<Companion>(std::in_place, simulation);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: --error-estimate: {}", error.what()));
  }
}

/// Steps until the end, a failure or an interruption. The output ends with the last good state.
/// @throws std::runtime_error if results or a checkpoint on the way cannot be written.
Run run(const SimulateArguments& arguments, Simulation& simulation) {
  CheckpointTimes checkpoints(simulation.time(), arguments.checkpoint_every);
  ProgressBar progress(simulation.time(), arguments.until, !arguments.quiet);
  const auto start = std::chrono::steady_clock::now();
  Run run{{}, RunSummary(simulation)};
  run.last.converged = true;
  const std::unique_ptr<ResultWriter> output = open_output(arguments, simulation, run.summary);
  if (output) output->write_row(simulation);
  double written = simulation.time();
  std::optional<Companion> companion = companion_of(arguments, simulation);
  const double end = last_beginning(arguments.until, simulation.step_size());
  const std::function<void(Simulation&)> command = effort_commands(arguments.commands)(simulation);
  while (run.last.converged && simulation.time() < end && interruption() == 0) {
    command(simulation);
    run.last = simulation.step();
    if (companion && run.last.converged) run.last.error_estimate = companion->follow(simulation);
    run.summary.count(simulation, run.last);
    progress.show(simulation.time());
    if (run.last.converged && checkpoints.is_due(simulation.time(), simulation.step_size()))
      write_checkpoint(simulation, arguments.checkpoint);
    if (!output) continue;
    output->note_step(simulation, run.last);
    if (run.last.converged && run.summary.counts().steps % arguments.every != 0) continue;
    if (simulation.time() > written) output->write_row(simulation);
    written = simulation.time();
  }
  if (output && simulation.time() > written) output->write_row(simulation);
  if (output) output->close();
  run.summary.look(simulation);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

/// Runs the simulation. If results cannot be written, saves the state at that time, and throws.
Run run_and_keep(const SimulateArguments& arguments, Simulation& simulation) {
  try {
    const std::optional<double> accuracy = wanted_accuracy(arguments, simulation);
    return accuracy ? run_accurately(arguments, *accuracy, simulation) : run(arguments, simulation);
  } catch (const InputError&) {
    throw;  // nothing was simulated yet
  } catch (const std::runtime_error&) {
    if (!arguments.checkpoint.empty()) write_checkpoint(simulation, arguments.checkpoint);
    throw;
  }
}

void print_failure(const Simulation& simulation, const Run& run) {
  fmt::print(stderr, "flexarm: simulation failed after t = {:.17g} s: {}\n", simulation.time(),
             simulation.explain(run.last));
}

/// Prints what went wrong and where the last good state is. `is_repeated`: whether the run was one with refine="true".
void report_failure(const SimulateArguments& arguments, const Simulation& simulation, const Run& run,
                    bool is_repeated) {
  const std::string kept = !arguments.checkpoint.empty()
                               ? arguments.checkpoint
                               : std::filesystem::path(arguments.scene.path).stem().string() + ".last_good_state";
  print_failure(simulation, run);
  write_checkpoint(simulation, kept);
  fmt::print(stderr, "flexarm: the last good state is kept in '{}'{}\n", kept,
             is_repeated ? "; to read it, write refine=\"true\" in the beams of the scene" : "");
}

void print_warnings(const Simulation& simulation, const Run& run) {
  for (const std::string& warning : run.summary.warnings(simulation))
    fmt::print(stderr, "flexarm: warning: {}\n", warning);
}

/// The picture for pages and for ParaView. Prints which meshes it lacks.
std::shared_ptr<const pictures::Picture> picture_for(const SimulateArguments& arguments, const Simulation& simulation) {
  auto picture = std::make_shared<const pictures::Picture>(pictures::picture_of(simulation, {}));
  for (const std::string& note : picture->notes)
    fmt::print(stderr, "flexarm: warning: {}{}\n", arguments.vtk.empty() ? "" : "--vtk: ", note);
  return picture;
}

void print_summary(const SimulateArguments& arguments, const Simulation& simulation, double begin, const Run& run) {
  const StepCounts& counts = run.summary.counts();
  const std::string recoveries = recoveries_text(counts);
  fmt::print(report_stream(arguments),
             "t = {:.6g} s after {} steps ({}, {:.2f} iterations per step, {}), {:.3g} s of computing, {:.3g} times "
             "real time\n",
             simulation.time(), counts.steps, run.scheme.empty() ? simulation.scheme() : run.scheme,
             counts.steps > 0 ? static_cast<double>(counts.iterations) / static_cast<double>(counts.steps) : 0.0,
             recoveries.empty() ? "no halvings" : recoveries, run.seconds,
             run.seconds > 0 ? (simulation.time() - begin) / run.seconds : 0.0);
  if (!has_output(arguments) && arguments.checkpoint.empty())
    fmt::print("no results are kept: --output FILE writes them\n");
}

/// Opens or tries all files before the run, so that their errors count as errors of input.
void prepare_files(const SimulateArguments& arguments, Simulation& simulation) {
  try {
    if (!arguments.resume.empty()) read_checkpoint(simulation, arguments.resume);
    if (!arguments.checkpoint.empty()) try_checkpoint(simulation, arguments.checkpoint);
  } catch (const std::runtime_error& error) {
    throw InputError("flexarm: " + std::string(error.what()));
  }
}

/// Whether a run that failed may be done again from its beginning. It may not if somebody has read its results already,
/// if a state of it is wanted, since that would have another mesh than the scene, or if it was interrupted.
bool may_be_repeated(const SimulateArguments& arguments, const Simulation& simulation) {
  std::error_code none;
  const bool is_file =
      !is_standard_output(arguments.output) && std::filesystem::is_regular_file(arguments.output, none);
  return interruption() == 0 && (is_file || arguments.output.empty()) && arguments.resume.empty() &&
         arguments.checkpoint.empty() && !arguments.estimates_error && !wanted_accuracy(arguments, simulation);
}

/// The scene for another run, after one that failed since elements of a beam with refine="auto" have wound up: with
/// refine="true" where possible. These elements cannot be halved as late as that. (docs/notes/refinement.md 9)
/// @returns nothing if the run must not be repeated
std::optional<scene::SceneDescription> scene_to_repeat(const SimulateArguments& arguments,
                                                       const scene::SceneDescription& scene,
                                                       const Simulation& simulation, const StepResult& last) {
  if (last.reason != StepResult::Reason::BentTooFar || !may_be_repeated(arguments, simulation)) return std::nullopt;
  const int link = last.failure.place.link;
  if (scene.links[link].beam->refine) return std::nullopt;
  std::optional<scene::SceneDescription> refined = scene;
  refine_where_possible(scheme_of(simulation), model_of(simulation), *refined);
  if (!refined->links[link].beam->refine) refined.reset();
  return refined;
}

}  // namespace

int simulate(SimulateArguments arguments) {
  check_places(arguments);
  SimulationOptions options = arguments.options;
  // With checkpoints factorisations are not reused, so that a resumed run gives the same numbers as an uninterrupted
  // one.
  options.reuse_factorisation = arguments.resume.empty() && arguments.checkpoint.empty();
  const scene::SceneDescription scene = *read_scene(arguments.scene).scene;
  Simulation simulation = started(scene, options);
  prepare_files(arguments, simulation);
  check_duration(arguments, simulation);
  if (!wanted_accuracy(arguments, simulation)) warn_of_growth(simulation);
  const double begin = simulation.time();
  if (!arguments.vtk.empty() || is_page(arguments.output)) arguments.picture = picture_for(arguments, simulation);
  catch_interruptions();
  Run result = run_and_keep(arguments, simulation);
  std::optional<scene::SceneDescription> again = scene_to_repeat(arguments, scene, simulation, result.last);
  if (again) {
    print_failure(simulation, result);
    fmt::print(
        stderr,
        "flexarm: warning: the run is repeated from its beginning with refine=\"true\" of beams; to prevent this, "
        "write refine=\"false\"\n");
    simulation = Simulation(std::move(*again), options);
    result = run_and_keep(arguments, simulation);
  }
  print_warnings(simulation, result);
  if (!result.last.converged) {
    report_failure(arguments, simulation, result, again.has_value());
    return kFailed;
  }
  if (!arguments.checkpoint.empty()) write_checkpoint(simulation, arguments.checkpoint);
  if (!arguments.quiet) print_summary(arguments, simulation, begin, result);
  if (interruption() == 0) return result.is_accurate ? kDone : kFailed;
  fmt::print(stderr, "flexarm: interrupted at t = {:.17g} s\n", simulation.time());
  return kInterrupted + interruption();
}

// ---------------------------------------------------------------- options

void add_commands(Command& command, SimulateArguments& arguments) {
  command.heading("The scene");
  command.option("--commands", arguments.commands, "file of efforts, like config/demo_commands.yaml")
      .shown_as("FILE")
      .check(check_existing_file);
}

void add_time_and_accuracy(Command& command, SimulateArguments& arguments) {
  command.heading("Time and accuracy");
  command.option("--until", arguments.until, "end time [s]").shows_default().check(check_non_negative);
  command.option("--step", arguments.options.step, "time step [s]").check(check_positive);
  command
      .option("--accuracy", arguments.accuracy,
              "chooses the steps for this error of the probes, relative to their largest displacement, or to the "
              "mechanism's size if they rest (the scene's)")
      .check(check_part);
  command.option("--scheme", arguments.options.scheme, "integration scheme").choices(scheme_choices());
  command
      .option("--tolerance", arguments.options.tolerance,
              "of Newton's method. Steps leave its square, so that round-off hides what is below 3e-8")
      .check(check_tolerance);
  command
      .option_of_words(
          "--on-failure",
          [&arguments](const Words& words) {
            arguments.options.on_failure = on_failure_called(words.back());
            return "";
          },
          "what happens if the scheme fails in a step (the scene's)")
      .takes(1)
      .choices({"stop", "dissipate"});
  command.flag(
      "--error-estimate", arguments.estimates_error,
      "estimates the error of the steps by a second run with steps of twice the length; takes half as much time again");
}

namespace {

void add_output(Command& command, SimulateArguments& arguments) {
  command.heading("Output");
  command
      .option("--output", arguments.output,
              "file for the results: .h5: HDF5, .bag: ROS bag, .html: page that plays the run, else CSV; -: standard "
              "output")
      .shown_as("FILE");
  command
      .option("--columns", arguments.columns,
              "columns of the output, in this order: patterns of names, separated by commas (\"joint/*,sensor/*/f?\")")
      .shown_as("PATTERN")
      .with_commas()
      .needs("--output");
  command
      .option(
          "--vtk", arguments.vtk,
          "folder for ParaView: beams, bodies and wrenches as VTK files, listed in run.pvd; an earlier run there is "
          "replaced")
      .shown_as("FOLDER");
  command.option("--vtk-rate", arguments.vtk_rate, "instants for ParaView per second of simulated time, at most")
      .shows_default()
      .check(check_positive)
      .needs("--vtk");
  command.option("--every", arguments.every, "steps between rows of the output, from which --vtk takes its instants")
      .shows_default()
      .check(whole_number_between(1, 1000000000));
  command.option("--interval", arguments.interval, "time between rows of the output with an accuracy [s]")
      .check(check_positive);
  command.flag("--quiet", arguments.quiet, "no progress bar and no summary");
  command.heading("States");
  command.option("--resume", arguments.resume, "state file to start from").shown_as("FILE");
  command.option("--checkpoint", arguments.checkpoint, "state file to write at the end").shown_as("FILE");
  command
      .option("--checkpoint-every", arguments.checkpoint_every, "simulated time between intermediate checkpoints [s]")
      .check(check_positive)
      .needs("--checkpoint");
}

}  // namespace

void add_simulate(CommandLine& line) {
  const auto arguments = std::make_shared<SimulateArguments>();
  Command& command = line.command("simulate", "Simulates a scene in time");
  add_scene(command, arguments->scene);
  add_commands(command, *arguments);
  add_time_and_accuracy(command, *arguments);
  add_output(command, *arguments);
  command.runs([arguments] { return simulate(*arguments); });
}

}  // namespace flexarm::cli
