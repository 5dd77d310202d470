#include "integrators/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// Larger updates of a rotation are scaled down where limits are asked for [rad]: the residual's directions have turned
/// by as much, and the linear model says nothing any more.
constexpr double kLargestRotationUpdate = 1.0;
/// The iteration is given up when an update is this much larger than the first one, ...
constexpr double kDivergence = 1e4;
/// ... or than so much, since a good guess makes the first one tiny [- or rad].
constexpr double kSmallestFirstUpdate = 1e-3;
/// From so many iterations on an update is damped by half as much again as the last one, down to the strongest damping,
/// where this one had left more than this share of its own: full updates jump to and fro between two sides of a steep
/// law, parts of them fall between. Damping is taken back step by step when it has done well so often in a row.
/// Measured: docs/notes/newton.md 6.
constexpr int kPatience = 5;
constexpr double kStalled = 0.5;
constexpr double kStrongestDamping = 0.125;
constexpr int kDoneWell = 2;
/// Growth of updates by kept factors with which a solve begins anew: it happens where these are of another branch.
constexpr double kAstray = 10;
/// An update by kept factors is useless where it is more than this of the one before. Behind one by new factors it is
/// left out; behind another one with which the solve began it begins anew: hardly anything is lost, and what bad
/// updates have strained in a stiff system would take more iterations.
constexpr double kUseless = 0.5;
/// Updates that no longer shrink below this are the round-off of a stiff system: its condition, up to 1e4 in the test
/// scenes of stiff bodies, times that of a double.
constexpr double kStagnation = 1e-12;
/// Solves that may end after one update, because an earlier one has shown what it leaves, until one more shows it anew.
constexpr int kTrust = 8;
/// By how much the next solve may do worse than the one that was watched.
constexpr double kCaution = 3;
/// Solves that trust in what an earlier one has shown of kept factors.
constexpr int kTrustInContraction = 32;
/// Of what kept factors left in an earlier solve so much is expected: it had less than that where it came to round-off.
constexpr double kExpectedShare = 0.1;
/// Scaled updates cannot be expected to become smaller than this.
constexpr double kRoundOff = 1e-15;

}  // namespace

NewtonIteration::NewtonIteration(StepSystem& system, const StepSettings& settings)
    : system_(system),
      settings_(settings),
      factor_reuse_(system.tangent().cost_of_factors()),
      update_(system.degrees_of_freedom().unknowns) {
  norms_.reserve(settings.max_iterations + 1);
}

void NewtonIteration::forget_factors() {
  factorised_step_ = 0;
  factor_reuse_.reset();
  starts_ = {};
  kept_contractions_ = {};
}

bool NewtonIteration::solve(Updates updates, Factors factors, StepResult& result) {
  const int iterations = result.iterations, factorisations = result.factorisations;
  const Reason reason = iterate(updates, factors, result);
  enter(StepPhase::Control);
  if (settings_.reuse_factorisation)
    factor_reuse_.end(result.iterations - iterations, result.factorisations - factorisations, reason == Reason::None);
  if (reason == Reason::None) return true;
  result.reason = reason;
  factorised_step_ = 0;
  return false;
}

StepResult::Reason NewtonIteration::evaluate(bool with_tangent) {
  enter(with_tangent ? StepPhase::Tangent : StepPhase::Residual);
  if (system_.evaluate(with_tangent)) return Reason::None;
  const StepConfiguration& configuration = system_.configuration();
  if (!configuration.is_off_line()) return Reason::NotFinite;
  return configuration.is_driven_off_line() ? Reason::DrivenOffTheLine : Reason::OffTheLine;
}

StepResult::Reason NewtonIteration::find_update(Updates updates, Progress& progress) {
  enter(progress.with_kept ? StepPhase::Solve : StepPhase::Factorise);
  update_ = -system_.residual();
  if (system_.touches()) progress.residual = update_.norm();
  TangentBackend& tangent = system_.tangent();
  if (!(progress.with_kept ? tangent.solve(update_) : tangent.factorise_and_solve(update_)))
    return Reason::SingularTangent;
  enter(StepPhase::Update);
  const double rotation = system_.scales().largest_rotation(update_);
  progress.fraction = 1;
  if (updates == Updates::Limited && rotation > kLargestRotationUpdate)
    progress.fraction = kLargestRotationUpdate / rotation;
  update_ *= progress.fraction;
  progress.norm = system_.scales().norm(update_, system_.configuration().step());
  if (!std::isfinite(progress.norm)) return Reason::NotFinite;
  progress.contraction =
      progress.since_revision == 0 ? 1.0 : progress.norm / std::max(norms_.back(), std::numeric_limits<double>::min());
  norms_.push_back(progress.norm);
  learn(progress);
  return Reason::None;
}

bool NewtonIteration::diverges(const Progress& progress) const {
  return progress.norm > kDivergence * std::max(norms_.front(), kSmallestFirstUpdate);
}

/// Kept factors that make updates grow so lead astray; the solve begins anew. Round-off may grow as it likes.
bool NewtonIteration::is_led_astray(const Progress& progress) const {
  return progress.kept_before && kept_leave_more_than(progress.iteration == 1 ? kUseless : kAstray, progress);
}

bool NewtonIteration::is_useless(const Progress& progress) const {
  return !progress.kept_before && kept_leave_more_than(kUseless, progress);
}

bool NewtonIteration::kept_leave_more_than(double share, const Progress& progress) const {
  return progress.with_kept && progress.since_revision > 0 && progress.contraction > share &&
         progress.norm > kStagnation;
}

/// A steep law (friction near sticking, the touch of a stop) makes full updates jump to and fro; statics has none.
void NewtonIteration::damp(Progress& progress) {
  if (system_.configuration().step() == 0) return;
  // What an update has left out is there again in the next one.
  const double limit = 1 - progress.damping + progress.damping * kStalled;
  if (progress.since_revision >= kPatience && progress.contraction > limit) {
    progress.damping = std::max(0.5 * progress.damping, kStrongestDamping);
    progress.done_well = 0;
  } else if (progress.damping < 1 && ++progress.done_well == kDoneWell) {
    progress.damping *= 2;
    progress.done_well = 0;
  }
  update_ *= progress.damping;
  progress.fraction *= progress.damping;
}

/// The second update of a solve is what the first one left. Without factors that are kept nothing is learned, either:
/// then a step follows from the state alone, and a restored one continues bit for bit.
void NewtonIteration::learn(Progress& progress) {
  if (progress.iteration == 0) progress.first_residual = system_.residual().norm();
  if (!settings_.reuse_factorisation) return;
  if (progress.iteration == 0) {
    ++starts_[progress.with_kept].age;
  } else if (progress.iteration == 1) {
    const double ratio = progress.first_residual > 0 ? system_.residual().norm() / progress.first_residual : 0.0;
    starts_[progress.started_with_kept] = {norms_.front(), progress.contraction, ratio, 0, progress.since_revision > 0};
  }
  KeptContraction& kept = kept_contractions_[progress.started_with_kept];
  if (progress.iteration == 0) {
    ++kept.age;
  } else if (progress.iteration == 2 && progress.with_kept && progress.kept_before && progress.since_revision > 1) {
    kept = {std::min(progress.contraction, 1.0), 0, true};
  }
}

/// By how much kept factors contract shows in the ratio of updates. Not in that of the first one they make behind new
/// ones, which is what these have left, nor in round-off.
bool NewtonIteration::renews_factors(const Progress& progress) const {
  UpdateOutlook update;
  update.norm = progress.norm;
  update.is_by_new = !progress.with_kept;
  update.target = target();
  const bool is_first = progress.since_revision == 0 || !progress.kept_before;
  if (progress.with_kept && !is_first && progress.norm > kStagnation) update.contraction = progress.contraction;
  return factor_reuse_.renew(progress.iteration + 1, update);
}

/// After an evaluation at what an update has led to. The residual tells what no earlier solve could know: that a stop
/// is touched, say; and what no updates could: that a point has come into contact by the last one.
bool NewtonIteration::is_as_expected(const Progress& progress) const {
  if (progress.iteration > 0)
    return progress.residual == 0 || progress.norm <= kStagnation ||
           system_.residual().norm() <= std::max(kStalled * progress.residual, kStagnation * progress.first_residual);
  const FirstUpdate& start = starts_[progress.with_kept];
  const double growth = std::max(1.0, progress.norm / start.norm);
  const double expected = std::max(kCaution * growth * start.residual_ratio, kRoundOff) * progress.first_residual;
  return system_.residual().norm() <= expected;
}

/// Norm of what an update leaves: what it left out, at least.
double NewtonIteration::remainder_after(const Progress& progress) const {
  return progress.norm * std::max(contraction_after(progress), 1 - progress.fraction);
}

/// Of a whole update, by the last two or by what an earlier solve has shown.
double NewtonIteration::contraction_after(const Progress& progress) const {
  if (progress.iteration == 0) {
    const FirstUpdate& start = starts_[progress.with_kept];
    if (!start.is_known || start.age > kTrust) return 1.0;
    const double growth = std::max(1.0, progress.norm / start.norm);  // new factors: of the contraction, too
    return std::min(1.0, kCaution * growth * start.contraction);
  }
  const double shown = std::min(progress.contraction, 1.0);
  if (progress.with_kept && progress.iteration == 1) {
    // The first update takes away the error of the guess, which is smooth, best of all: kept factors are slower from
    // there.
    const KeptContraction& kept = kept_contractions_[progress.started_with_kept];
    const bool is_known = kept.is_known && kept.age <= kTrustInContraction;
    return is_known ? std::max(shown, kExpectedShare * kept.contraction) : 1.0;
  }
  // New factors square the error, kept ones contract it. Symmetric middle functions are not in the tangent: they leave
  // linear convergence with new factors, too.
  const bool squares = !progress.with_kept && system_.configuration().scheme().mid_functions == MidFunctions::Explicit;
  return squares ? shown * shown : shown;
}

/// What a solve leaves is an error of the velocity, over the length of the step: sub-steps leave as much less.
double NewtonIteration::target() const {
  const double step = std::abs(system_.configuration().step());
  const double part = step > 0 ? std::min(step / settings_.step, 1.0) : 1.0;
  return std::max(part * settings_.tolerance * settings_.tolerance, kRoundOff);
}

/// Where factors may be kept, convergence is to round-off, also when a solve has begun anew without them.
bool NewtonIteration::has_converged(const Progress& progress, Factors factors) const {
  const bool may_have_begun_anew = settings_.reuse_factorisation && system_.configuration().step() != 0 &&
                                   progress.iteration + 1 < settings_.max_iterations;
  if (factors == Factors::Fresh && !may_have_begun_anew) return progress.norm <= settings_.tolerance;
  const bool stagnates = progress.norm <= kStagnation && progress.contraction > kStalled && progress.since_revision > 1;
  return stagnates || remainder_after(progress) <= target();
}

}  // namespace flexarm
