#include "cli/accurate_simulation.h"

#include <algorithm>
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
#include "schemes/scheme.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- meshes of beams with elements="auto"

namespace {

constexpr int kJudgedTimes = 100;

/// Lists the numbers of elements that were chosen: "elements: arm 5, forearm 3".
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
  double left;       ///< part of the accuracy that is left for the steps
  double error = 0;  ///< estimated error of the meshes, relative
  bool is_met = true;
};

/// If beams have elements="auto", rebuilds the simulation with meshes that are chosen for the accuracy, and says so on
/// the report's stream. Says on standard error if the meshes do not meet the accuracy. Changes nothing if a state is
/// read or saved, since such a state belongs to the scene's own meshes.
ChosenMeshes choose_meshes(const SimulateArguments& arguments, double accuracy, Simulation& simulation) {
  if (!arguments.resume.empty() || !arguments.checkpoint.empty()) return {accuracy};
  const scene::SceneDescription scene = simulation.scene();
  ProgressBar bar(0, 1, !arguments.quiet, true);
  TrialRuns trials(scene, {(arguments.until - simulation.time()) / kJudgedTimes, kJudgedTimes}, {}, {}, [&] {
    bar.show(0, fmt::format("of run {} to choose meshes", trials.all().size() + 1));
    return interruption() == 0;
  });
  const AutomaticMeshes meshes = automatic_meshes(trials, kMeshShare * accuracy);
  bar.clear();
  if (!meshes.is_met)
    fmt::print(stderr, "flexarm: elements=\"auto\": the accuracy {:g} was not met: {}\n", accuracy, meshes.shortcoming);
  if (meshes.is_chosen) {  // else the meshes stay as they are
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

/// Whether the scheme conserves nothing, so that the report tells how energy drifts.
bool is_explicit(const Simulation& simulation) {
  return find_scheme(simulation.scheme())->tableau != nullptr;
}

/// Writes the rows of each try over those of the last one, and shows progress.
class TryOutput : public RunWatcher {
 public:
  TryOutput(const SimulateArguments& arguments, Run& run, double begin)
      : arguments_(arguments), run_(run), progress_(begin, arguments.until, !arguments.quiet, true) {}

  void begin(const Simulation& simulation, long steps, double estimate) override {
    label_ = fmt::format("of try {}: {} steps of {}", ++tries_, steps, simulation.scheme());
    if (!std::isnan(estimate)) label_ += fmt::format(", error about {:.1e}", estimate);
    output_.reset();  // before run_.summary is replaced, since the writer updates it
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
    if (output_)
      output_->write_row(simulation);
    else if (is_explicit(simulation))
      run_.summary.look(simulation);
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
  int tries_ = 0;
  std::unique_ptr<ResultWriter> output_;
  std::optional<StepResult> last_;  // kept until its error estimate is known
};

constexpr double kMostIntervals = 1e6;

/// The largest rate of outputs that show instants at a rate [1/s]; 0 if there is none.
double rate_of_instants(const SimulateArguments& arguments) {
  const double page = is_page(arguments.output) ? arguments.page_rate : 0;
  return std::max(page, arguments.vtk.empty() ? 0 : arguments.vtk_rate);
}

AccuracyRequest request_of(const SimulateArguments& arguments, double accuracy, const Simulation& simulation) {
  AccuracyRequest request{accuracy, arguments.until};
  // No more instants than the outputs take, so that these have equal distances.
  if (const double rate = rate_of_instants(arguments); arguments.interval == 0 && rate > 0)
    request.intervals = static_cast<int>(
        std::clamp(std::floor((1 + 1e-9) * (arguments.until - simulation.time()) * rate), 1.0, kMostIntervals));
  if (arguments.interval == 0) return request;
  const double count = (arguments.until - simulation.time()) / arguments.interval;
  request.intervals = static_cast<int>(std::lround(count));
  if (!(count < kMostIntervals) || request.intervals < 1 || std::abs(count - request.intervals) > 1e-9 * count)
    throw InputError(fmt::format(
        "flexarm: --interval: expected the {:g} s until --until divided by a whole number up to 1e6, got {:g} s",
        arguments.until - simulation.time(), arguments.interval));
  return request;
}

void check(const SimulateArguments& arguments) {
  if (is_standard_output(arguments.output))
    throw InputError("flexarm: --output: with an accuracy, a file is expected, since each try overwrites it");
  if (!arguments.commands.empty())
    throw InputError("flexarm: --commands cannot be used with an accuracy: choose a step by --step");
  if (arguments.every != 1) throw InputError("flexarm: --every cannot be used with an accuracy: use --interval");
  if (arguments.checkpoint_every > 0)
    throw InputError("flexarm: --checkpoint-every cannot be used with an accuracy: only the final state can be saved");
}

/// The length by which errors are divided. If points are at rest, it is not their largest displacement.
std::string scale_text(const AccurateRun& run) {
  const double way = run.motion.largest_displacement();
  if (way >= run.scale) return fmt::format("{:.3g} m", run.scale);
  return fmt::format("{:.3g} m (the mechanism's size, since points move by only {:.2g} m)", run.scale, way);
}

}  // namespace

std::string drift_text(const std::string& scheme, double drift) {
  if (!find_scheme(scheme)->tableau) return "";
  return fmt::format(
      "{} conserves no energy: energy - work + dissipation drifted by up to {:.2g} of the largest energy\n", scheme,
      drift);
}

std::optional<double> wanted_accuracy(const SimulateArguments& arguments, const Simulation& simulation) {
  if (arguments.accuracy) return arguments.accuracy;
  return arguments.options.step ? std::nullopt : simulation.scene().integrator.accuracy;
}

Run run_accurately(SimulateArguments arguments, double accuracy, Simulation& simulation) {
  check(arguments);
  const ChosenMeshes meshes = choose_meshes(arguments, accuracy, simulation);
  arguments.estimates_error = true;  // each try computes an estimate anyway
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
               "accuracy {:g} requested, error {:.2g} estimated, relative to {}; {} steps of {}; {} tries, {} steps in "
               "total\n{}",
               accuracy, result.estimate() + meshes.error, scale_text(result), result.tries.back().steps,
               result.scheme(), result.tries.size(), result.steps, drift_text(run.scheme, run.summary.energy_drift()));
  return run;
}

}  // namespace flexarm::cli
