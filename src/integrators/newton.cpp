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
/// Updates that after so many iterations still do not shrink below this contraction are halved: full ones jump to and
/// fro between two sides of a steep law, half ones fall between them.
constexpr int kPatience = 5;
constexpr double kStalled = 0.5;
/// Growth of updates by kept factors with which a solve begins anew: it happens where these are of another branch.
constexpr double kAstray = 10;
/// Updates that no longer shrink below this are the round-off of a stiff system: its condition, up to 1e4 in the test
/// scenes of stiff bodies, times that of a double.
constexpr double kStagnation = 1e-12;
/// Solves that may end after one update, because an earlier one has shown what it leaves, until one more shows it anew.
constexpr int kTrust = 8;
/// By how much the next solve may do worse than the one that was watched.
constexpr double kCaution = 3;
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
}

bool NewtonIteration::solve(Updates updates, Factors factors, StepResult& result) {
  const Reason reason = iterate(updates, factors, result);
  enter(StepPhase::Control);
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

StepResult::Reason NewtonIteration::iterate(Updates updates, Factors factors, StepResult& result) {
  norms_.clear();
  if (update_.size() == 0) return evaluate(false);
  const double step = system_.configuration().step();
  const bool always_fresh = factors == Factors::Fresh;
  Progress progress;
  bool factorise = factor_reuse_.begin(factorised_step_ == step && system_.tangent_holds()) || always_fresh;
  for (; progress.iteration < settings_.max_iterations; ++progress.iteration) {
    if (const Reason failure = evaluate(factorise); failure != Reason::None) return failure;
    if (progress.since_revision > 0 && system_.revise_friction()) {
      progress.since_revision = 0;
      factorise = true;
      if (const Reason failure = evaluate(true); failure != Reason::None) return failure;
    }
    ++result.iterations;
    result.factorisations += factorise;
    progress.with_kept = !factorise;
    if (const Reason failure = find_update(updates, progress); failure != Reason::None) return failure;
    if (factorise) factorised_step_ = step;
    if (diverges(progress)) return Reason::NoConvergence;
    const bool compares = progress.since_revision > 0 && progress.norm > kStagnation;
    factorise =
        factor_reuse_.renew(progress.iteration, progress.with_kept, compares, progress.contraction) || always_fresh;
    if (is_led_astray(progress)) return Reason::NoConvergence;
    if (stalls(progress)) {
      update_ *= 0.5;
      progress.fraction *= 0.5;
    }
    ++progress.since_revision;
    const bool ends = has_converged(progress, factors);
    if (factorise && !progress.with_kept && !ends) system_.carry_strains(progress.fraction);
    system_.update(update_);
    if (!ends) continue;
    if (const Reason failure = evaluate(false); failure != Reason::None) return failure;
    if (system_.revise_friction()) {
      progress.since_revision = 0;
      factorise = true;
    } else if (is_as_expected(progress)) {
      return Reason::None;
    }
  }
  return Reason::NoConvergence;
}

StepResult::Reason NewtonIteration::find_update(Updates updates, Progress& progress) {
  enter(progress.with_kept ? StepPhase::Solve : StepPhase::Factorise);
  update_ = -system_.residual();
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

/// Kept factors that make updates grow so lead astray; full Newton begins anew. Round-off may grow as it likes.
bool NewtonIteration::is_led_astray(const Progress& progress) const {
  return progress.with_kept && progress.since_revision > 0 && progress.contraction > kAstray &&
         progress.norm > kStagnation;
}

/// A steep law (friction near sticking, the touch of a stop) makes full updates jump to and fro; statics has none.
bool NewtonIteration::stalls(const Progress& progress) const {
  return system_.configuration().step() != 0 && progress.since_revision >= kPatience && progress.contraction > kStalled;
}

/// The second update of a solve is what the first one left. Without factors that are kept nothing is learned, either:
/// then a step follows from the state alone, and a restored one continues bit for bit.
void NewtonIteration::learn(Progress& progress) {
  if (progress.iteration == 0) {
    progress.started_with_kept = progress.with_kept;
    progress.first_residual = system_.residual().norm();
  }
  if (!settings_.reuse_factorisation) return;
  if (progress.iteration == 0) {
    ++starts_[progress.with_kept].age;
  } else if (progress.iteration == 1) {
    const double ratio = progress.first_residual > 0 ? system_.residual().norm() / progress.first_residual : 0.0;
    starts_[progress.started_with_kept] = {norms_.front(), progress.contraction, ratio, 0, progress.since_revision > 0};
  }
}

/// After an evaluation at what a first update has led to. The residual tells what no earlier solve could know: that a
/// stop is touched, say.
bool NewtonIteration::is_as_expected(const Progress& progress) const {
  if (progress.iteration > 0) return true;
  const FirstUpdate& start = starts_[progress.with_kept];
  const double growth = std::max(1.0, progress.norm / start.norm);
  const double expected = std::max(kCaution * growth * start.residual_ratio, kRoundOff) * progress.first_residual;
  return system_.residual().norm() <= expected;
}

/// By the rate of the last two updates, or of the first two of an earlier solve: new factors square the error, kept
/// ones contract it.
double NewtonIteration::remainder_after(const Progress& progress) const {
  if (progress.iteration == 0) {
    const FirstUpdate& start = starts_[progress.with_kept];
    if (!start.is_known || start.age > kTrust) return progress.norm;
    const double growth = std::max(1.0, progress.norm / start.norm);  // new factors: of the contraction, too
    return progress.norm * std::min(1.0, kCaution * growth * start.contraction);
  }
  const double rate = std::min(progress.contraction, 1.0);
  // Symmetric middle functions are not in the tangent: they leave linear convergence with new factors, too.
  const bool squares = !progress.with_kept && system_.configuration().scheme().mid_functions == MidFunctions::Explicit;
  return progress.norm * (squares ? rate * rate : rate);
}

/// Where factors may be kept, convergence is to round-off, also when a solve has begun anew without them.
bool NewtonIteration::has_converged(const Progress& progress, Factors factors) const {
  const bool may_have_begun_anew = settings_.reuse_factorisation && system_.configuration().step() != 0 &&
                                   progress.iteration + 1 < settings_.max_iterations;
  if (factors == Factors::Fresh && !may_have_begun_anew) return progress.norm <= settings_.tolerance;
  const bool stagnates = progress.norm <= kStagnation && progress.contraction > kStalled && progress.since_revision > 1;
  return stagnates || remainder_after(progress) <= std::max(settings_.tolerance * settings_.tolerance, kRoundOff);
}

}  // namespace flexarm
