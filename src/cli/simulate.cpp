#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "cli/accurate_simulation.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/interruptions.h"
#include "cli/progress_bar.h"
#include "cli/scene_input.h"
#include "cli/simulation_output.h"
#include "flexarm/accuracy/companion.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/run_summary.h"

namespace flexarm::cli {
namespace {

void check_places(const SimulateArguments& arguments) {
  for (const auto& [option, path] : {std::pair("--checkpoint", &arguments.checkpoint), {"--resume", &arguments.resume}})
    if (is_standard_output(*path))
      throw InputError(fmt::format("flexarm: {}: states are files, no streams: './-' is one of that name", option));
  for (const std::string& other : {arguments.scene.path, arguments.resume, arguments.checkpoint})
    refuse_overwriting("--output", arguments.output, other);
  refuse_overwriting("--checkpoint", arguments.checkpoint, arguments.scene.path);
  if (!arguments.columns.empty() && is_bag(arguments.output))
    throw InputError("flexarm: --columns: a bag has messages, not columns");
}

/// Times of more steps than this could not be told apart.
void check_duration(const SimulateArguments& arguments, const Simulation& simulation) {
  constexpr double kMostSteps = 1e15;
  const double steps = (arguments.until - simulation.time()) / simulation.step_size();
  if (steps > kMostSteps)
    throw InputError(fmt::format("flexarm: {:.3g} steps of {} s to --until {} s are more than {:.0e}", steps,
                                 simulation.step_size(), arguments.until, kMostSteps));
}

/// When checkpoints on the way are due, in simulated time.
class CheckpointTimes {
 public:
  CheckpointTimes(double begin, double every)
      : every_(every), next_(every > 0 ? begin + every : std::numeric_limits<double>::infinity()) {}

  /// At `time`, of a run in steps of `step` [s].
  bool is_due(double time, double step) {
    if (time < next_ - 0.5 * step) return false;
    next_ = std::max(next_ + every_, time);
    return true;
  }

 private:
  double every_, next_;
};

/// A step that begins there, or later, would only make up for the round-off of all those before it.
double last_beginning(double until, double step) {
  const double round_off = until / step * std::numeric_limits<double>::epsilon() * until;
  return until - std::clamp(round_off, 1e-6 * step, 0.5 * step);
}

/// Empty if no error is to be estimated.
std::optional<Companion> companion_of(const SimulateArguments& arguments, const Simulation& simulation) {
  if (!arguments.estimates_error) return std::nullopt;
  try {
    return std::optional<Companion>(std::in_place, simulation);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: --error-estimate: {}", error.what()));
  }
}

/// Steps to the end, to a failure or to an interruption; the output ends with the last good state.
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
  while (run.last.converged && simulation.time() < end && interruption() == 0) {
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

/// The run; if it cannot be written, the state at which that was noticed is kept.
Run run_and_keep(const SimulateArguments& arguments, Simulation& simulation) {
  try {
    const std::optional<double> accuracy = wanted_accuracy(arguments, simulation);
    return accuracy ? run_accurately(arguments, *accuracy, simulation) : run(arguments, simulation);
  } catch (const InputError&) {
    throw;  // nothing has happened yet
  } catch (const std::runtime_error&) {
    if (!arguments.checkpoint.empty()) write_checkpoint(simulation, arguments.checkpoint);
    throw;
  }
}

/// Says what went wrong and where the last good state is.
void report_failure(const SimulateArguments& arguments, const Simulation& simulation, const Run& run) {
  const std::string kept = !arguments.checkpoint.empty()
                               ? arguments.checkpoint
                               : std::filesystem::path(arguments.scene.path).stem().string() + ".last_good_state";
  fmt::print(stderr, "flexarm: simulation failed after t = {:.17g} s: {}\n", simulation.time(),
             simulation.explain(run.last));
  write_checkpoint(simulation, kept);
  fmt::print(stderr, "flexarm: the last good state is kept in '{}'\n", kept);
}

void print_warnings(const Simulation& simulation, const Run& run) {
  for (const std::string& warning : run.summary.warnings(simulation))
    fmt::print(stderr, "flexarm: warning: {}\n", warning);
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
}

/// Whatever of the files can be found wrong before the run is an error of input.
void prepare_files(const SimulateArguments& arguments, Simulation& simulation) {
  try {
    if (!arguments.resume.empty()) read_checkpoint(simulation, arguments.resume);
    if (!arguments.checkpoint.empty()) try_checkpoint(simulation, arguments.checkpoint);
  } catch (const std::runtime_error& error) {
    throw InputError("flexarm: " + std::string(error.what()));
  }
}

int simulate(const SimulateArguments& arguments) {
  check_places(arguments);
  SimulationOptions options = arguments.options;
  // A run that is stopped and resumed gives the same numbers as one that is not.
  options.reuse_factorisation = arguments.resume.empty() && arguments.checkpoint.empty();
  Simulation simulation = load_simulation(arguments.scene, options);
  prepare_files(arguments, simulation);
  check_duration(arguments, simulation);
  const double begin = simulation.time();
  catch_interruptions();
  const Run result = run_and_keep(arguments, simulation);
  print_warnings(simulation, result);
  if (!result.last.converged) {
    report_failure(arguments, simulation, result);
    return kFailed;
  }
  if (!arguments.checkpoint.empty()) write_checkpoint(simulation, arguments.checkpoint);
  if (!arguments.quiet) print_summary(arguments, simulation, begin, result);
  if (interruption() == 0) return result.is_accurate ? kDone : kFailed;
  fmt::print(stderr, "flexarm: interrupted at t = {:.17g} s\n", simulation.time());
  return kInterrupted + interruption();
}

// ---------------------------------------------------------------- options

void add_time_and_accuracy(Command& command, SimulateArguments& arguments) {
  command.heading("Time and accuracy");
  command.option("--until", arguments.until, "end time [s]").shows_default().check(check_non_negative);
  command.option("--step", arguments.options.step, "time step [s]").check(check_positive);
  command
      .option("--accuracy", arguments.accuracy,
              "error of probes, of the way that they move, or a millionth of the mechanism's size if that is more: "
              "steps are chosen for it (the scene's)")
      .check(check_part);
  command.option("--scheme", arguments.options.scheme, "integration scheme").choices(scheme_choices());
  command.option("--tolerance", arguments.options.tolerance, "of Newton's method").check(check_tolerance);
  command
      .option_of_words(
          "--on-failure",
          [&arguments](const Words& words) {
            arguments.options.on_failure = on_failure_called(words.back());
            return "";
          },
          "what becomes of a step that the scheme cannot do (the scene's)")
      .takes(1)
      .choices({"stop", "dissipate"});
  command.flag("--error-estimate", arguments.estimates_error,
               "estimates the error in time by steps of twice the length, for half as much time again");
}

void add_output(Command& command, SimulateArguments& arguments) {
  command.heading("Output");
  command
      .option("--output", arguments.output,
              "file for the results: .h5: HDF5, .bag: ROS bag, else CSV; -: standard output")
      .shown_as("FILE");
  command
      .option("--columns", arguments.columns,
              "of the output, in this order: patterns of names, with commas between them (\"joint/*,sensor/*/f?\")")
      .shown_as("PATTERN")
      .with_commas()
      .needs("--output");
  command.option("--every", arguments.every, "steps between rows of the output")
      .shows_default()
      .check(whole_number_between(1, 1000000000));
  command.option("--interval", arguments.interval, "time between rows of the output with an accuracy [s]")
      .check(check_positive);
  command.flag("--quiet", arguments.quiet, "no progress bar and no summary");
  command.heading("States");
  command.option("--resume", arguments.resume, "state file to start from").shown_as("FILE");
  command.option("--checkpoint", arguments.checkpoint, "state file to write at the end").shown_as("FILE");
  command.option("--checkpoint-every", arguments.checkpoint_every, "simulated time between writings of it [s]")
      .check(check_positive)
      .needs("--checkpoint");
}

}  // namespace

void add_simulate(CommandLine& line) {
  const auto arguments = std::make_shared<SimulateArguments>();
  Command& command = line.command("simulate", "Simulates a scene in time");
  add_scene(command, arguments->scene);
  add_time_and_accuracy(command, *arguments);
  add_output(command, *arguments);
  command.runs([arguments] { return simulate(*arguments); });
}

}  // namespace flexarm::cli
