#include "cli/accurate_simulation.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/automatic_meshes.h"
#include "cli/commands.h"
#include "cli/files.h"
#include "cli/interruptions.h"
#include "cli/progress_bar.h"
#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- meshes of beams with elements="auto"

namespace {

constexpr int kJudgedTimes = 100;

/// "elements: arm 5, forearm 3"; those that were chosen.
std::string names_of(const scene::SceneDescription& scene, const RunSettings& settings) {
  std::string text = "elements:";
  auto beam = settings.beams.begin();
  for (const scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    if (!link.beam->elements)
      text += fmt::format("{} {} {}", text.back() == ':' ? "" : ",", link.name, beam->elements.value_or(0));
    ++beam;
  }
  return text;
}

struct ChosenMeshes {
  double left;       ///< of the accuracy, for the steps
  double error = 0;  ///< of the meshes, as estimated, relative
  bool is_met = true;
};

/// Where beams ask for elements="auto", makes the simulation one whose meshes are chosen for the accuracy; says so on
/// the report's stream, and on the standard error output where they do not keep it. Nothing changes where a state is
/// read or kept: it is one of the scene's own meshes.
ChosenMeshes choose_meshes(const SimulateArguments& arguments, double accuracy, Simulation& simulation) {
  if (!arguments.resume.empty() || !arguments.checkpoint.empty()) return {accuracy};
  const scene::SceneDescription scene = simulation.scene();
  ProgressBar bar(0, 1, !arguments.quiet);
  TrialRuns trials(scene, {(arguments.until - simulation.time()) / kJudgedTimes, kJudgedTimes}, {}, {}, [&] {
    bar.show(0, "meshes");
    return interruption() == 0;
  });
  const AutomaticMeshes meshes = automatic_meshes(trials, kMeshShare * accuracy);
  bar.clear();
  if (!meshes.is_met)
    fmt::print(stderr, "flexarm: elements=\"auto\": the accuracy {:g} was not met: {}\n", accuracy, meshes.shortcoming);
  if (meshes.is_chosen) {  // else those of the present rule stay
    if (!arguments.quiet)
      fmt::print(report_stream(arguments), "{}; error {:.2g} estimated, after {} runs\n",
                 names_of(scene, meshes.settings), meshes.error, meshes.runs);
    simulation = Simulation(with_settings(scene, meshes.settings), arguments.options);
  }
  return {meshes.left(accuracy), meshes.error, meshes.is_met};
}

}  // namespace

// ---------------------------------------------------------------- runs

namespace {

/// Writes the rows of each try over those of the one before, and shows how far it is.
class TryOutput : public RunWatcher {
 public:
  TryOutput(const SimulateArguments& arguments, Run& run, double begin)
      : arguments_(arguments), run_(run), progress_(begin, arguments.until, !arguments.quiet) {}

  void begin(const Simulation& simulation, long steps, double estimate) override {
    label_ = std::isnan(estimate) ? fmt::format("{} steps", steps)
                                  : fmt::format("{} steps, error about {:.1e}", steps, estimate);
    output_.reset();  // writes to the summary
    run_.summary = RunSummary(simulation);
    output_ = open_output(arguments_, simulation, run_.summary);
  }

  bool after_step(const Simulation& simulation, const StepResult& result) override {
    note_last(simulation);
    run_.summary.count(simulation, result);
    last_ = result;
    progress_.show(simulation.time(), label_);
    return interruption() == 0;
  }

  void after_interval(const Simulation& simulation, double estimate) override {
    if (last_) last_->error_estimate = estimate;
    note_last(simulation);
    if (output_) output_->write_row(simulation);
  }

  void close(const Simulation& simulation) {
    note_last(simulation);
    if (output_) output_->close();
    run_.summary.look(simulation);
  }

 private:
  void note_last(const Simulation& simulation) {
    if (last_ && output_) output_->note_step(simulation, *last_);
    last_.reset();
  }

  const SimulateArguments& arguments_;
  Run& run_;
  ProgressBar progress_;
  std::string label_;
  std::unique_ptr<ResultWriter> output_;
  std::optional<StepResult> last_;  // waits for the estimate
};

AccuracyRequest request_of(const SimulateArguments& arguments, double accuracy, const Simulation& simulation) {
  AccuracyRequest request{accuracy, arguments.until};
  if (arguments.interval == 0) return request;
  const double count = (arguments.until - simulation.time()) / arguments.interval;
  request.intervals = static_cast<int>(std::lround(count));
  constexpr double kMost = 1e6;
  if (!(count < kMost) || request.intervals < 1 || std::abs(count - request.intervals) > 1e-9 * count)
    throw InputError(
        fmt::format("flexarm: --interval: expected a whole part of the {:g} s until --until, down to 1e-6 "
                    "of them, got {:g} s",
                    arguments.until - simulation.time(), arguments.interval));
  return request;
}

void check(const SimulateArguments& arguments) {
  if (is_standard_output(arguments.output))
    throw InputError("flexarm: --output: with an accuracy, a file is expected: each try writes it anew");
  if (arguments.every != 1) throw InputError("flexarm: --every: with an accuracy, rows are an --interval apart");
  if (arguments.checkpoint_every > 0)
    throw InputError("flexarm: --checkpoint-every: a run with an accuracy has states to keep at its end only");
}

/// By what errors are divided; of points that hardly move it is not their way.
std::string scale_text(const AccurateRun& run) {
  const double way = run.motion.largest_displacement();
  if (way >= run.scale) return fmt::format("{:.3g} m", run.scale);
  return fmt::format("{:.3g} m (a millionth of the mechanism's size: points move by {:.2g} m)", run.scale, way);
}

}  // namespace

std::optional<double> wanted_accuracy(const SimulateArguments& arguments, const Simulation& simulation) {
  if (arguments.accuracy) return arguments.accuracy;
  return arguments.options.step ? std::nullopt : simulation.scene().integrator.accuracy;
}

Run run_accurately(SimulateArguments arguments, double accuracy, Simulation& simulation) {
  check(arguments);
  const ChosenMeshes meshes = choose_meshes(arguments, accuracy, simulation);
  arguments.estimates_error = true;  // each try has an estimate anyway
  const AccuracyRequest request = request_of(arguments, meshes.left, simulation);
  const auto start = std::chrono::steady_clock::now();
  Run run{{}, RunSummary(simulation)};
  TryOutput output(arguments, run, simulation.time());
  AccurateRun result;
  try {
    result = run_to_accuracy(simulation, request, output);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: --accuracy: {}", error.what()));
  }
  output.close(simulation);
  run.last = result.last;
  run.scheme = result.scheme();
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const bool are_steps_good = result.end == AccurateRun::End::Met;
  run.is_accurate = are_steps_good && meshes.is_met;
  if (!are_steps_good && result.end != AccurateRun::End::Failed)
    fmt::print(stderr, "flexarm: {}\n", shortcoming(result, accuracy, meshes.error));
  else if (run.is_accurate && !arguments.quiet)
    fmt::print(report_stream(arguments),
               "accuracy {:g} asked for, error {:.2g} estimated, of {}; {} steps of {}; {} tries, {} steps in all\n",
               accuracy, result.estimate() + meshes.error, scale_text(result), result.tries.back().steps,
               result.scheme(), result.tries.size(), result.steps);
  return run;
}

}  // namespace flexarm::cli
