#include "integrators/stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// Larger Newton updates of a rotation are scaled down where limits are asked for [rad].
constexpr double kLargestRotationUpdate = 1.0;
/// A node must not turn by more than pi/2 in a step: |2 tan(angle/2)| = 2.
constexpr double kLargestStepRotation = 2.0;
/// Violation of what a loop's constraints imply: far above what Newton and the scene's rounded numbers leave.
constexpr double kOpenLoop = 1e-4;
/// Newton is given up when an update is this much larger than the first one.
constexpr double kDivergence = 1e4;
/// Updates that after so many iterations still do not shrink below this contraction are halved.
constexpr int kPatience = 5;
constexpr double kStalled = 0.5;
/// Growth of updates by kept factors with which a solve begins anew.
constexpr double kAstray = 10;
/// Updates by new factors that no longer shrink below this are the round-off of a stiff system.
constexpr double kStagnation = 1e-12;
/// Scaled updates cannot be expected to become smaller than this.
constexpr double kRoundOff = 1e-15;
/// Suzuki's composition of order four: parts of a step, the middle one runs backwards.
const double kOuterPart = 1 / (4 - std::cbrt(4.0));
const double kComposition[] = {kOuterPart, kOuterPart, 1 - 4 * kOuterPart, kOuterPart, kOuterPart};
/// Converged sub-steps after which the step is doubled again.
constexpr int kGoodStepsToDouble = 2;

}  // namespace

const char* to_string(StepResult::Reason reason) {
  switch (reason) {
    case StepResult::Reason::None:
      return "none";
    case StepResult::Reason::NoConvergence:
      return "Newton's method did not converge";
    case StepResult::Reason::SingularTangent:
      return "the tangent is singular";
    case StepResult::Reason::NotFinite:
      return "a quantity is not finite";
    case StepResult::Reason::RotationTooLarge:
      return "a node turns by more than 90 degrees in one step";
    case StepResult::Reason::OffTheLine:
      return "a slider leaves its line, or passes too many elements in one step";
    case StepResult::Reason::OpenLoop:
      return "a loop joint opens: its loop was singular at the start, or more is prescribed than the loop allows";
    case StepResult::Reason::EnergyDefect:
      return "the step's energy defect is too large to be closed by scaling the velocities";
  }
  return "unknown";
}

Stepper::Stepper(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : model_(model),
      scheme_(scheme),
      settings_(settings),
      system_(model, scheme),
      update_(system_.degrees_of_freedom().unknowns),
      factor_reuse_(system_.tangent().cost_of_factors()) {
  update_norms_.reserve(settings.max_iterations + 1);
  for (std::vector<double>& increment : before_.history.increments) increment.reserve(update_.size());
  if (scheme.scales_velocities) scaling_.emplace(model, scheme);
}

void Stepper::invalidate() {
  system_.invalidate();
  factorised_step_ = 0;
  factor_reuse_.reset();
}

bool Stepper::iterate(Updates updates, bool reuse, StepResult& result) {
  using Reason = StepResult::Reason;
  update_norms_.clear();
  const auto fail = [&](Reason reason) {
    result.reason = reason;
    factorised_step_ = 0;
    return false;
  };
  const auto not_evaluated = [&] { return system_.is_off_line() ? Reason::OffTheLine : Reason::NotFinite; };
  if (update_.size() == 0) return system_.evaluate(false) || fail(not_evaluated());

  bool factorise = factor_reuse_.begin(factorised_step_ == system_.step() && system_.tangent_holds()) || !reuse;
  int since_revision = 0;  // updates
  for (int iteration = 0; iteration < settings_.max_iterations; ++iteration) {
    if (!system_.evaluate(factorise)) return fail(not_evaluated());
    if (since_revision > 0 && system_.revise_friction()) {
      since_revision = 0;
      factorise = true;
      if (!system_.evaluate(true)) return fail(not_evaluated());
    }
    ++result.iterations;
    if (factorise) {
      ++result.factorisations;
      if (!system_.tangent().factorise()) return fail(Reason::SingularTangent);
      factorised_step_ = system_.step();
    }
    update_ = -system_.residual();
    if (!system_.tangent().solve(update_)) return fail(Reason::SingularTangent);
    const double rotation = system_.largest_rotation(update_);
    if (updates == Updates::Limited && rotation > kLargestRotationUpdate) update_ *= kLargestRotationUpdate / rotation;
    const double norm = system_.scaled_norm(update_);
    if (!std::isfinite(norm)) return fail(Reason::NotFinite);
    const double contraction =
        since_revision == 0 ? 1.0 : norm / std::max(update_norms_.back(), std::numeric_limits<double>::min());
    update_norms_.push_back(norm);
    if (norm > kDivergence * std::max(update_norms_.front(), 1e-3)) return fail(Reason::NoConvergence);
    const bool was_kept = !factorise;
    factorise =
        factor_reuse_.renew(iteration, was_kept, since_revision > 0 && norm > kStagnation, contraction) || !reuse;
    // Kept factors that make updates grow so lead astray; full Newton begins anew.
    if (was_kept && since_revision > 0 && contraction > kAstray) return fail(Reason::NoConvergence);
    // A steep law (friction near sticking, the touch of a stop) makes full updates jump to and fro; statics has none.
    if (system_.step() != 0 && since_revision >= kPatience && contraction > kStalled) update_ *= 0.5;
    system_.update(update_);
    ++since_revision;
    // What remains after this update, by the rate of the last two: new factors square the error, kept ones contract it.
    const double rate = std::min(contraction, 1.0);
    // Symmetric middle functions are not in the tangent: they leave linear convergence with new factors, too.
    const bool squares = !was_kept && scheme_.mid_functions == MidFunctions::Explicit;
    const double remains = norm * (squares ? rate * rate : rate);
    // Where factors may be kept, convergence is to round-off, also when a solve has begun anew without them.
    const bool is_severe =
        reuse || (settings_.reuse_factorisation && system_.step() != 0 && iteration + 1 < settings_.max_iterations);
    const bool stagnates = !was_kept && norm <= kStagnation && contraction > kStalled && since_revision > 1;
    const bool converged = is_severe
                               ? stagnates || remains <= std::max(settings_.tolerance * settings_.tolerance, kRoundOff)
                               : norm <= settings_.tolerance;
    if (converged) {
      if (!system_.evaluate(false)) return fail(not_evaluated());
      if (!system_.revise_friction()) return true;
      since_revision = 0;
      factorise = true;
    }
  }
  return fail(Reason::NoConvergence);
}

bool Stepper::sub_step(State& state, double step, StepResult& result) {
  if (!scheme_.is_composition && !scaling_) return simple_step(state, step, result);
  before_ = state;
  const auto fail = [&] {
    state = before_;
    invalidate();
    return false;
  };
  if (scheme_.is_composition) {
    for (const double part : kComposition)
      if (!simple_step(state, part * step, result)) return fail();
    state.time = before_.time + step;
  } else if (!simple_step(state, step, result)) {
    return false;
  }
  if (scaling_ && !scaling_->apply(before_, state)) {
    result.reason = StepResult::Reason::EnergyDefect;
    return fail();
  }
  return true;
}

bool Stepper::simple_step(State& state, double step, StepResult& result) {
  struct Attempt {
    StepSystem::Guess guess;
    bool reuse;
  };
  const Attempt attempts[] = {{StepSystem::Guess::Extrapolated, settings_.reuse_factorisation},
                              {StepSystem::Guess::Repeated, false},
                              {StepSystem::Guess::Unchanged, false}};
  for (const Attempt& attempt : attempts) {
    const bool is_the_same = !settings_.reuse_factorisation && state.history.order == 0;
    if (attempt.guess == StepSystem::Guess::Repeated && is_the_same) continue;
    system_.begin(state, step, attempt.guess);
    if (!iterate(Updates::Limited, attempt.reuse, result)) continue;
    if (system_.largest_node_rotation() > kLargestStepRotation) {
      result.reason = StepResult::Reason::RotationTooLarge;
      return false;
    }
    if (system_.open_loop() > kOpenLoop) {
      result.reason = StepResult::Reason::OpenLoop;
      return false;
    }
    system_.accept(state);
    result.reason = StepResult::Reason::None;
    return true;
  }
  return false;
}

StepResult Stepper::advance(State& state) {
  StepResult result;
  const double begin = state.time;
  const int finest = settings_.max_halvings;
  long done = 0;  // in units of step / 2^finest
  const long whole = 1L << finest;
  state.halving_level = std::clamp(state.halving_level, 0, finest);
  state.drives.begin();
  while (done < whole) {
    const int level = state.halving_level;
    if (sub_step(state, std::ldexp(settings_.step, -level), result)) {
      done += whole >> level;
      // Doubling must keep sub-steps on the grid of the longer ones.
      if (++state.good_steps >= kGoodStepsToDouble && level > 0 && done % (whole >> (level - 1)) == 0) {
        --state.halving_level;
        state.good_steps = 0;
      }
      continue;
    }
    state.good_steps = 0;
    if (level == finest) {
      invalidate();
      return result;
    }
    ++state.halving_level;
    ++result.halvings;
  }
  state.time = begin + settings_.step;
  state.drives.end(settings_.step);
  ++state.steps;
  result.converged = true;
  return result;
}

StepResult Stepper::solve_static(State& state, int load_steps) {
  StepResult result;
  State trial = state;
  // Full updates first: a beam that rolls up by several turns needs large rotations at once, and takes them well.
  const auto solve = [&](double factor) {
    for (const Updates updates : {Updates::Full, Updates::Limited}) {
      system_.begin_static(trial, factor);
      if (iterate(updates, false, result)) return true;
    }
    return false;
  };
  double factor = 0, increment = 1.0 / load_steps;
  const double smallest = std::ldexp(increment, -settings_.max_halvings);
  while (factor < 1) {
    const double next = factor + increment > 1 - 1e-12 ? 1.0 : factor + increment;
    if (solve(next)) {
      system_.accept_static(trial);
      factor = next;
    } else {
      increment *= 0.5;
      if (increment < smallest) return result;
      ++result.halvings;
    }
  }
  state = trial;
  invalidate();
  result.reason = StepResult::Reason::None;
  result.converged = true;
  return result;
}

void Stepper::initialise(State& state) {
  if (!scheme_.is_incremental()) initialise_accelerations(state);
  system_.initialise(state);
}

void Stepper::initialise_accelerations(State& state) {
  // A centred difference over a step h has a truncation error of order h and a round-off of order epsilon / h^2.
  const double h = 1e-2 * settings_.step;
  StepSettings settings = settings_;
  settings.step = h;
  Stepper momentum(model_, *find_scheme("m1"), settings);
  State moved = state;
  if (!momentum.advance(moved).converged) return;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    state.nodes[i].acceleration = (moved.nodes[i].velocity - state.nodes[i].velocity) / h;
    state.nodes[i].angular_acceleration = (moved.nodes[i].angular_velocity - state.nodes[i].angular_velocity) / h;
  }
  for (std::size_t i = 0; i < state.mass_points.size(); ++i)
    state.mass_points[i].angular_acceleration =
        (moved.mass_points[i].angular_velocity - state.mass_points[i].angular_velocity) / h;
}

}  // namespace flexarm
