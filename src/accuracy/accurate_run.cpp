#include "flexarm/accuracy/accurate_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy/scheme_tries.h"
#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Schemes from which flexarm chooses if the scene leaves the choice to it: the default one, and one of higher order.
constexpr const char* kDefault = "em";
constexpr const char* kHigherOrder = "em4";
/// The scheme of higher order is considered once the error of the default scheme is known: if its estimate is below
/// this.
constexpr double kKnown = 0.1;
/// Relative to an interval. If a corner is nearer than this to another end of a cell, no step has to end at it: the
/// step then uses the mean of what acts.
constexpr double kShortestCell = 1e-6;

/// The simulation with the scheme of higher order, in the same state. None if the scene chooses its scheme, or if the
/// other scheme cannot simulate the scene.
std::optional<Simulation> of_higher_order(const Simulation& simulation) {
  if (simulation.scene().integrator.scheme != "auto" || simulation.scheme() != kDefault) return std::nullopt;
  scene::SceneDescription scene = simulation.scene();
  scene.integrator.scheme = kHigherOrder;
  scene.starts_in_equilibrium = false;  // it goes on from the simulation's state
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

class TriesOfARun {
 public:
  TriesOfARun(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher)
      : plan_(plan_of(simulation, request, watcher)), own_(simulation, plan_) {}

  AccurateRun run() {
    for (SchemeTries* tries = &own_; may_try(tries->next_steps()); tries = &choose()) {
      const bool is_done = tries->attempt(run_);
      if (run_.end == AccurateRun::End::Interrupted) break;
      if (is_done && tries->judge(run_) && (run_.end == AccurateRun::End::Met || tries == &own_)) break;
      const bool goes_on = tries->go_on(!is_done);
      if (tries != &own_)
        is_other_bad_ = !is_done || !goes_on || run_.end == AccurateRun::End::NoConvergence;
      else if (!goes_on)
        break;
    }
    if (other_ && run_.scheme() == kHigherOrder) own_.simulation().take_over(*simulation_of_other_);
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
    const bool has_steps = static_cast<double>(run_.steps) + steps <= plan_.request.most_steps;
    if (!has_tries) run_.end = AccurateRun::End::OutOfTries;
    if (!has_steps) run_.end = AccurateRun::End::OutOfSteps;
    return has_tries && has_steps;
  }

  /// The tries of the scheme that is expected to reach the accuracy with less work.
  SchemeTries& choose() {
    if (is_other_bad_ || !(own_.estimate() < kKnown)) return own_;
    const double own = own_.predicted_iterations();
    return own > iterations_of_other() && make_other() ? *other_ : own_;
  }

  /// Iterations that the other scheme is expected to need. They follow from the differences of its own tries, as soon
  /// as there are any. Before, one step per interval is assumed if the limit of the simulation's scheme can judge that
  /// try, and otherwise two tries, with one and with two steps.
  double iterations_of_other() const {
    if (other_ && other_->judged() >= 2) return other_->predicted_iterations();
    if (other_ && other_->judged() == 1) return 2 * other_->iterations();
    return (own_.limit_may_judge() ? 1 : 3) * own_.fewest_steps() * kCompositionSteps * own_.iterations_per_step();
  }

  bool make_other() {
    if (other_) return true;
    simulation_of_other_ = of_higher_order(own_.at_start());
    is_other_bad_ = !simulation_of_other_;
    if (simulation_of_other_) {
      other_.emplace(*simulation_of_other_, plan_);
      other_->judge_first_by(own_.limit());
    }
    return !is_other_bad_;
  }

  TryPlan plan_;
  SchemeTries own_;
  std::optional<Simulation> simulation_of_other_;
  std::optional<SchemeTries> other_;
  bool is_other_bad_ = false;
  AccurateRun run_;
};

}  // namespace

AccurateRun run_to_accuracy(Simulation& simulation, const AccuracyRequest& request, RunWatcher& watcher) {
  const double step = simulation.step_size(), tolerance = simulation.tolerance();
  AccurateRun run = TriesOfARun(simulation, request, watcher).run();
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
      return "the largest number of steps is reached";
  }
  return "";
}

std::string shortcoming(const AccurateRun& run, double accuracy, double more) {
  const double estimate = run.estimate() + more;
  const std::string reached = std::isnan(estimate) ? "unknown" : fmt::format("{:.2g}", estimate);
  return fmt::format("the accuracy {:g} was not met: {}; estimated error {} after {} tries, {} steps", accuracy,
                     to_string(run.end), reached, run.tries.size(), run.steps);
}

}  // namespace flexarm
