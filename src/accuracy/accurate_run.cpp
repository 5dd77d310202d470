#include "flexarm/accuracy/accurate_run.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/scheme_tries.h"
#include "flexarm/scene/scene_description.h"
#include "integrators/explicit_obstacle.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"
#include "simulation/refinement.h"

namespace flexarm {
namespace {

/// Schemes from which flexarm chooses if the scene leaves the choice to it: the default one, one of higher order, and
/// explicit ones, for what these can simulate.
constexpr const char* kDefault = "em";
constexpr const char* kHigherOrder = "em4";
/// Relative to an interval. If a corner is nearer than this to another end of a cell, no step has to end at it: the
/// step then uses the mean of what acts.
constexpr double kShortestCell = 1e-6;
/// Further tries that a scheme needs at least as long as its error is not known, as a multiple of the next one: that
/// one, and one with twice as many steps.
constexpr double kTriesToKnow = 3;

/// The schemes that a run may choose besides the simulation's own. None if the scene chooses its scheme.
std::vector<const Scheme*> other_schemes(const Simulation& simulation) {
  std::vector<const Scheme*> found;
  if (simulation.scene().integrator.scheme != "auto" || simulation.scheme() != kDefault) return found;
  if (explicit_errors_are_known(model_of(simulation)))
    for (const Scheme& scheme : explicit_schemes()) found.push_back(&scheme);
  found.push_back(meanings(kHigherOrder).front());
  return found;
}

/// The simulation with another scheme, in the same state. None if that scheme cannot simulate the scene.
std::optional<Simulation> with_other_scheme(const Simulation& simulation, std::string_view scheme) {
  scene::SceneDescription scene = simulation.scene();
  scene.integrator.scheme = scheme;
  scene.starts_in_equilibrium = false;                                  // it goes on from the simulation's state
  if (find_scheme(scheme)->tableau) scene.integrator.max_halvings = 0;  // a try with too long steps ends at once
  try {
    Simulation other(std::move(scene));
    other.take_over(simulation);
    return other;
  } catch (const ModelError&) {
    return std::nullopt;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// Tries of a scheme that the scene does not name. They are given up for good when they turn out badly.
class Rival {
 public:
  explicit Rival(const Scheme& scheme) : scheme_(scheme) {}

  /// Makes the tries, which begin at the state of `start`. Their first one is judged by the limit of `judge`. Returns
  /// false if the scheme cannot simulate the scene.
  bool make(const Simulation& start, const TryPlan& plan, const SchemeTries& judge) {
    if (tries_) return true;
    simulation_ = with_other_scheme(start, scheme_.name);
    is_bad_ = !simulation_;
    if (is_bad_) return false;
    tries_.emplace(*simulation_, plan);
    if (judge.judged() >= 2) tries_->judge_first_by(judge.limit());
    return true;
  }
  const Scheme& scheme() const { return scheme_; }
  bool is_bad() const { return is_bad_; }
  void give_up() { is_bad_ = true; }
  SchemeTries* tries() { return tries_ ? &*tries_ : nullptr; }
  const SchemeTries* tries() const { return tries_ ? &*tries_ : nullptr; }

 private:
  const Scheme& scheme_;
  std::optional<Simulation> simulation_;
  std::optional<SchemeTries> tries_;
  bool is_bad_ = false;
};

class TriesOfARun {
 public:
  TriesOfARun(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher)
      : plan_(plan_of(simulation, request, watcher)), own_(simulation, plan_) {
    for (const Scheme* scheme : other_schemes(simulation)) rivals_.emplace_back(*scheme);
  }

  AccurateRun run() {
    for (SchemeTries* tries = &choose(); may_try(tries->next_steps()); tries = &choose()) {
      const bool is_done = tries->attempt(run_);
      if (run_.end == AccurateRun::End::Interrupted) break;
      const bool is_over = is_done && tries->judge(run_);
      if (is_over && (run_.end == AccurateRun::End::Met || tries == &own_)) break;
      const bool goes_on = tries->go_on(!is_done);
      if (tries == &own_ ? !goes_on : !keep(rival_of(*tries), is_done, goes_on, is_over)) break;
    }
    for (Rival& rival : rivals_)
      if (rival.tries() && run_.scheme() == rival.scheme().name)
        own_.simulation().take_over(rival.tries()->simulation());
    return std::move(run_);
  }

 private:
  static TryPlan plan_of(const Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher) {
    TryPlan plan{request, watcher, JudgedPoints(simulation, request.frame), simulation.time(), {}};
    const auto require = [](bool ok, const char* what) {
      if (!ok) throw std::invalid_argument(what);
    };
    require(request.accuracy > 0 && request.accuracy < 1, "an accuracy must lie between 0 and 1");
    require(std::isfinite(request.until) && request.until > plan.begin, "the end must be later than the beginning");
    require(request.intervals >= 1, "at least one interval is needed");
    require(!request.scale || (*request.scale > 0 && std::isfinite(*request.scale)), "the scale of errors must be > 0");
    require(plan.points.size() > 0, "no probe or tip moves, so that no error can be measured");
    plan.cells = {plan.begin};
    const std::vector<double> corners = known_corners(simulation, plan.begin, request.until);
    auto corner = corners.begin();
    const double shortest = kShortestCell * plan.interval();
    for (int i = 1; i <= request.intervals; ++i) {
      const double end = plan.judged_time(i);
      for (; corner != corners.end() && *corner < end - shortest; ++corner)
        if (*corner > plan.cells.back() + shortest) plan.cells.push_back(*corner);
      plan.cells.push_back(end);
    }
    return plan;
  }

  bool may_try(double steps) {
    const bool has_tries = static_cast<int>(run_.tries.size()) < plan_.request.most_tries;
    const double most = std::min(plan_.request.most_steps, plan_.request.most_refinement * own_.fewest_steps());
    const bool has_steps = static_cast<double>(run_.steps) + steps <= most;
    if (!has_tries) run_.end = AccurateRun::End::OutOfTries;
    if (!has_steps) run_.end = AccurateRun::End::OutOfSteps;
    return has_tries && has_steps;
  }

  Rival& rival_of(const SchemeTries& tries) {
    return *std::find_if(rivals_.begin(), rivals_.end(), [&](const Rival& rival) { return rival.tries() == &tries; });
  }

  /// Gives up the rival if it has no good try to come. A failure of a composition has other reasons than too long
  /// steps. Returns false if no other scheme will do better, since only round-off is left.
  bool keep(Rival& rival, bool is_done, bool goes_on, bool is_over) {
    const bool is_explicit = rival.scheme().tableau != nullptr;
    if (!goes_on || is_over || (!is_done && !is_explicit)) rival.give_up();
    return !is_over || !is_explicit || !rival.tries()->is_small(rival.tries()->estimate());
  }

  /// The tries of the scheme that is expected to reach the accuracy with the least work.
  SchemeTries& choose() {
    Rival* best = nullptr;
    double least = expected_cost(own_);
    const auto consider = [&](Rival& rival, double cost) {
      if (!rival.is_bad() && cost < least) best = &rival, least = cost;
    };
    for (Rival& rival : rivals_) {
      if (rival.scheme().tableau) consider(rival, expected_cost_of_explicit(rival));
      if (!rival.scheme().tableau && own_.is_known()) consider(rival, expected_cost_of_composition(rival));
    }
    if (!best) return own_;
    return best->make(own_.at_start(), plan_, judge()) ? *best->tries() : choose();
  }

  /// As long as its error is not known, no scheme costs more than another one without a result.
  double expected_cost(const SchemeTries& tries) const {
    if (tries.is_known()) return tries.predicted_cost();
    return tries.spent() + kTriesToKnow * tries.next_steps() * tries.cost_per_step();
  }

  double expected_cost_of_explicit(const Rival& rival) const {
    if (rival.tries()) return expected_cost(*rival.tries());
    return first_tries() * own_.fewest_steps() * cost_of_iteration(rival.scheme());
  }

  /// The cost follows from the differences of the scheme's own tries, as soon as there are any. Before, one step per
  /// interval is assumed if the limit of another scheme can judge that try, and otherwise two tries, with one and with
  /// two steps.
  double expected_cost_of_composition(const Rival& rival) const {
    if (rival.tries() && rival.tries()->judged() >= 2) return rival.tries()->predicted_cost();
    if (rival.tries() && rival.tries()->judged() == 1) return 2 * rival.tries()->last_cost();
    return first_tries() * own_.fewest_steps() * kCompositionSteps * own_.iterations_per_step();
  }

  double first_tries() const { return judge().judged() >= 2 && judge().limit_may_judge() ? 1 : kTriesToKnow; }

  /// The tries whose limit is known best.
  const SchemeTries& judge() const {
    const SchemeTries* best = &own_;
    for (const Rival& rival : rivals_)
      if (rival.scheme().tableau && rival.tries() && rival.tries()->judged() >= 2 &&
          !(best->judged() >= 2 && best->estimate() <= rival.tries()->estimate()))
        best = rival.tries();
    return *best;
  }

  TryPlan plan_;
  SchemeTries own_;
  std::deque<Rival> rivals_;
  AccurateRun run_;
};

}  // namespace

AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher) {
  require_constant_mesh(simulation.scene(), "a run to an accuracy");
  const double step = simulation.step_size(), tolerance = simulation.tolerance(),
               constants = step_of_constants(simulation);
  AccurateRun run = TriesOfARun(simulation, request, watcher).run();
  set_step_of_constants(simulation, constants);
  simulation.set_step_size(step);
  simulation.set_tolerance(tolerance);
  return run;
}

const char* to_string(AccurateRun::End end) {
  switch (end) {
    case AccurateRun::End::Met:
      return "met";
    case AccurateRun::End::Interrupted:
      return "interrupted";
    case AccurateRun::End::Failed:
      return "a step has failed";
    case AccurateRun::End::NoConvergence:
      return "shorter steps do not reduce the error: round-off dominates, or the motion is chaotic";
    case AccurateRun::End::OutOfTries:
      return "the largest number of tries is reached";
    case AccurateRun::End::OutOfSteps:
      return "more steps are needed than a search may have";
  }
  return "";
}

std::string shortcoming(const AccurateRun& run, double accuracy, double more) {
  const double estimate = run.estimate() + more;
  const std::string reached = std::isnan(estimate) ? "unknown" : fmt::format("{:.2g}", estimate);
  std::string text = fmt::format("the accuracy {:g} was not met: {}; estimated error {} after {} tries, {} steps",
                                 accuracy, to_string(run.end), reached, run.tries.size(), run.steps);
  if (!run.tries.empty())
    text += fmt::format("; the last try had {} steps of {}", run.tries.back().steps, run.scheme());
  return text;
}

}  // namespace flexarm
