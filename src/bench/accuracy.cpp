#include "bench/accuracy.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/automatic_meshes.h"
#include "accuracy/processor_time.h"
#include "accuracy/tuning.h"
#include "bench/best_fixed.h"
#include "bench/median.h"
#include "bench/random_arms.h"
#include "bench/speed.h"
#include "cli/effort_schedule.h"
#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::bench {
namespace {

constexpr double kAccuracies[] = {1e-2, 1e-3, 1e-4, 1e-5};
/// Limits of processor time for each scene: for the search of fixed settings, and for the runs [s].
constexpr double kSearchSeconds = 4, kRunSeconds = 1.5;
/// The same limits for scenes with an outside reference, which needs no runs of its own [s].
constexpr double kOutsideSearchSeconds = 1.5, kOutsideRunSeconds = 3;
/// Limit for a finer run with shifted steps [s].
constexpr double kShiftedSeconds = 4;
/// A reference is not used if its error exceeds this fraction of the requested accuracy.
constexpr double kGoodReference = 0.1;
/// Tolerance of Newton's method in a reference.
constexpr double kReferenceTolerance = 1e-9;
/// Runs that take longer are timed only once [s].
constexpr double kLong = 0.3;
/// The search does not look for smaller errors.
constexpr double kFinest = 1e-8;

/// Durations that show the motion of a scene, by parts of file names; the default is kUntil [s].
constexpr double kUntil = 1;
double until_of(const std::string& file) {
  const std::pair<const char*, double> known[] = {
      {"cantilever", 0.2}, {"thesis", 0.2}, {"curved", 0.2}, {"joints", 0.3}};
  for (const auto& [part, until] : known)
    if (file.find(part) != std::string::npos) return until;
  return kUntil;
}

/// Whether a scene of the speed report or of config/ has corners: tables of loads, pulses, dry friction.
bool is_cornered(const std::string& name) {
  const char* known[] = {
      "right_angle_cantilever", "flying_spaghetti", "demo_arm", "flexible_two_link_arm", "12_4", "joints"};
  return std::any_of(std::begin(known), std::end(known),
                     [&](const char* part) { return name.find(part) != std::string::npos; });
}

scene::SceneDescription scene_of(scene::ReadResult read) {
  if (!read.scene) throw std::runtime_error(scene::to_text(read.diagnostics));
  return std::move(*read.scene);
}

std::string text_of(const RunSettings& settings) {
  return fmt::format("{}, {}, {:.3g} s, {:.0e}", settings.mesh(), settings.scheme, settings.step, settings.tolerance);
}

/// Passes commands to the tries of a run, times the last one, and counts its iterations. It reads the clock only
/// between intervals, as the runs of a search do: if steps take microseconds, clock readings would distort the times.
class TimedTries : public RunWatcher {
 public:
  TimedTries(StepCommand command, double most_seconds)
      : command_(std::move(command)), most_seconds_(most_seconds), begin_(processor_seconds()) {}

  void begin(const Simulation&, long, double) override {
    try_begin_ = processor_seconds();
    iterations_ = 0;
  }
  void before_step(Simulation& simulation) override {
    if (command_) command_(simulation);
  }
  bool after_step(const Simulation&, const StepResult& result) override {
    iterations_ += result.iterations;
    return has_time_;
  }
  void after_interval(const Simulation&, double) override { has_time_ = all() < most_seconds_; }
  double last() const { return processor_seconds() - try_begin_; }
  double all() const { return processor_seconds() - begin_; }
  long iterations() const { return iterations_; }

 private:
  StepCommand command_;
  double most_seconds_, begin_, try_begin_ = 0;
  long iterations_ = 0;
  bool has_time_ = true;
};

/// Runs to the requested accuracy as a user would, with automatically chosen meshes, and fills in `out`, with the times
/// of this run.
AccurateRun run_accurately(const AccuracyCase& one, const AutomaticMeshes& meshes, AccuracyOutcome& out) {
  Simulation simulation(with_settings(one.scene, meshes.settings));
  const auto commands = cli::effort_commands(one.commands);
  TimedTries tries(commands ? commands(simulation) : StepCommand(), one.truth ? kOutsideRunSeconds : kRunSeconds);
  AccuracyRequest request;
  request.accuracy = meshes.left(out.asked);
  request.until = one.until;
  request.intervals = one.intervals;
  AccurateRun run = run_to_accuracy(simulation, request, tries);
  out.seconds = tries.last();
  out.all_seconds = meshes.seconds + tries.all();
  out.iterations = tries.iterations();
  out.estimate = run.estimate() + meshes.error;
  out.is_met = run.end == AccurateRun::End::Met && meshes.is_met;
  out.shortcoming = run.end != AccurateRun::End::Met ? to_string(run.end) : meshes.shortcoming;
  return run;
}

/// The motion of a finer run with half the step and shifted steps, and an estimate of the error. It is the difference
/// to the reference of the search or, if that is larger, the error that the search itself estimates for its reference.
struct FinerRun {
  JudgedMotion motion;
  double error;
};
FinerRun finer_run(TrialRuns& trials, const AccuracyCase& one, const TuningResult& found) {
  const JudgedMotion& nested = trials.run(*found.reference).motion;
  RunSettings finer = *found.reference;
  finer.step /= 2;
  std::optional<JudgedMotion> shifted =
      shifted_motion(one.scene, finer, trials.times(), cli::effort_commands(one.commands), kShiftedSeconds);
  if (!shifted) return {nested, found.reference_error};
  const double gap = motion_error(nested, *shifted, shifted->largest_displacement());
  return {std::move(*shifted), std::max(gap, found.reference_error)};
}

/// Measures the error of the motion that ran. Returns the best fixed settings whose error is as small; empty: none
/// found.
std::optional<RunSettings> judge(TrialRuns& trials, const AccuracyCase& one, const JudgedMotion& motion,
                                 AccuracyOutcome& out) {
  TuningFreedom freedom;
  freedom.all_meshes = false;
  const auto search = [&](double accuracy) {
    TuningGoal goal;
    goal.accuracy = accuracy;
    return tune(trials, goal, freedom, [](double, const std::string&) {});
  };
  // Smaller errors are tried, too, since the run may be much better than requested.
  for (double wanted = out.asked; wanted > kFinest; wanted *= 0.1) {
    const TuningResult found = search(wanted);
    if (!found.reference || found.reference_error > kGoodReference * out.asked) return std::nullopt;
    const FinerRun finer = finer_run(trials, one, found);
    if (finer.error > kGoodReference * out.asked && wanted * 0.1 > kFinest) continue;
    if (finer.error > kGoodReference * out.asked) return std::nullopt;
    out.reference_error = finer.error;
    out.error = motion_error(motion, finer.motion, finer.motion.largest_displacement());
    if (finer.error <= kGoodReference * *out.error) break;
  }
  if (!out.error || out.reference_error > 2 * kGoodReference * *out.error) return std::nullopt;
  const TuningResult best = search(*out.error);
  if (!best.is_met || !best.reference) return std::nullopt;
  const TunedRun& run = best.runs[*best.best];
  out.fixed_seconds = run.seconds;
  out.fixed_iterations = run.iterations;
  out.is_of_own_scheme = run.settings.scheme == trials.scene().integrator.scheme;
  out.fixed = text_of(run.settings);
  return run.settings;
}

/// Times the run and the best fixed settings alternately, as a search does, so that changes of the machine's speed
/// affect them alike; takes medians of three.
void time_in_turns(const AccuracyCase& one, const AutomaticMeshes& meshes, const std::function<double()>& time_fixed,
                   AccuracyOutcome& out) {
  std::vector<double> last, all, best;
  for (int i = 0; i < (out.all_seconds > kLong ? 1 : 3); ++i) {
    AccuracyOutcome again = out;
    run_accurately(one, meshes, again);
    last.push_back(again.seconds);
    all.push_back(again.all_seconds);
    best.push_back(time_fixed());
  }
  out.seconds = median(last);
  out.all_seconds = median(all);
  out.fixed_seconds = median(best);
}

/// The scene's own meshes, as if automatic_meshes() had chosen them.
AutomaticMeshes given_meshes(const AccuracyCase& one) {
  AutomaticMeshes meshes;
  meshes.settings = settings_of(one.scene);
  meshes.is_met = true;
  return meshes;
}

JudgedTimes times_of(const AccuracyCase& one) {
  return {one.until / one.intervals, one.intervals};
}

/// Compares with the best fixed settings, for a scene whose true motion is known.
void compare(const AccuracyCase& one, FixedRuns& fixed, AccuracyOutcome& out) {
  const FixedRuns::Run* best = fixed.best(*out.error);
  if (!best) return;
  out.fixed_iterations = best->iterations;
  out.is_of_own_scheme = best->settings.scheme == one.scene.integrator.scheme;
  out.fixed = text_of(best->settings);
  time_in_turns(
      one, given_meshes(one), [&] { return fixed.time_again(*best); }, out);
}

void measure_outside(const AccuracyCase& one, FixedRuns& fixed, AccuracyOutcome& out) {
  const AccurateRun run = run_accurately(one, given_meshes(one), out);
  out.reference_error = one.truth_error;
  if (!out.is_met) return;
  out.error = motion_error(run.motion, *one.truth, one.truth->largest_displacement());
  compare(one, fixed, out);
}

/// The reference of a flexible scene with corners: runs with shifted steps, each with twice as many steps as the last
/// one, until two runs agree. The first one has 2.74 times the steps of the run to be judged, a ratio that no try has.
std::optional<FinerRun> shifted_reference(const AccuracyCase& one, const AccurateRun& run, double wanted) {
  RunSettings settings = settings_of(one.scene);
  settings.scheme = run.scheme();
  settings.tolerance = kReferenceTolerance;
  const JudgedTimes times = times_of(one);
  std::optional<JudgedMotion> last;
  for (double steps = std::ceil(2.74 * run.steps_per_interval); steps < 1e6; steps *= 2) {
    settings.step = times.interval / steps;
    std::optional<JudgedMotion> next =
        shifted_motion(one.scene, settings, times, cli::effort_commands(one.commands), kShiftedSeconds);
    if (!next) return std::nullopt;
    const double gap = last ? motion_error(*last, *next, next->largest_displacement()) : 1.0;
    if (gap <= wanted) return FinerRun{std::move(*next), gap};
    last = std::move(next);
  }
  return std::nullopt;
}

void measure_by_shifted_runs(const AccuracyCase& one, const std::function<void()>& show, AccuracyOutcome& out) {
  const AccurateRun run = run_accurately(one, given_meshes(one), out);
  if (!out.is_met) return;
  std::optional<FinerRun> finer = shifted_reference(one, run, kGoodReference * out.asked);
  if (!finer) return;
  out.reference_error = finer->error;
  out.error = motion_error(run.motion, finer->motion, finer->motion.largest_displacement());
  if (out.reference_error > 2 * kGoodReference * *out.error) return;
  FixedRuns fixed(one.scene, times_of(one), cli::effort_commands(one.commands), std::move(finer->motion),
                  kOutsideSearchSeconds, show);
  compare(one, fixed, out);
}

void measure_by_finer_runs(const AccuracyCase& one, TrialRuns& trials, AccuracyOutcome& out) {
  const AutomaticMeshes meshes = automatic_meshes(trials, kMeshShare * out.asked);
  const AccurateRun run = run_accurately(one, meshes, out);
  if (!out.is_met) return;
  const std::optional<RunSettings> fixed = judge(trials, one, run.motion, out);
  if (fixed)
    time_in_turns(
        one, meshes, [&] { return trials.time_again(*fixed); }, out);
}

bool has_given_meshes(const scene::SceneDescription& scene) {
  const std::vector<BeamResolution> beams = settings_of(scene).beams;
  return std::all_of(beams.begin(), beams.end(), [](const BeamResolution& beam) { return beam.elements.has_value(); });
}

/// Measures a scene for one accuracy. An exception that ends the run becomes its shortcoming.
template <class Measure>
AccuracyOutcome measure(const AccuracyCase& one, double asked, const Measure& measure_into) {
  AccuracyOutcome out;
  out.asked = asked;
  out.may_change_scheme = one.scene.integrator.scheme == "auto";
  try {
    measure_into(out);
  } catch (const std::invalid_argument& error) {
    out.shortcoming = error.what();
  } catch (const ModelError& error) {
    out.shortcoming = error.what();
  } catch (const SearchEnded& ended) {
    out.shortcoming = ended.what();
  }
  return out;
}

void add_files(std::vector<AccuracyCase>& cases, const std::string& folder, const std::string& group) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/" + group))
    if (entry.path().extension() == ".urdf") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  for (const std::string& path : paths)
    cases.push_back({group, std::filesystem::path(path).stem().string(), scene_of(scene::read_scene_file(path)), "",
                     until_of(path)});
}

}  // namespace

std::optional<double> AccuracyOutcome::cost() const {
  if (!fixed_seconds || !(*fixed_seconds > 0)) return std::nullopt;
  return seconds / *fixed_seconds;
}

std::vector<const AccuracyOutcome*> AccuracyReport::judged() const {
  std::vector<const AccuracyOutcome*> found;
  for (const AccuracyMeasurement& measurement : measurements)
    for (const AccuracyOutcome& outcome : measurement.outcomes)
      if (outcome.is_judged()) found.push_back(&outcome);
  return found;
}

std::vector<AccuracyCase> accuracy_cases(const std::string& folder, const std::string& references,
                                         const AccuracyScope& scope) {
  std::vector<AccuracyCase> cases;
  if (!references.empty())
    for (OutsideReference& one : read_outside_references(references, scope.only)) {
      AccuracyCase next{one.group, one.name, std::move(one.scene), "", one.until};
      next.is_cornered = one.is_cornered;
      next.intervals = one.intervals;
      if (one.is_there) next.truth = std::move(one.motion);
      next.truth_error = one.disagreement;
      cases.push_back(std::move(next));
    }
  const std::size_t listed = cases.size();
  for (const SpeedProblem& problem : speed_problems()) {
    if (scope.random_arms || (scope.quick && problem.name != "six_joint_arm")) continue;
    cases.push_back({"speed", problem.name, scene_of(scene::read_scene_file(folder + "/" + problem.scene)),
                     problem.commands.empty() ? "" : folder + "/" + problem.commands,
                     scope.quick ? 0.1 : std::min(problem.until, 10.0)});
  }
  if (!scope.quick && !scope.random_arms)
    for (const char* group : {"examples", "thesis"}) add_files(cases, folder, group);
  for (std::size_t i = listed; i < cases.size(); ++i) cases[i].is_cornered = is_cornered(cases[i].name);
  const auto [first, count] = scope.random_arms.value_or(std::pair(0, scope.quick ? 2 : kRandomArms));
  for (int i = first; i < first + count; ++i)
    cases.push_back({"random", fmt::format("arm {}, {} joints", i, random_arm_joints(i)),
                     scene_of(scene::read_scene_text(random_arm(i), fmt::format("random arm {}", i))), "",
                     scope.quick ? 0.1 : 2.0});
  const auto is_unwanted = [&](const AccuracyCase& one) {
    return (one.group + ": " + one.name).find(scope.only) == std::string::npos;
  };
  cases.erase(std::remove_if(cases.begin(), cases.end(), is_unwanted), cases.end());
  return cases;
}

AccuracyReport measure_accuracy(const std::vector<AccuracyCase>& cases, const AccuracyScope& scope,
                                const std::function<void(double, const std::string&)>& progress) {
  AccuracyReport report;
  report.scope = scope;
  const double begin = processor_seconds();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const AccuracyCase& one = cases[i];
    AccuracyMeasurement measurement{one.group, one.name, one.until, one.is_cornered, one.truth.has_value(), {}};
    const auto show = [&] { progress(static_cast<double>(i) / static_cast<double>(cases.size()), one.name); };
    TrialLimits limits;
    limits.seconds = kSearchSeconds;
    std::optional<TrialRuns> trials;
    std::optional<FixedRuns> fixed;
    const bool is_by_shifted_runs = !one.truth && one.is_cornered && has_given_meshes(one.scene);
    if (one.truth)
      fixed.emplace(one.scene, times_of(one), Commands(), *one.truth, kOutsideSearchSeconds, show);
    else if (!is_by_shifted_runs)
      trials.emplace(one.scene, times_of(one), limits, cli::effort_commands(one.commands), [&] {
        show();
        return true;
      });
    for (const double asked : kAccuracies) {
      show();
      measurement.outcomes.push_back(measure(one, asked, [&](AccuracyOutcome& out) {
        if (one.truth)
          measure_outside(one, *fixed, out);
        else if (is_by_shifted_runs)
          measure_by_shifted_runs(one, show, out);
        else
          measure_by_finer_runs(one, *trials, out);
      }));
      if (scope.quick) break;
    }
    report.measurements.push_back(std::move(measurement));
  }
  report.seconds = processor_seconds() - begin;
  return report;
}

}  // namespace flexarm::bench
