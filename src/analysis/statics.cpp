#include "analysis/statics.h"

#include <limits>

#include "analysis/settling.h"
#include "analysis/stability.h"

namespace flexarm {
namespace {

/// First way along an unstable motion [rad, or in units of the length scale].
constexpr double kPush = 1e-3;
/// Drag on the way out of an unstable equilibrium beside its curvature: what leaves it doubles its way in each step.
constexpr double kDragOfFall = 2;
/// Times that a mechanism may fall from one unstable equilibrium to another one.
constexpr int kMostFalls = 10;
/// Errors of servos that integrate shrink at each turn by the stiffness of the loads over that and kp; by less than
/// this they do so by round-off alone.
constexpr double kServosComeNearer = 0.9;
/// The same of updates whose tangent leaves out terms of the elements' own error.
constexpr double kShorter = 0.5;

class EquilibriumSearch {
 public:
  EquilibriumSearch(const Model& model, const Scheme& scheme, const StepSettings& settings, const State& state)
      : EquilibriumSearch(model, scheme, statics_of(scheme), settings, state) {}
  /// `statics`: the balance that is sought.
  EquilibriumSearch(const Model& model, const Scheme& scheme, const Scheme& statics, const StepSettings& settings,
                    const State& state)
      : model_(model),
        scheme_(scheme),
        settings_(settings),
        state_(state),
        system_(model, statics),
        newton_(system_, settings),
        settling_(system_, newton_, neutral_curvature(model), settings.tolerance) {}

  const State& state() const { return state_; }
  const StaticResult& result() const { return result_; }
  const std::vector<double>& update_norms() const { return newton_.update_norms(); }

  bool increase_loads(int load_steps) {
    for (int step = 1; step <= load_steps; ++step) {
      const double factor = static_cast<double>(step) / load_steps;
      if (!solve(factor) && !settling_.settle(state_, factor, result_)) return false;
    }
    return let_servos_integrate();
  }

  /// Where strains depend on the way, a mechanism may go round and round, and what it falls to is no matter of the way:
  /// it falls with local interpolation, and its strains begin anew there.
  bool settle_without_path(Equilibrium wanted) {
    Scheme local = scheme_;
    local.interpolation = Interpolation::Local;
    local.cayley_interpolation = false;
    EquilibriumSearch search(model_, local, settings_, state_);
    const bool is_found = search.settle_for(wanted);
    const bool falls = is_found && wanted == Equilibrium::Stable && !search.result_.falling_link.empty();
    result_.falling_link = search.result_.falling_link;
    result_.loose_link = search.result_.loose_link;
    if (!is_found) result_.reason = search.result_.reason;
    if (!falls) return is_found;
    state_ = search.state_;
    system_.forget_path(state_);
    return solve(1) && let_servos_integrate();
  }

  bool settle_for(Equilibrium wanted) {
    for (int fall = 0; fall < kMostFalls; ++fall) {
      const Stability stability = judge_stability(model_, scheme_, state_);
      result_.loose_link = stability.loose_link;
      if (stability.is_stable()) return true;
      if (result_.falling_link.empty()) result_.falling_link = stability.motion.link;
      if (wanted == Equilibrium::UnderTheLoads) return true;
      if (!leave(stability.motion) || !let_servos_integrate()) return false;
    }
    result_.reason = StepResult::Reason::NeverRests;
    return false;
  }

  /// From an equilibrium, to round-off: as long as updates become shorter.
  bool sharpen() {
    for (double last = std::numeric_limits<double>::infinity();;) {
      if (!let_servos_integrate() || !solve(1)) return false;
      const double way = newton_.update_norms().front();
      if (!(way < kShorter * last)) return true;
      last = way;
    }
  }

  /// What the scheme remembers of forces is that of the equilibrium.
  void renew_forces() {
    if (!state_.forces.empty()) state_.forces = system_.nodal_forces(state_);
  }

 private:
  /// A servo that integrates is at rest where it has no error.
  bool let_servos_integrate() {
    for (double error = std::numeric_limits<double>::infinity();;) {
      const double last = error;
      error = system_.actuators().hand_to_integrals(state_);
      if (error == 0) return true;
      if (error > kServosComeNearer * last) {
        if (error <= settings_.tolerance) return true;
        result_.reason = StepResult::Reason::NeverRests;
        return false;
      }
      if (!solve(1)) return false;
    }
  }

  /// Full updates first: a beam that rolls up by several turns needs large rotations at once, and takes them well.
  bool solve(double factor) {
    using Updates = NewtonIteration::Updates;
    for (const Updates updates : {Updates::Full, Updates::Limited}) {
      system_.begin_equilibrium(state_, factor);
      if (!newton_.solve(updates, NewtonIteration::Factors::Fresh, result_)) continue;
      system_.accept(state_);
      return true;
    }
    return false;
  }

  /// To one side of the motion or, where a line ends there, to the other one.
  bool leave(const UnstableMotion& motion) {
    for (const double push : {kPush, -kPush}) {
      system_.begin_equilibrium(state_, 1);
      system_.update(push * motion.direction);
      if (!system_.evaluate(false)) continue;
      system_.accept(state_);
      return settling_.settle(state_, 1, -kDragOfFall * motion.curvature, result_);
    }
    result_.reason = StepResult::Reason::OffTheLine;
    return false;
  }

  const Model& model_;
  const Scheme& scheme_;
  const StepSettings& settings_;
  State state_;
  StepSystem system_;
  NewtonIteration newton_;
  Settling settling_;
  StaticResult result_;
};

}  // namespace

StaticResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                          Equilibrium wanted, State& state, std::vector<double>* update_norms) {
  EquilibriumSearch search(model, scheme, settings, state);
  const bool depends_on_path =
      scheme.interpolation == Interpolation::Incremental || scheme.interpolation == Interpolation::Iterative;
  const bool is_found = search.increase_loads(load_steps) &&
                        (depends_on_path ? search.settle_without_path(wanted) : search.settle_for(wanted));
  if (is_found) search.renew_forces();
  if (update_norms) *update_norms = search.update_norms();
  StaticResult result = search.result();
  result.converged = is_found;
  if (!is_found) return result;
  state = search.state();
  result.reason = StepResult::Reason::None;
  return result;
}

bool sharpen_equilibrium(const Model& model, const Scheme& scheme, const StepSettings& settings, State& state) {
  Scheme statics = statics_of(scheme);
  statics.tests_vary_strains = scheme.stress == StressRule::Conjugate;
  EquilibriumSearch search(model, scheme, statics, settings, state);
  if (!search.sharpen()) return false;
  search.renew_forces();
  state = search.state();
  return true;
}

}  // namespace flexarm
