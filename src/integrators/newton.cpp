#include "integrators/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// With Updates::Limited, an update that rotates more than this is scaled down to this angle [rad]. Beyond it, the
/// directions of the residual have turned so far that the linear model is useless.
constexpr double kLargestRotationUpdate = 1.0;
/// The iteration is aborted when an update is larger than the first one by this factor.
constexpr double kDivergence = 1e4;
/// In this comparison the first update counts as at least this, since a good guess makes it tiny [- or rad].
constexpr double kSmallestFirstUpdate = 1e-3;
/// On a steep law, full updates jump back and forth between two sides of it; smaller updates land between. So after
/// kPatience iterations, if an update left more than the share kStalled of itself, the next one is damped by half as
/// much again, down to kStrongestDamping. After kDoneWell good updates in a row the damping is reduced. Measured:
/// docs/notes/newton.md 6.
constexpr int kPatience = 5;
constexpr double kStalled = 0.5;
constexpr double kStrongestDamping = 0.125;
constexpr int kDoneWell = 2;
/// If updates by kept factors grow by this factor, the solve starts again with new factors: the kept ones belong to
/// another branch.
constexpr double kAstray = 10;
/// An update by kept factors is useless if it is larger than this share of the update before. If the update before used
/// new factors, the useless one is not applied. If the solve began with kept factors, it starts again with new ones.
/// Little is lost by that, and in a stiff system the strains of bad updates would take more iterations to remove.
constexpr double kUseless = 0.5;
/// Updates below this that no longer shrink are round-off of a stiff system: its condition number, up to 1e4 in the
/// test scenes of stiff bodies, times the round-off of a double.
constexpr double kStagnation = 1e-12;
/// When an earlier solve has shown how much its first update leaves, this many solves may end after one update. Then
/// one solve makes a second update and measures again.
constexpr int kTrust = 8;
/// Safety factor: the next solve may be worse than the observed one by this factor.
constexpr double kCaution = 3;
/// This many solves rely on the contraction by kept factors that an earlier solve has shown.
constexpr int kTrustInContraction = 32;
/// Lower bound of the expected contraction by kept factors. An earlier solve that reached round-off shows too small a
/// contraction.
constexpr double kExpectedShare = 0.1;
/// Scaled updates cannot be expected to become smaller than this.
constexpr double kRoundOff = 1e-15;

bool has_falling_friction(const Model& model) {
  return std::any_of(model.coordinates.begin(), model.coordinates.end(), [](const Coordinate& coordinate) {
    return coordinate.static_ratio != 1 && (coordinate.friction > 0 || coordinate.friction_coefficient > 0);
  });
}

}  // namespace

NewtonIteration::NewtonIteration(StepSystem& system, const StepSettings& settings)
    : system_(system),
      settings_(settings),
      factor_reuse_(system.tangent().cost_of_factors()),
      has_falling_friction_(has_falling_friction(system.configuration().model())),
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

/// Whether updates by kept factors grow so much that the solve has to start again. Growth of round-off does not count.
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

/// Damps the update on steep laws (friction near sticking, first touch of a stop). Statics has no such laws.
void NewtonIteration::damp(Progress& progress) {
  if (system_.configuration().step() == 0) return;
  // The part of an update that damping has left out appears again in the next update.
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

/// Learns from the second update of a solve, which shows the error that the first one left. Nothing is learned if
/// factors are never kept: a step then depends on the state alone, so that a restored run continues bit for bit.
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

/// The ratio of two updates shows how fast kept factors converge. Two ratios do not show it: that of updates of the
/// size of round-off, and that of the first update with kept factors to the update before, which had new factors.
bool NewtonIteration::renews_factors(const Progress& progress) const {
  UpdateOutlook update;
  update.norm = progress.norm;
  update.is_by_new = !progress.with_kept;
  update.target = target();
  const bool is_first = progress.since_revision == 0 || !progress.kept_before;
  if (progress.with_kept && !is_first && progress.norm > kStagnation) update.contraction = progress.contraction;
  return factor_reuse_.renew(progress.iteration + 1, update);
}

/// Whether the residual after an update is as small as expected. Called after the evaluation that follows an update.
/// Only the residual shows that the last update brought a point into contact, or that a stop was touched, which
/// earlier solves could not know.
bool NewtonIteration::is_as_expected(const Progress& progress) const {
  if (progress.iteration > 0)
    return progress.residual == 0 || progress.norm <= kStagnation ||
           system_.residual().norm() <= std::max(kStalled * progress.residual, kStagnation * progress.first_residual);
  const FirstUpdate& start = starts_[progress.with_kept];
  const double growth = std::max(1.0, progress.norm / start.norm);
  const double expected = std::max(kCaution * growth * start.residual_ratio, kRoundOff) * progress.first_residual;
  return system_.residual().norm() <= expected;
}

/// Norm of the error that an update leaves; at least the part of the update that was not applied.
double NewtonIteration::remainder_after(const Progress& progress) const {
  return progress.norm * std::max(contraction_after(progress), 1 - progress.fraction);
}

/// Contraction of a full update, from the last two updates or from an earlier solve.
double NewtonIteration::contraction_after(const Progress& progress) const {
  if (progress.iteration == 0) {
    const FirstUpdate& start = starts_[progress.with_kept];
    if (!start.is_known || start.age > kTrust) return 1.0;
    const double growth =
        std::max(1.0, progress.norm / start.norm);  // with new factors, contraction grows with the norm
    return std::min(1.0, kCaution * growth * start.contraction);
  }
  const double shown = std::min(progress.contraction, 1.0);
  if (progress.with_kept && progress.iteration == 1) {
    // The first update removes the smooth error of the guess best of all. Later updates with kept factors contract
    // less.
    const KeptContraction& kept = kept_contractions_[progress.started_with_kept];
    const bool is_known = kept.is_known && kept.age <= kTrustInContraction;
    return is_known ? std::max(shown, kExpectedShare * kept.contraction) : 1.0;
  }
  // New factors square the error, kept ones contract it. Symmetric middle functions are not part of the tangent, so
  // that convergence is linear even with new factors.
  // After an update by kept factors, the ratio of both says nothing about the square.
  // Where friction falls with the rate, its curvature may show in the last update only.
  const bool squares = !progress.with_kept && !progress.kept_before && !has_falling_friction_ &&
                       system_.configuration().scheme().mid_functions == MidFunctions::Explicit;
  return squares ? shown * shown : shown;
}

/// Target for the remaining error of a solve. Divided by the step, this error is an error of the velocity. So shorter
/// sub-steps have a proportionally smaller target.
double NewtonIteration::target() const {
  const double step = std::abs(system_.configuration().step());
  const double part = step > 0 ? std::min(step / settings_.step, 1.0) : 1.0;
  return std::max(part * settings_.tolerance * settings_.tolerance, kRoundOff);
}

/// Where factors may be kept, convergence is to round-off, even in a solve that has started again without them.
bool NewtonIteration::has_converged(const Progress& progress, Factors factors) const {
  const bool may_have_begun_anew = settings_.reuse_factorisation && system_.configuration().step() != 0 &&
                                   progress.iteration + 1 < settings_.max_iterations;
  if (factors == Factors::Fresh && !may_have_begun_anew) return progress.norm <= settings_.tolerance;
  const bool stagnates = progress.norm <= kStagnation && progress.contraction > kStalled && progress.since_revision > 1;
  return stagnates || remainder_after(progress) <= target();
}

}  // namespace flexarm
