#include "accuracy/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accuracy/candidates.h"
#include "flexarm/model/model_error.h"
#include "integrators/explicit_obstacle.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"
#include "simulation/refinement.h"

namespace flexarm {
namespace {

/// The share of the accuracy at which the search aims, since estimates are a few per cent off.
constexpr double kShare = 0.9;
/// Relative error of the pilot runs. Finer steps are not needed to measure meshes.
constexpr double kPilotError = 0.02;
const BeamResolution kPilotMesh{2, 3};
/// The share of the accuracy by which the reference may be off.
constexpr double kReferenceShare = 0.1;
constexpr double kReferenceTolerance = 1e-9;
/// If steps of a reference had to be halved, another one is made with kNextReference times as many steps. The last of
/// kReferenceTries is taken as it is.
constexpr int kReferenceTries = 4;
constexpr double kNextReference = 1.2;
/// Accuracies with which the search measures in turn if a speed is requested.
constexpr double kAccuracies[] = {0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
/// Tolerances of Newton's method. An iteration leaves an error of at most their square (docs/schemes.md).
constexpr double kTolerances[] = {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};

constexpr std::size_t kFinalists = 6;
constexpr int kTries = 5;    // of steps, for each finalist
constexpr int kTimings = 3;  // repetitions, and number of the best runs
/// A run is given up if it takes longer than the best one by this factor.
constexpr double kHopeless = 1.3;
/// A number of steps that is as near as this to the wanted one is good enough.
constexpr double kCloseEnough = 0.95;
/// The number of steps changes by the square root of the ratio of errors, which is limited to this.
constexpr double kSteepest = 16;

/// The largest tolerance that makes no difference: a thousand steps with its square make a hundredth of the accuracy.
double tolerance_for(double accuracy) {
  double tolerance = kTolerances[0];
  for (const double next : kTolerances)
    if (1000 * next * next <= 0.0101 * accuracy) tolerance = next;
  return tolerance;
}

bool suits_explicit_schemes(const scene::SceneDescription& scene) {
  try {
    return explicit_errors_are_known(model_of(Simulation(scene)));
  } catch (const ModelError&) {
    return false;
  }
}

/// The search, stage by stage. The result so far can be taken at any time.
class Search {
 public:
  Search(TrialRuns& trials, const TuningGoal& goal, const TuningFreedom& freedom, const TuningProgress& progress)
      : trials_(trials), goal_(goal), freedom_(freedom), progress_(progress) {}

  /// @throws SearchEnded
  void run();
  /// `ended`: why the search ended early; empty if it did not.
  TuningResult result(const std::string& ended);

 private:
  // stages
  void look_at_scene();
  void measure(double accuracy);
  double measure_for_load();
  void make_reference(double accuracy);
  void try_finalists(double accuracy);
  void loosen_tolerance();
  void time_finalists();

  void fit_error(RunSettings settings);
  void fit_load(RunSettings settings);
  RunSettings own() const { return settings_of(trials_.scene()); }
  RunSettings settings_for(const Candidate& candidate) const;

  double most_seconds() const {
    return goal_.load ? *goal_.load * trials_.times().until() : std::numeric_limits<double>::infinity();
  }
  /// The allowed error: the requested one, less the error of the reference.
  double most_error() const { return std::max(*goal_.accuracy - reference_error_, 0.5 * *goal_.accuracy); }
  double error(const TrialRun& run) const;
  double seconds_of(const TrialRun& run) const;
  bool is_good(const TrialRun& run) const;
  bool is_better(const TrialRun& a, const TrialRun& b) const;
  const TrialRun* best() const;
  const TrialRun* most_accurate() const;
  const TrialRun* finest() const;

  TrialRuns& trials_;
  const TuningGoal& goal_;
  const TuningFreedom& freedom_;
  const TuningProgress& progress_;
  bool is_for_explicit_ = false;
  const TrialRun* as_it_stands_ = nullptr;
  const TrialRun* reference_ = nullptr;
  CandidatePool pool_;
  double reference_error_ = 0, tolerance_ = 0;
  std::map<const TrialRun*, std::vector<double>> times_;
  std::vector<std::string> shortcomings_;
};

double Search::error(const TrialRun& run) const {
  return motion_error(run.motion, reference_->motion, reference_->length_of_errors());
}

bool Search::is_good(const TrialRun& run) const {
  if (!run.is_complete() || !reference_ || &run == reference_) return false;
  if (goal_.load) return seconds_of(run) <= most_seconds();
  return error(run) <= most_error();
}

bool Search::is_better(const TrialRun& a, const TrialRun& b) const {
  return goal_.load ? error(a) < error(b) : seconds_of(a) < seconds_of(b);
}

const TrialRun* Search::best() const {
  const TrialRun* found = nullptr;
  for (const TrialRun& run : trials_.all())
    if (is_good(run) && (!found || is_better(run, *found))) found = &run;
  return found;
}

void Search::look_at_scene() {
  progress_(0, "the scene as it stands");
  as_it_stands_ = &trials_.run(own());
  if (!as_it_stands_->is_complete()) shortcomings_.push_back("the scene as it stands: " + as_it_stands_->failure);
  is_for_explicit_ = suits_explicit_schemes(trials_.scene());
}

// Measures errors of meshes and steps, as finely as the accuracy requires.
void Search::measure(double accuracy) {
  RunSettings settings = own();
  const std::vector<std::string> schemes = schemes_alike(trials_.scene().integrator, freedom_.any_scheme);
  settings.tolerance = tolerance_ = tolerance_for(accuracy);
  // First steps on a mesh that cannot be far off, for the step of the pilots. Then meshes with that step. Then steps on
  // the chosen mesh.
  progress_(0.1, "steps");
  MeshFreedom meshes{{}, freedom_.rigid_beams, false};
  for (BeamResolution& beam : settings.beams) {
    meshes.is_free.push_back(freedom_.all_meshes || !beam.elements);
    if (meshes.is_free.back()) beam = kPilotMesh;
  }
  const StepErrors pilot = measure_steps(trials_, settings, std::max(kPilotError, accuracy), most_seconds());
  if (!pilot.has_errors()) throw SearchEnded("no run was completed: " + pilot.shortcoming);
  const double scale = pilot.runs.back()->length_of_errors();
  if (pilot.runs.back()->is_at_rest()) throw SearchEnded("no probe or tip moves, so that no error can be measured");
  settings.step = pilot.settings.step;
  progress_(0.2, "meshes");
  const MeshErrors mesh_errors = measure_meshes(trials_, settings, meshes, kReferenceShare * accuracy * scale);
  if (!mesh_errors.is_rich_enough) shortcomings_.push_back("meshes: " + mesh_errors.shortcoming);
  settings.beams = cheapest_mesh(mesh_choices(mesh_errors), 0.5 * accuracy * scale).beams;
  std::vector<StepErrors> steps;
  for (const std::string& scheme : schemes) {
    if (find_scheme(scheme)->tableau && !is_for_explicit_) continue;
    progress_(0.4 + 0.3 * static_cast<double>(steps.size()) / static_cast<double>(schemes.size()),
              "steps of " + scheme);
    settings.scheme = scheme;
    StepErrors errors = measure_steps(trials_, settings, 0.3 * accuracy, most_seconds());
    if (!errors.is_met && scheme == schemes.front()) shortcomings_.push_back("steps: " + errors.shortcoming);
    if (errors.has_errors()) steps.push_back(std::move(errors));
  }
  pool_ = CandidatePool(mesh_errors, std::move(steps), trials_.all(), scale, trials_.times().intervals);
}

// Measures as finely as the speed allows, and returns the accuracy that this gives.
double Search::measure_for_load() {
  double found = kAccuracies[0];
  for (const double accuracy : kAccuracies) {
    shortcomings_.clear();
    measure(accuracy);
    const std::vector<Candidate> best = pool_.most_accurate(most_seconds());
    if (best.empty() || best.front().error > accuracy) break;
    found = best.front().error;
  }
  return found;
}

// Makes a run that is so much more accurate than requested that others can be judged by it. Steps of em4 that go back
// through the damping of a beam have larger errors than longer steps, from which the error was predicted. If steps had
// to be halved, that is the cause (accuracy.md), and slightly shorter steps are good.
void Search::make_reference(double accuracy) {
  progress_(0.7, "reference");
  const Candidate finer = pool_.reference(kReferenceShare * accuracy);
  RunSettings settings = settings_for(finer);
  settings.tolerance = std::min(settings.tolerance, kReferenceTolerance);
  const TrialRun* run = nullptr;
  int parts = finer.parts;
  for (int i = 0; i < kReferenceTries && (!run || run->halvings > 0); ++i) {
    settings.step = trials_.times().interval / parts;
    run = &trials_.run(settings);
    if (!run->is_complete()) throw SearchEnded("the reference fails: " + run->failure);
    parts = static_cast<int>(std::ceil(kNextReference * parts));
  }
  reference_ = run;
  reference_error_ = finer.error;
}

RunSettings Search::settings_for(const Candidate& candidate) const {
  RunSettings settings = own();
  settings.beams = candidate.beams;
  settings.scheme = candidate.scheme;
  settings.step = trials_.times().interval / candidate.parts;
  settings.tolerance = tolerance_;
  return settings;
}

// Lengthens or shortens the step until the run just keeps the accuracy.
void Search::fit_error(RunSettings settings) {
  const double interval = trials_.times().interval;
  int good = std::numeric_limits<int>::max(), bad = 0, parts = static_cast<int>(std::lround(interval / settings.step));
  for (int i = 0; i < kTries && parts > bad && parts < good; ++i) {
    settings.step = interval / parts;
    const TrialRun* known = best();
    const TrialRun& run = trials_.run(settings, known ? kHopeless * known->seconds + 0.01 : most_seconds());
    if (run.is_given_up) return;
    const double off = run.is_complete() ? error(run) / most_error() : kSteepest;
    (off <= 1 ? good : bad) = parts;
    const double factor = std::sqrt(std::clamp(off, 1 / kSteepest, kSteepest));
    const int next = static_cast<int>(std::ceil(parts * factor));
    if (off <= 1 && next >= kCloseEnough * parts) return;
    parts = std::clamp(next, bad + 1, good - 1);
  }
}

// The same, until the run just keeps the speed.
void Search::fit_load(RunSettings settings) {
  const double interval = trials_.times().interval;
  int parts = static_cast<int>(std::lround(interval / settings.step));
  for (int i = 0; i < kTries; ++i) {
    settings.step = interval / parts;
    const TrialRun& run = trials_.run(settings, 2 * most_seconds());
    const int next = std::max(1, static_cast<int>(parts * most_seconds() / std::max(run.seconds, 1e-6)));
    if (!run.is_complete() || next == parts || (next > parts && kCloseEnough * next < parts)) return;
    parts = next;
  }
}

void Search::try_finalists(double accuracy) {
  const std::vector<Candidate> candidates =
      goal_.load ? pool_.most_accurate(most_seconds()) : pool_.cheapest(kShare * accuracy);
  for (std::size_t i = 0; i < std::min(candidates.size(), kFinalists); ++i) {
    progress_(0.75 + 0.1 * static_cast<double>(i) / kFinalists, "finalists");
    goal_.load ? fit_load(settings_for(candidates[i])) : fit_error(settings_for(candidates[i]));
  }
}

// Loosens Newton's tolerance as long as the best run gets better. The time that is saved allows smaller steps.
void Search::loosen_tolerance() {
  for (const double tolerance : kTolerances) {
    const TrialRun* before = best();
    if (!before || find_scheme(before->settings.scheme)->tableau) return;
    if (before->settings.tolerance >= tolerance) continue;
    progress_(0.87, "tolerances");
    RunSettings settings = before->settings;
    settings.tolerance = tolerance;
    goal_.load ? fit_load(settings) : fit_error(settings);
    if (best()->settings.tolerance < tolerance) return;
  }
}

// Times the best runs and the scene as it stands, in turns. Medians count.
void Search::time_finalists() {
  std::vector<const TrialRun*> good;
  for (const TrialRun& run : trials_.all())
    if (is_good(run)) good.push_back(&run);
  std::sort(good.begin(), good.end(), [&](const TrialRun* a, const TrialRun* b) { return is_better(*a, *b); });
  good.resize(std::min<std::size_t>(good.size(), kTimings));
  if (as_it_stands_ && as_it_stands_->is_complete() && std::count(good.begin(), good.end(), as_it_stands_) == 0)
    good.push_back(as_it_stands_);
  for (int i = 0; i < kTimings; ++i)
    for (const TrialRun* run : good) {
      progress_(0.9 + 0.1 * i / kTimings, "times");
      std::vector<double>& times = times_[run];
      times.push_back(i == 0 ? run->seconds : trials_.time_again(run->settings));
    }
}

void Search::run() {
  look_at_scene();
  double accuracy = goal_.accuracy.value_or(0);
  if (goal_.load)
    accuracy = measure_for_load();
  else
    measure(kShare * accuracy);
  make_reference(accuracy);
  try_finalists(accuracy);
  loosen_tolerance();
  time_finalists();
}

double Search::seconds_of(const TrialRun& run) const {
  const auto found = times_.find(&run);
  if (found == times_.end()) return run.seconds;
  std::vector<double> times = found->second;
  std::nth_element(times.begin(), times.begin() + static_cast<long>(times.size()) / 2, times.end());
  return times[times.size() / 2];
}

// The best result if no run meets the goal.
const TrialRun* Search::most_accurate() const {
  const TrialRun* found = nullptr;
  for (const TrialRun& run : trials_.all())
    if (run.is_complete() && &run != reference_ && (!found || error(run) < error(*found))) found = &run;
  return found;
}

// The substitute for a reference that was not made: the run with the most effort.
const TrialRun* Search::finest() const {
  const auto effort = [](const TrialRun& run) {
    return static_cast<double>(run.iterations) * mesh_cost(run.settings.beams);
  };
  const TrialRun* found = nullptr;
  for (const TrialRun& run : trials_.all())
    if (run.is_complete() && (!found || effort(run) > effort(*found))) found = &run;
  return found;
}

TuningResult Search::result(const std::string& ended) {
  TuningResult out;
  out.seconds = trials_.seconds();
  if (reference_) {
    out.reference = reference_->settings;
    out.reference_error = reference_error_;
  } else {
    reference_ = finest();
    if (reference_ && reference_->is_at_rest()) reference_ = nullptr;
  }
  const TrialRun* chosen = reference_ ? best() : nullptr;
  out.is_met = chosen != nullptr;
  if (reference_ && !chosen) chosen = most_accurate();
  if (out.is_met) shortcomings_.clear();  // those on the way do not matter
  if (!ended.empty()) shortcomings_.push_back(ended);
  if (reference_ && !out.reference)
    shortcomings_.emplace_back("there is no reference run: errors are relative to the finest run");
  for (const TrialRun& run : trials_.all()) {
    const double off = reference_ && run.is_complete() ? error(run) : 0;
    TunedRun row{run.settings,   seconds_of(run), times_.count(&run) > 0, run.steps,
                 run.iterations, run.unknowns,    run.energy_drift,       off,
                 run.failure};
    if (&run == chosen) out.best = out.runs.size();
    out.runs.push_back(std::move(row));
  }
  if (reference_) out.scale = reference_->length_of_errors();
  if (chosen) out.estimate = pool_.predicted_error(chosen->settings, trials_.times());
  out.shortcoming = fmt::format("{}", fmt::join(shortcomings_, "; "));
  return out;
}

}  // namespace

TuningResult tune(TrialRuns& trials, const TuningGoal& goal, const TuningFreedom& freedom,
                  const TuningProgress& progress) {
  require_constant_mesh(trials.scene(), "the search for the best settings");
  Search search(trials, goal, freedom, progress);
  try {
    search.run();
  } catch (const SearchEnded& ended) {
    return search.result(ended.what());
  }
  return search.result("");
}

std::vector<std::string> schemes_alike(const IntegratorDescription& integrator, bool any) {
  const Scheme own = make_scheme(integrator);
  std::vector<std::string> names = {integrator.scheme};
  const auto is_alike = [&](const Scheme& other) {
    const bool is_plain = !own.conserves_energy && !(own.name == "em0");
    if (is_plain) return false;  // the scene wants its dissipation, or wants to study it
    return other.conserves_momenta && (other.conserves_energy || !own.conserves_energy);
  };
  for (const char* name : {"em", "em0", "em4"}) {
    if (own.name == name || integrator.scheme == name) continue;
    if (any || is_alike(*find_scheme(name))) names.emplace_back(name);
  }
  if (any || (integrator.scheme == "auto" && own.conserves_energy))
    for (const Scheme& scheme : explicit_schemes())
      if (own.name != scheme.name) names.emplace_back(scheme.name);
  if (any)
    for (const char* name : {"edmc2", "newmark", "m1"})
      if (own.name != name) names.emplace_back(name);
  return names;
}

}  // namespace flexarm
