#include "accuracy/scheme_tries.h"

#include <algorithm>
#include <cmath>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Of what is asked for: the largest estimate that is good enough, for true errors were up to 1.35 times their
/// estimates, the inverse of this; and at what the next try aims, so that an error a little larger than foreseen is
/// small enough, too.
constexpr double kEnough = 0.74, kAim = 0.6;
/// The least by which steps are multiplied between tries: below it, a difference of runs says little.
constexpr double kLeastGrowth = 1.2;
/// An error is known the better, the smaller it is; from it, how many times as many steps the next try has at most.
double most_growth(double estimate) {
  return estimate > 0.1 ? 2 : estimate > 0.01 ? 4 : 8;
}
/// Differences of runs as large as this, of the way that points move, have no order: they move in another way.
constexpr double kSaturated = 0.3;
/// A difference of runs that is so many times the expected one was foreseen badly: less is made of it.
constexpr double kSurprise = 2;
/// Tries in turn that make an error no smaller, after which it is given up: small ones are round-off, large ones chaos,
/// or a motion that the first tries are far too coarse for.
constexpr double kRoundOffBelow = 1e-6;
constexpr int kMostStagnations = 4;
/// Tries in turn, each with more steps, in which a step fails or that are astray: it has another reason than its
/// length.
constexpr int kMostFailures = 8;
/// Newton's method leaves the square of its tolerance in every solve. Over the step's length that is an error of the
/// velocity, which goes on to the end: with signs of their own, all together this share of what is asked for. And
/// between which bounds a tolerance may be.
constexpr double kRemainderShare = 0.1, kLeastTolerance = 1e-13, kMostTolerance = 1e-3;
/// Points that move less, of the model's length, are at rest: what they do is round-off, or what a start leaves.
constexpr double kAtRest = 1e-6;
/// Events are found to a part of what is asked for of the whole time, which bounds what they do to the error.
constexpr double kEventShare = 1.0 / 8;
constexpr int kMostEventHalvings = 10;

/// A scheme of higher order than this shows what it has in its own tries: at first it is taken for one of this order.
constexpr double kCommonOrder = 2;

/// The largest distance of any point from where a motion has it at the end of an interval [m].
double distance(const std::vector<Vector3>& positions, const JudgedMotion& motion, int interval) {
  double largest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    largest = std::max(largest, (positions[i] - motion.points[i][interval]).norm());
  return largest;
}

/// Without its error, which is this share of its difference to `coarse`.
JudgedMotion extrapolated(JudgedMotion fine, const JudgedMotion& coarse, double share) {
  for (std::size_t p = 0; p < fine.points.size(); ++p)
    for (std::size_t i = 0; i < fine.points[p].size(); ++i)
      fine.points[p][i] += share * (fine.points[p][i] - coarse.points[p][i]);
  return fine;
}

}  // namespace

SchemeTries::SchemeTries(Simulation& simulation, const TryPlan& plan)
    : simulation_(simulation),
      plan_(plan),
      start_(simulation.snapshot()),
      order_(make_scheme(simulation.scene().integrator).order),
      solves_(make_scheme(simulation.scene().integrator).solves_per_step()),
      next_(plan.multiple),
      before_(plan.points.size()) {}

double SchemeTries::predicted_iterations() const {
  const double growth = std::pow(estimate_ / (kAim * plan_.request.accuracy), 1.0 / order_);
  return iterations_before_ * plan_.total(steps_before_) * std::max(growth, kLeastGrowth);
}

bool SchemeTries::limit_may_judge() const {
  const double ratio = static_cast<double>(steps_before_) / steps_earlier_;
  return std::pow(ratio * estimate_, 2) / 2 <= kEnough * plan_.request.accuracy / 2;
}

void SchemeTries::set_steps() {
  const double accuracy = plan_.request.accuracy;
  const double step = plan_.interval() / steps_;
  const double finest = kEventShare * accuracy * (plan_.request.until - plan_.begin);
  const int halvings = step > finest ? static_cast<int>(std::ceil(std::log2(step / finest))) : 0;
  simulation_.set_step_size(step, std::min(halvings, kMostEventHalvings));
  const double remainder = kRemainderShare * accuracy / std::pow(plan_.total(steps_) * solves_, 1.5);
  simulation_.set_tolerance(std::clamp(std::sqrt(remainder), kLeastTolerance, kMostTolerance));
}

bool SchemeTries::run_interval(AccurateRun& run) {
  for (int n = 0; n < steps_; ++n) {
    plan_.watcher.before_step(simulation_);
    run.last = simulation_.step();
    ++run.steps;
    iterations_per_step_ += run.last.iterations / plan_.total(steps_);
    recoveries_ += run.last.other_guesses + run.last.halvings;
    run.end = AccurateRun::End::Interrupted;
    if (!plan_.watcher.after_step(simulation_, run.last)) return false;
    run.end = AccurateRun::End::Failed;
    if (!run.last.converged) return false;
  }
  return true;
}

/// `difference`: between the last try and the one before, relative.
double SchemeTries::supposed_order(double difference) const {
  if (order_ <= kCommonOrder) return order_;
  if (std::isnan(difference_)) return kCommonOrder;
  const double seen =
      std::log(difference_ / difference) / std::log(static_cast<double>(steps_before_) / steps_earlier_);
  return std::clamp(seen, 1.0, static_cast<double>(order_));
}

/// The error of a try over its difference to the one before.
double SchemeTries::share(double order) const {
  return 1 / (std::pow(static_cast<double>(steps_) / steps_before_, order) - 1);
}

bool SchemeTries::attempt(AccurateRun& run) {
  simulation_.restore(start_);
  steps_ = static_cast<int>(next_);
  set_steps();
  iterations_per_step_ = 0;
  recoveries_ = 0;
  run.steps_per_interval = steps_;
  run.interval = plan_.interval();
  run.tries.push_back({simulation_.scheme(), static_cast<long>(plan_.total(steps_)), kUnknown});
  plan_.watcher.begin(simulation_, run.tries.back().steps, expected_);
  run.motion = JudgedMotion(plan_.points.size());
  for (int i = 0; i <= plan_.intervals; ++i) {
    if (i > 0 && !run_interval(run)) return false;
    const std::vector<Vector3> positions = plan_.points.positions(simulation_);
    run.motion.add(positions);
    const JudgedMotion* other = compared();
    plan_.watcher.after_interval(simulation_, other ? compared_share() * distance(positions, *other, i) : kUnknown);
  }
  return true;
}

bool SchemeTries::judge(AccurateRun& run) {
  run.scale = plan_.request.scale.value_or(
      std::max(run.motion.largest_displacement(), kAtRest * model_of(simulation_).length_scale));
  if (is_astray()) return false;
  const double last = estimate_;
  const bool is_compared = judged_++ > 0;
  if (is_compared) {
    const double difference = motion_error(run.motion, before_, run.scale);
    double share = this->share(supposed_order(difference));
    // Much more than the run before has in error itself: half of the order is assumed.
    if (kSurprise * last / (1 + share) < difference) share = 1 / (std::sqrt(1 + 1 / share) - 1);
    estimate_ = difference * share;
    if (difference > kSaturated) estimate_ = std::max(estimate_, difference);
    run.tries.back().estimate = estimate_;
    difference_ = difference;
    limit_ = extrapolated(run.motion, before_, this->share(order_));
  } else if (other_limit_) {
    run.tries.back().estimate = motion_error(run.motion, *other_limit_, run.scale);
  }
  before_ = run.motion;
  steps_earlier_ = steps_before_;
  steps_before_ = steps_;
  iterations_before_ = iterations_per_step_;
  if (run.estimate() <= kEnough * plan_.request.accuracy) {
    run.end = AccurateRun::End::Met;
    return true;
  }
  if (!is_compared) return false;
  // Tries that make nothing better, each with more steps: round-off, or a motion that amplifies it.
  stagnations_ = estimate_ > 0.5 * last ? stagnations_ + 1 : 0;
  if (stagnations_ < (last < kRoundOffBelow ? 1 : kMostStagnations)) return false;
  run.end = AccurateRun::End::NoConvergence;
  return true;
}

bool SchemeTries::go_on(bool failed) {
  const bool is_useless = failed || is_astray();
  failures_ = is_useless ? failures_ + 1 : 0;
  double growth = 2;
  if (!failed && is_useless)
    growth = kLeastGrowth;
  else if (!failed && !std::isnan(estimate_))
    growth = std::clamp(std::pow(estimate_ / (kAim * plan_.request.accuracy), 1.0 / order_), kLeastGrowth,
                        most_growth(estimate_));
  next_ = plan_.multiple * std::ceil(growth * steps_ / plan_.multiple);
  expected_ = estimate_ * std::pow(steps_before_ / next_, order_);
  return failures_ <= kMostFailures;
}

}  // namespace flexarm
