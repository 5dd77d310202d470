#include "bench/accuracy.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/automatic_meshes.h"
#include "accuracy/processor_time.h"
#include "accuracy/tuning.h"
#include "bench/effort_schedule.h"
#include "bench/median.h"
#include "bench/random_arms.h"
#include "bench/speed.h"
#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::bench {
namespace {

constexpr double kAccuracies[] = {1e-2, 1e-3, 1e-4, 1e-5};
constexpr int kIntervals = 100;
/// Of the processor, for each scene: what its search and its runs may take [s].
constexpr double kSearchSeconds = 4, kRunSeconds = 1.5;
/// A reference that is farther off than this part of what is asked for judges nothing.
constexpr double kGoodReference = 0.2;
/// Nobody looks for errors below it.
constexpr double kFinest = 1e-8;

/// Times that show a scene's motion, by file: the others have this one [s].
constexpr double kUntil = 1;
double until_of(const std::string& file) {
  const std::pair<const char*, double> known[] = {
      {"cantilever", 0.2}, {"thesis", 0.2}, {"curved", 0.2}, {"joints", 0.3}};
  for (const auto& [part, until] : known)
    if (file.find(part) != std::string::npos) return until;
  return kUntil;
}

scene::SceneDescription scene_of(scene::ReadResult read) {
  if (!read.scene) throw std::runtime_error(scene::to_text(read.diagnostics));
  return std::move(*read.scene);
}

/// Commands the tries of a run, times the last of them and counts its iterations. The clock is asked between intervals
/// alone, as in the runs of a search: where steps take microseconds, it would be a part of them.
class TimedTries : public RunWatcher {
 public:
  explicit TimedTries(StepCommand command) : command_(std::move(command)), begin_(processor_seconds()) {}

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
  void after_interval(const Simulation&, double) override { has_time_ = all() < kRunSeconds; }
  double last() const { return processor_seconds() - try_begin_; }
  double all() const { return processor_seconds() - begin_; }
  long iterations() const { return iterations_; }

 private:
  StepCommand command_;
  double begin_, try_begin_ = 0;
  long iterations_ = 0;
  bool has_time_ = true;
};

/// With meshes that were chosen, the run as somebody gets it who asks for the accuracy; its times are those of this
/// one.
AccurateRun run_accurately(const AccuracyCase& one, const AutomaticMeshes& meshes, AccuracyOutcome& out) {
  Simulation simulation(with_settings(one.scene, meshes.settings));
  const auto commands = effort_commands(one.commands);
  TimedTries tries(commands ? commands(simulation) : StepCommand());
  AccuracyRequest request;
  request.accuracy = meshes.left(out.asked);
  request.until = one.until;
  request.intervals = kIntervals;
  AccurateRun run = run_to_accuracy(simulation, request, tries);
  out.seconds = tries.last();
  out.all_seconds = meshes.seconds + tries.all();
  out.iterations = tries.iterations();
  out.estimate = run.estimate() + meshes.error;
  out.is_met = run.end == AccurateRun::End::Met && meshes.is_met;
  out.shortcoming = run.end != AccurateRun::End::Met ? to_string(run.end) : meshes.shortcoming;
  return run;
}

/// The error of what ran, and the best that a search finds for as small a one; empty: it finds none.
std::optional<RunSettings> judge(TrialRuns& trials, const JudgedMotion& motion, AccuracyOutcome& out) {
  TuningFreedom freedom;
  freedom.all_meshes = false;
  const auto search = [&](double accuracy) {
    TuningGoal goal;
    goal.accuracy = accuracy;
    return tune(trials, goal, freedom, [](double, const std::string&) {});
  };
  // Finer where the run is much better than was asked for.
  for (double wanted = out.asked; wanted > kFinest; wanted *= 0.1) {
    const TuningResult found = search(wanted);
    if (!found.reference || found.reference_error > kGoodReference * out.asked) return std::nullopt;
    const JudgedMotion& reference = trials.run(*found.reference).motion;
    out.reference_error = found.reference_error;
    out.error = motion_error(motion, reference, reference.largest_displacement());
    if (found.reference_error <= kGoodReference * *out.error) break;
  }
  if (!out.error || out.reference_error > kGoodReference * *out.error) return std::nullopt;
  const TuningResult best = search(*out.error);
  if (!best.is_met || !best.reference) return std::nullopt;
  const TunedRun& run = best.runs[*best.best];
  out.fixed_seconds = run.seconds;
  out.fixed_iterations = run.iterations;
  out.is_of_own_scheme = run.settings.scheme == trials.scene().integrator.scheme;
  out.fixed = fmt::format("{}, {}, {:.3g} s, {:.0e}", run.settings.mesh(), run.settings.scheme, run.settings.step,
                          run.settings.tolerance);
  return run.settings;
}

/// The run and the best fixed choice in turns, as a search times its best, so that neither has the machine at its worse
/// moments: medians of three.
void time_in_turns(const AccuracyCase& one, const AutomaticMeshes& meshes, TrialRuns& trials, const RunSettings& fixed,
                   AccuracyOutcome& out) {
  std::vector<double> last, all, best;
  for (int i = 0; i < 3; ++i) {
    AccuracyOutcome again = out;
    run_accurately(one, meshes, again);
    last.push_back(again.seconds);
    all.push_back(again.all_seconds);
    best.push_back(trials.time_again(fixed));
  }
  out.seconds = median(last);
  out.all_seconds = median(all);
  out.fixed_seconds = median(best);
}

AccuracyOutcome measure(const AccuracyCase& one, TrialRuns& trials, double asked) {
  AccuracyOutcome out;
  out.asked = asked;
  out.may_change_scheme = one.scene.integrator.scheme == "auto";
  try {
    const AutomaticMeshes meshes = automatic_meshes(trials, kMeshShare * asked);
    const AccurateRun run = run_accurately(one, meshes, out);
    if (!out.is_met) return out;
    const std::optional<RunSettings> fixed = judge(trials, run.motion, out);
    if (fixed) time_in_turns(one, meshes, trials, *fixed, out);
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

std::vector<AccuracyCase> accuracy_cases(const std::string& folder, const AccuracyScope& scope) {
  std::vector<AccuracyCase> cases;
  for (const SpeedProblem& problem : speed_problems()) {
    if (scope.random_arms || (scope.quick && problem.name != "six_joint_arm")) continue;
    cases.push_back({"speed", problem.name, scene_of(scene::read_scene_file(folder + "/" + problem.scene)),
                     problem.commands.empty() ? "" : folder + "/" + problem.commands,
                     scope.quick ? 0.1 : std::min(problem.until, 10.0)});
  }
  if (!scope.quick && !scope.random_arms)
    for (const char* group : {"examples", "thesis"}) add_files(cases, folder, group);
  const auto [first, count] = scope.random_arms.value_or(std::pair(0, scope.quick ? 2 : kRandomArms));
  for (int i = first; i < first + count; ++i)
    cases.push_back({"random", fmt::format("arm {}, {} joints", i, random_arm_joints(i)),
                     scene_of(scene::read_scene_text(random_arm(i), fmt::format("random arm {}", i))), "",
                     scope.quick ? 0.1 : 2.0});
  return cases;
}

AccuracyReport measure_accuracy(const std::string& folder, const AccuracyScope& scope,
                                const std::function<void(double, const std::string&)>& progress) {
  AccuracyReport report;
  report.scope = scope;
  const double begin = processor_seconds();
  const std::vector<AccuracyCase> cases = accuracy_cases(folder, scope);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const AccuracyCase& one = cases[i];
    AccuracyMeasurement measurement{one.group, one.name, one.until, {}};
    const auto show = [&] { progress(static_cast<double>(i) / static_cast<double>(cases.size()), one.name); };
    TrialLimits limits;
    limits.seconds = kSearchSeconds;
    TrialRuns trials(one.scene, {one.until / kIntervals, kIntervals}, limits, effort_commands(one.commands), [&] {
      show();
      return true;
    });
    for (const double asked : kAccuracies) {
      show();
      measurement.outcomes.push_back(measure(one, trials, asked));
      if (scope.quick) break;
    }
    report.measurements.push_back(std::move(measurement));
  }
  report.seconds = processor_seconds() - begin;
  return report;
}

}  // namespace flexarm::bench
