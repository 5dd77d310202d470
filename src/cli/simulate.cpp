#include <chrono>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "cli/scene_input.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/csv_writer.h"

namespace flexarm::cli {
namespace {

struct Arguments {
  SceneInput scene;
  std::string output, resume, checkpoint;
  double until = 10;  // s
  int every = 1;
  bool quiet = false;
  SimulationOptions options;
};

/// How a run went.
struct Run {
  StepResult last;  // of the last step; converged unless the run failed
  long steps = 0, iterations = 0, halvings = 0;
  double seconds = 0;  // of the wall clock
};

std::optional<CsvWriter> open_output(const Arguments& arguments, const Simulation& simulation) {
  if (arguments.output.empty()) return std::nullopt;
  try {
    return CsvWriter(arguments.output, simulation, CsvWriter::Columns::StateAndSolver);
  } catch (const std::runtime_error& error) {
    throw InputError("flexarm: " + std::string(error.what()));
  }
}

/// Steps to the end, to a failure or to an interruption; the output ends with the last good state.
Run run(const Arguments& arguments, Simulation& simulation) {
  std::optional<CsvWriter> output = open_output(arguments, simulation);
  ProgressBar progress(simulation.time(), arguments.until, !arguments.quiet);
  const auto start = std::chrono::steady_clock::now();
  Run run;
  run.last.converged = true;
  if (output) output->write_row(simulation);
  double written = simulation.time();
  // A step that would only make up for round-off is not taken.
  const double end = arguments.until - 1e-6 * simulation.step_size();
  while (run.last.converged && simulation.time() < end && !is_interrupted()) {
    run.last = simulation.step();
    ++run.steps;
    run.iterations += run.last.iterations;
    run.halvings += run.last.halvings;
    progress.show(simulation.time());
    if (!output) continue;
    output->count(run.last);
    if (run.last.converged && run.steps % arguments.every != 0) continue;
    if (simulation.time() > written) output->write_row(simulation);
    written = simulation.time();
  }
  if (output && simulation.time() > written) output->write_row(simulation);
  if (output) output->close();
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

/// Says what went wrong and where the last good state is.
void report_failure(const Arguments& arguments, const Simulation& simulation, const Run& run) {
  const std::string kept = !arguments.checkpoint.empty()
                               ? arguments.checkpoint
                               : std::filesystem::path(arguments.scene.path).stem().string() + ".last_good_state";
  fmt::print(stderr, "flexarm: simulation failed after t = {:.17g} s: {}\n", simulation.time(),
             to_string(run.last.reason));
  write_checkpoint(simulation, kept);
  fmt::print(stderr, "flexarm: the last good state is kept in '{}'\n", kept);
}

int simulate(const Arguments& arguments) {
  SimulationOptions options = arguments.options;
  // A run that is stopped and resumed gives the same numbers as one that is not.
  options.reuse_factorisation = arguments.resume.empty() && arguments.checkpoint.empty();
  Simulation simulation = load_simulation(arguments.scene, options);
  if (!arguments.resume.empty()) {
    try {
      read_checkpoint(simulation, arguments.resume);
    } catch (const std::runtime_error& error) {
      throw InputError("flexarm: " + std::string(error.what()));
    }
  }
  const double begin = simulation.time();
  catch_interruptions();
  const Run result = run(arguments, simulation);
  if (!result.last.converged) {
    report_failure(arguments, simulation, result);
    return kFailed;
  }
  if (!arguments.checkpoint.empty()) write_checkpoint(simulation, arguments.checkpoint);
  if (is_interrupted()) fmt::print(stderr, "flexarm: interrupted at t = {:.17g} s\n", simulation.time());
  if (!arguments.quiet)
    fmt::print(
        "t = {:.6g} s after {} steps ({}, {:.2f} iterations per step, {} halvings), {:.3g} s of computing, {:.3g} "
        "times real time\n",
        simulation.time(), result.steps, simulation.scheme(),
        result.steps > 0 ? static_cast<double>(result.iterations) / static_cast<double>(result.steps) : 0.0,
        result.halvings, result.seconds, result.seconds > 0 ? (simulation.time() - begin) / result.seconds : 0.0);
  return kDone;
}

}  // namespace

void add_simulate(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("simulate", "Simulates a scene in time");
  add_scene(*command, arguments->scene);
  command->add_option("--until", arguments->until, "end time [s]")->capture_default_str()->check(check_non_negative);
  command->add_option("--step", arguments->options.step, "time step [s]")->check(check_positive);
  command->add_option("--scheme", arguments->options.scheme, "integration scheme");
  command->add_option("--tolerance", arguments->options.tolerance, "of Newton's method")->check(check_positive);
  command->add_option("--output", arguments->output, "CSV file for the results");
  command->add_option("--every", arguments->every, "steps between rows of the output")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000000));
  command->add_option("--resume", arguments->resume, "state file to start from");
  command->add_option("--checkpoint", arguments->checkpoint, "state file to write at the end");
  command->add_flag("--quiet", arguments->quiet, "no progress bar and no summary");
  command->callback([arguments, &status] { status = simulate(*arguments); });
}

}  // namespace flexarm::cli
