#include "accuracy/scheme_tries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexarm/scene/scene_description.h"
#include "schemes/explicit_tableau.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Shares of the requested accuracy. An estimate up to kEnough is good enough: true errors were up to 1.35 times their
/// estimates, and 0.74 is the inverse. The next try aims at kAim, so that it is still good enough if its error is a
/// little larger than expected.
constexpr double kEnough = 0.74, kAim = 0.6;
/// Smallest ratio of steps from a try to the next. Below it, the difference of the runs says little.
constexpr double kLeastGrowth = 1.2;
/// Largest ratio of steps from a try to the next. The smaller an error is, the better it is known.
double most_growth(double estimate) {
  return estimate > 0.1 ? 2 : estimate > 0.01 ? 4 : 8;
}
/// If runs differ by this part of the points' way or more, their difference has no order: the points move in different
/// ways.
constexpr double kSaturated = 0.3;
/// If a difference of runs is larger than expected by this factor, it was predicted badly, and a lower order is
/// assumed.
constexpr double kSurprise = 2;
/// The search ends after kMostStagnations successive tries that do not reduce the error, which means chaos, or a motion
/// for which the first tries are far too coarse. For errors below kRoundOffBelow one such try is enough, since they are
/// round-off.
constexpr double kRoundOffBelow = 1e-6;
/// The same for explicit schemes, which have no remainders of Newton's method.
constexpr double kExplicitRoundOffBelow = 1e-10;
constexpr int kMostStagnations = 6;
/// Round-off of positions, which tries share: no estimate of what moves is smaller.
constexpr double kLeastEstimate = std::numeric_limits<double>::epsilon();
/// If a node turns by more than this in a step, its rotation lags so much that the error need not fall, and steps of
/// different lengths may even agree, after both were halved [rad]. (docs/notes/beyond.md 1.4)
constexpr double kResolvedTurn = 1;
/// For this many tries after one that has not reduced the error, errors are not believed to fall with the order of the
/// scheme.
constexpr int kUnsettled = 2;
/// Most steps in a cell, far above what a run may have.
constexpr double kMostInCell = 1e9;
/// The search ends after this many successive tries, each with more steps, in which a step fails or which are astray:
/// the length of the steps is not the reason then.
constexpr int kMostFailures = 8;
/// Newton's method leaves a remainder of the square of its tolerance in every solve. Divided by the step, that is an
/// error of the velocity, which lasts to the end. Since their signs differ, all these errors together make this share
/// of the requested accuracy.
constexpr double kRemainderShare = 0.1;
/// An error is known once its estimate is below this.
constexpr double kKnown = 0.1;
/// Time of an evaluation of an explicit scheme over that of an iteration of Newton's method. (accuracy.md 3)
constexpr double kEvaluation = 0.15;
/// Iterations of a step of an implicit scheme, as long as no try has shown them.
constexpr double kIterations = 2.5;
/// Schemes of higher order are first assumed to have this order, until their own tries show more.
constexpr double kCommonOrder = 2;
/// The order that is assumed for estimates if bodies have touched each other. Errors of hits are of second order, but
/// with factors that vary from try to try. (docs/notes/accuracy.md 4)
constexpr double kOrderOfContacts = 1;

/// The largest distance of any point from its position in `motion` at the end of an interval [m].
double distance(const std::vector<Vector3>& positions, const JudgedMotion& motion, int interval) {
  double largest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    largest = std::max(largest, (positions[i] - motion.points[i][interval]).norm());
  return largest;
}

/// Richardson extrapolation: `fine` without its leading error, which is `share` times its difference from `coarse`.
JudgedMotion extrapolated(JudgedMotion fine, const JudgedMotion& coarse, double share) {
  for (std::size_t p = 0; p < fine.points.size(); ++p)
    for (std::size_t i = 0; i < fine.points[p].size(); ++i)
      fine.points[p][i] += share * (fine.points[p][i] - coarse.points[p][i]);
  return fine;
}

}  // namespace

double cost_of_iteration(const Scheme& scheme) {
  return scheme.tableau ? kEvaluation * static_cast<double>(scheme.tableau->weights.size()) : 1;
}

SchemeTries::SchemeTries(Simulation& simulation, const TryPlan& plan)
    : simulation_(simulation),
      plan_(plan),
      start_(simulation.snapshot()),
      scheme_(make_scheme(simulation.scene().integrator)),
      stepping_(simulation, plan.cells),
      before_(plan.points.size()),
      earlier_(plan.points.size()) {}

double SchemeTries::predicted_cost() const {
  const double growth = std::pow(estimate_ / (kAim * plan_.request.accuracy), 1.0 / scheme_.order);
  return last_cost() * std::max(growth, kLeastGrowth);
}

double SchemeTries::cost_per_step() const {
  const double first = scheme_.tableau ? 1 : kIterations * scheme_.solves_per_step();
  return cost_of_iteration(scheme_) * (std::isnan(iterations_before_) ? first : iterations_per_step());
}

bool SchemeTries::is_small(double estimate) const {
  return estimate < (scheme_.tableau ? kExplicitRoundOffBelow : kRoundOffBelow);
}

bool SchemeTries::is_known() const {
  return judged_ >= 2 && estimate_ < kKnown;
}

bool SchemeTries::limit_may_judge() const {
  const double ratio = planned_before_ / planned_earlier_;
  return std::pow(ratio * estimate_, 2) / 2 <= kEnough * plan_.request.accuracy / 2;
}

void SchemeTries::set_steps() {
  planned_ = stepping_.planned(steps_);
  const double remainder =
      kRemainderShare * plan_.request.accuracy / std::pow(planned_ * scheme_.solves_per_step(), 1.5);
  stepping_.set(steps_, std::sqrt(remainder));
}

/// The order that is assumed for an estimate. `difference`: between the last try and the one before, relative.
double SchemeTries::supposed_order(double difference) const {
  if (stepping_.had_contacts) return kOrderOfContacts;
  if (scheme_.order <= kCommonOrder) return scheme_.order;
  if (std::isnan(difference_) || difference == 0 || difference_ == 0) return kCommonOrder;
  const double seen = std::log(difference_ / difference) / std::log(planned_before_ / planned_earlier_);
  return std::clamp(seen, 1.0, static_cast<double>(scheme_.order));
}

/// The error of the last try over its difference from a try with `planned` steps.
double SchemeTries::share(double order, double planned) const {
  return 1 / (std::pow(planned_ / planned, order) - 1);
}

bool SchemeTries::attempt(AccurateRun& run) {
  stepping_.go_back(start_);
  steps_ = next_;
  set_steps();
  run.steps_per_interval = steps_;
  run.interval = plan_.interval();
  run.tries.push_back({simulation_.scheme(), std::lround(planned_), kUnknown});
  plan_.watcher.begin(simulation_, run.tries.back().steps, expected_);
  run.motion = JudgedMotion(plan_.points.size());
  const long steps = run.steps;
  for (int i = 0; i <= plan_.request.intervals; ++i) {
    const bool is_there = i == 0 || stepping_.advance_to(plan_.judged_time(i), plan_.watcher, run);
    if (!is_there || i == plan_.request.intervals)
      spent_ += static_cast<double>(stepping_.iterations) * cost_of_iteration(scheme_);
    if (!is_there) return false;
    const std::vector<Vector3> positions = plan_.points.positions(simulation_);
    run.motion.add(positions);
    const JudgedMotion* other = compared();
    plan_.watcher.after_interval(simulation_, other ? compared_share() * distance(positions, *other, i) : kUnknown);
  }
  run.tries.back().steps = run.steps - steps;
  return true;
}

/// Estimates the error by the differences from the last two tries, and returns the larger estimate. A try may agree by
/// chance with one that has other steps, but hardly with two of them.
double SchemeTries::estimate_of(const JudgedMotion& motion, double scale) {
  const double difference = motion_error(motion, before_, scale);
  const double order = supposed_order(difference);
  double share = this->share(order, planned_before_);
  // The difference is much larger than the expected error of the run before: assume half of the order.
  if (kSurprise * estimate_ / (1 + share) < difference) share = 1 / (std::sqrt(1 + 1 / share) - 1);
  double estimate = difference * share;
  // The points move in different ways, or the last tries have not converged.
  if (difference > kSaturated || unsettled_ > 0) estimate = std::max(estimate, difference);
  if (judged_ > 2)
    estimate = std::max(estimate, motion_error(motion, earlier_, scale) * this->share(order, planned_earlier_));
  difference_ = difference;
  return difference > 0 ? std::max(estimate, kLeastEstimate) : estimate;
}

bool SchemeTries::judge(AccurateRun& run) {
  run.scale = plan_.request.scale.value_or(length_of_errors(run.motion, model_of(simulation_).length_scale));
  if (is_astray()) return false;
  const double last = estimate_;
  const bool is_compared = judged_++ > 0;
  if (is_compared) {
    run.tries.back().estimate = estimate_ = estimate_of(run.motion, run.scale);
    limit_ = extrapolated(run.motion, before_, share(scheme_.order, planned_before_));
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
  // Further tries with more steps that are not better mean round-off, or a motion that amplifies it.
  const bool is_better = !(estimate_ > 0.5 * last), is_resolved = stepping_.turn <= kResolvedTurn;
  stagnations_ = is_better || !is_resolved ? 0 : stagnations_ + 1;
  unsettled_ = is_better ? std::max(unsettled_ - 1, 0) : kUnsettled;
  const bool may_be_round_off = is_small(last) && is_small(estimate_) && was_resolved_;
  was_resolved_ = is_resolved;
  if (stagnations_ < (may_be_round_off ? 1 : kMostStagnations)) return false;
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
    growth = std::clamp(std::pow(estimate_ / (kAim * plan_.request.accuracy), 1.0 / scheme_.order), kLeastGrowth,
                        most_growth(estimate_));
  next_ = static_cast<int>(std::min(std::ceil(growth * steps_), kMostInCell));
  // Two tries with nested steps may be wrong in the same places.
  if (steps_ > 1 && next_ % steps_ == 0) ++next_;
  expected_ = estimate_ * std::pow(planned_before_ / stepping_.planned(next_), scheme_.order);
  return failures_ <= kMostFailures;
}

}  // namespace flexarm
