#include "accuracy/scheme_tries.h"

#include <algorithm>
#include <cmath>

#include "flexarm/scene/scene_description.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Shares of the requested accuracy. An estimate up to the first one is good enough, since true errors were up to 1.35
/// times their estimates, its inverse. The next try aims at the second one, so that an error a little larger than
/// expected is still small enough.
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
constexpr int kMostStagnations = 6;
/// Tries behind one that has made an error no smaller, of which none is believed to fall by the order of the scheme.
constexpr int kUnsettled = 2;
/// Steps in a cell at most: far above what a run may have.
constexpr double kMostInCell = 1e9;
/// Tries in turn, each with more steps, in which a step fails or that are astray: it has another reason than its
/// length.
constexpr int kMostFailures = 8;
/// Newton's method leaves the square of its tolerance in every solve. Over the step's length that is an error of the
/// velocity, which goes on to the end: with signs of their own, all together this share of what is asked for.
constexpr double kRemainderShare = 0.1;
/// Points that move less, of the model's length, are at rest: what they do is round-off, or what a start leaves.
constexpr double kAtRest = 1e-6;
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
      stepping_(simulation, plan.cells),
      before_(plan.points.size()),
      earlier_(plan.points.size()) {}

double SchemeTries::predicted_iterations() const {
  const double growth = std::pow(estimate_ / (kAim * plan_.request.accuracy), 1.0 / order_);
  return iterations_before_ * std::max(growth, kLeastGrowth);
}

bool SchemeTries::limit_may_judge() const {
  const double ratio = planned_before_ / planned_earlier_;
  return std::pow(ratio * estimate_, 2) / 2 <= kEnough * plan_.request.accuracy / 2;
}

void SchemeTries::set_steps() {
  planned_ = stepping_.planned(steps_);
  const double remainder = kRemainderShare * plan_.request.accuracy / std::pow(planned_ * solves_, 1.5);
  stepping_.set(steps_, std::sqrt(remainder));
}

/// `difference`: between the last try and the one before, relative.
double SchemeTries::supposed_order(double difference) const {
  if (order_ <= kCommonOrder) return order_;
  if (std::isnan(difference_)) return kCommonOrder;
  const double seen = std::log(difference_ / difference) / std::log(planned_before_ / planned_earlier_);
  return std::clamp(seen, 1.0, static_cast<double>(order_));
}

/// The error of a try over its difference to one with so many steps.
double SchemeTries::share(double order, double planned) const {
  return 1 / (std::pow(planned_ / planned, order) - 1);
}

bool SchemeTries::attempt(AccurateRun& run) {
  simulation_.restore(start_);
  steps_ = next_;
  set_steps();
  run.steps_per_interval = steps_;
  run.interval = plan_.interval();
  run.tries.push_back({simulation_.scheme(), std::lround(planned_), kUnknown});
  plan_.watcher.begin(simulation_, run.tries.back().steps, expected_);
  run.motion = JudgedMotion(plan_.points.size());
  const long steps = run.steps;
  for (int i = 0; i <= plan_.request.intervals; ++i) {
    if (i > 0 && !stepping_.advance_to(plan_.judged_time(i), plan_.watcher, run)) return false;
    const std::vector<Vector3> positions = plan_.points.positions(simulation_);
    run.motion.add(positions);
    const JudgedMotion* other = compared();
    plan_.watcher.after_interval(simulation_, other ? compared_share() * distance(positions, *other, i) : kUnknown);
  }
  run.tries.back().steps = run.steps - steps;
  return true;
}

/// Estimates the error by the differences to the last two tries; the larger estimate counts. It is rare that a try
/// agrees by chance with one that has other steps, and rarer with two.
double SchemeTries::estimate_of(const JudgedMotion& motion, double scale) {
  const double difference = motion_error(motion, before_, scale);
  const double order = supposed_order(difference);
  double share = this->share(order, planned_before_);
  // Much more than the run before has in error itself: half of the order is assumed.
  if (kSurprise * estimate_ / (1 + share) < difference) share = 1 / (std::sqrt(1 + 1 / share) - 1);
  double estimate = difference * share;
  // In another way, or where the tries before have not fallen by any order.
  if (difference > kSaturated || unsettled_ > 0) estimate = std::max(estimate, difference);
  if (judged_ > 2)
    estimate = std::max(estimate, motion_error(motion, earlier_, scale) * this->share(order, planned_earlier_));
  difference_ = difference;
  return estimate;
}

bool SchemeTries::judge(AccurateRun& run) {
  run.scale = plan_.request.scale.value_or(
      std::max(run.motion.largest_displacement(), kAtRest * model_of(simulation_).length_scale));
  if (is_astray()) return false;
  const double last = estimate_;
  const bool is_compared = judged_++ > 0;
  if (is_compared) {
    run.tries.back().estimate = estimate_ = estimate_of(run.motion, run.scale);
    limit_ = extrapolated(run.motion, before_, share(order_, planned_before_));
  } else if (other_limit_) {
    run.tries.back().estimate = motion_error(run.motion, *other_limit_, run.scale);
  }
  earlier_ = std::move(before_);
  before_ = run.motion;
  planned_earlier_ = planned_before_;
  planned_before_ = planned_;
  iterations_before_ = static_cast<double>(stepping_.iterations);
  if (run.estimate() <= kEnough * plan_.request.accuracy && is_confirmed()) {
    run.end = AccurateRun::End::Met;
    return true;
  }
  if (!is_compared) return false;
  // Tries that make nothing better, each with more steps: round-off, or a motion that amplifies it.
  const bool is_better = !(estimate_ > 0.5 * last);
  stagnations_ = is_better ? 0 : stagnations_ + 1;
  unsettled_ = is_better ? std::max(unsettled_ - 1, 0) : kUnsettled;
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
  next_ = static_cast<int>(std::min(std::ceil(growth * steps_), kMostInCell));
  // Steps that are nested in those of the try before may be wrong in the same places.
  if (steps_ > 1 && next_ % steps_ == 0) ++next_;
  expected_ = estimate_ * std::pow(planned_before_ / stepping_.planned(next_), order_);
  return failures_ <= kMostFailures;
}

}  // namespace flexarm
