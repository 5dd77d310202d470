#include "analysis/statics.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/descent.h"
#include "analysis/node_ways.h"
#include "analysis/settling.h"
#include "analysis/stability.h"

namespace flexarm {
namespace {

/// First displacement along an unstable motion [rad, or in units of the length scale].
constexpr double kPush = 1e-3;
/// Drag with which an unstable equilibrium is left, relative to its curvature: with 2, displacements double in each
/// step. If the mechanism comes back, the drag was too small, and the next one is tried.
constexpr double kDragsOfFall[] = {2, 8, 32};
/// A mechanism that has moved no farther than this has come back [rad, or in units of the length scale].
constexpr double kNear = 2 * kPush;
/// How often the steps in which loads grow may be halved.
constexpr int kMostHalvings = 10;
/// Most unstable equilibria that a mechanism may leave one after the other.
constexpr int kMostFalls = 10;
/// In each turn the errors of servos with an integral shrink, by the stiffness of the loads over the sum of this
/// stiffness and kp. If they shrink by less than this ratio, that is round-off.
constexpr double kServosComeNearer = 0.9;
/// The same for updates of Newton's method, whose tangent leaves out terms of the elements' own error.
constexpr double kShorter = 0.5;

bool depends_on_path(const Scheme& scheme) {
  return scheme.interpolation == Interpolation::Incremental || scheme.interpolation == Interpolation::Iterative;
}

class EquilibriumSearch {
 public:
  EquilibriumSearch(const Model& model, const Scheme& scheme, const StepSettings& settings, const State& state)
      : EquilibriumSearch(model, scheme, statics_of(scheme), settings, state) {}
  /// `statics`: the rule of the equilibrium that is sought.
  EquilibriumSearch(const Model& model, const Scheme& scheme, const Scheme& statics, const StepSettings& settings,
                    const State& state)
      : model_(model),
        scheme_(scheme),
        statics_(statics),
        settings_(settings),
        state_(state),
        system_(model, statics),
        newton_(system_, settings),
        settling_(model, system_, newton_, neutral_curvature(model, state), settings.tolerance) {}

  const State& state() const { return state_; }
  const StaticResult& result() const { return result_; }
  const std::vector<double>& update_norms() const { return newton_.update_norms(); }

  /// Descends the potential, if there is one and joints are not held firmly. Otherwise follows the growing loads.
  bool find(int load_steps, Equilibrium wanted) {
    if (wanted == Equilibrium::UnderTheLoads || !JointPotentials::exist(model_, state_))
      return follow_loads(load_steps, wanted);
    const State start = state_;
    descent_.emplace(model_, statics_of(with_local_strains(scheme_)), settings_);
    const bool is_rigid = descent_->is_rigid();
    JointHold hold;
    const bool can_be_judged = descent_->judge(state_, hold);
    if (can_be_judged && !is_rigid && hold.is_firm()) {
      if (follow_loads(load_steps, wanted) && descent_->judge(state_, hold) && hold.is_firm()) return true;
      state_ = start;
      result_ = {};
    }
    if (can_be_judged && descend(load_steps)) {
      if (descent_->judge(state_, hold) && hold.free.empty()) result_.loose_link.clear();
      return true;
    }
    if (can_be_judged && is_rigid) return false;
    state_ = start;
    result_ = {};
    return follow_loads(load_steps, wanted);
  }

  /// Improves an equilibrium to round-off: goes on as long as updates become shorter.
  bool sharpen() {
    JointHold hold;
    if (JointPotentials::exist(model_, state_)) {
      descent_.emplace(model_, statics_, settings_);
      if (descent_->judge(state_, hold) && !(hold.is_firm() && !descent_->is_rigid())) {
        is_descending_ = true;
        return let_servos_integrate() && descent_->sharpen(state_) && stand();
      }
    }
    return sharpen_by_newton();
  }

  /// Replaces the forces that the scheme stores by those of the equilibrium.
  void renew_forces() {
    if (!state_.study.forces.empty()) state_.study.forces = system_.nodal_forces(state_);
  }

 private:
  bool follow_loads(int load_steps, Equilibrium wanted) {
    is_descending_ = false;
    return increase_loads(load_steps) && (depends_on_path(scheme_) ? settle_without_path(wanted) : settle_for(wanted));
  }

  /// Makes the state a state of the search's own system.
  bool stand() {
    Eigen::VectorXd multipliers;
    if (!model_.closures.empty() && !descent_->find_multipliers(state_, multipliers)) return false;
    system_.begin_equilibrium(state_, 1);
    if (multipliers.size() > 0) system_.update(multipliers);
    if (!system_.evaluate(false)) return false;
    system_.accept(state_);
    return true;
  }

  bool descend(int load_steps) {
    is_descending_ = true;
    if (!descent_->find(state_, load_steps, result_)) return false;
    name_fall();
    if (!let_servos_integrate()) return false;
    // Beams may buckle while joints stand still.
    for (int fall = 0;; ++fall) {
      const Stability stability = judge_stability(model_, state_);
      result_.loose_link = stability.loose_link;
      if (stability.is_stable() || descent_->is_rigid()) break;
      if (result_.falling_link.empty()) result_.falling_link = stability.motion.link;
      if (fall == kMostFalls || !leave(stability.motion) || !solve(1) || !let_servos_integrate()) return false;
    }
    if (!depends_on_path(scheme_)) return stand();
    system_.forget_path(state_);
    return stand() && Descent(model_, statics_, settings_).rest(state_, result_) && stand();
  }

  void name_fall() {
    const State* left = descent_->left();
    if (left && result_.falling_link.empty()) result_.falling_link = judge_stability(model_, *left).motion.link;
  }

  /// Steps that fail are halved where there are beams. Rigid mechanisms have the descent.
  bool increase_loads(int load_steps) {
    const double longest = 1.0 / load_steps, shortest = std::ldexp(longest, -kMostHalvings);
    double step = longest;
    for (double reached = 0; reached < 1;) {
      const double factor = reached + 1.5 * step < 1 ? reached + step : 1;
      const State before = state_;
      if (solve(factor) || settling_.settle(state_, factor, result_)) {
        reached = factor;
        step = std::min(2 * step, longest);
        continue;
      }
      step = 0.5 * (factor - reached);
      if (step < shortest || model_.stiffness_point_count == 0 || result_.reason == StepResult::Reason::NeverRests)
        return false;
      state_ = before;
    }
    return let_servos_integrate();
  }

  /// If strains depend on the path, a mechanism may go round for ever. The equilibrium to which it falls does not
  /// depend on the path. So let it fall with local interpolation, and let its strains start anew there.
  bool settle_without_path(Equilibrium wanted) {
    const Scheme local = with_local_strains(scheme_);
    EquilibriumSearch search(model_, local, settings_, state_);
    const bool is_found = search.settle_for(wanted);
    const bool falls = is_found && wanted == Equilibrium::Stable && !search.result_.falling_link.empty();
    result_.falling_link = search.result_.falling_link;
    result_.loose_link = search.result_.loose_link;
    if (!is_found) result_.reason = search.result_.reason, result_.failure = search.result_.failure;
    if (!falls) return is_found;
    state_ = search.state_;
    system_.forget_path(state_);
    return solve(1) && let_servos_integrate();
  }

  bool settle_for(Equilibrium wanted) {
    for (int fall = 0; fall < kMostFalls; ++fall) {
      const Stability stability = judge_stability(model_, state_);
      result_.loose_link = stability.loose_link;
      if (stability.is_stable()) return true;
      if (result_.falling_link.empty()) result_.falling_link = stability.motion.link;
      if (wanted == Equilibrium::UnderTheLoads) return true;
      if (!leave(stability.motion) || !let_servos_integrate()) return false;
    }
    result_.reason = StepResult::Reason::NeverRests;
    return false;
  }

  bool sharpen_by_newton() {
    for (double last = std::numeric_limits<double>::infinity();;) {
      if (!let_servos_integrate() || !solve(1)) return false;
      const std::vector<double>& ways = newton_.update_norms();
      if (ways.empty() || !(ways.front() < kShorter * last)) return true;  // none: nothing can move
      last = ways.front();
    }
  }

  /// A servo with an integral is at rest only if it has no error.
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

  /// Try full updates first: a beam that rolls up by several turns needs large rotations at once, and converges well
  /// with them.
  bool solve(double factor) {
    if (is_descending_) return descent_->find(state_, 1, result_);
    using Updates = NewtonIteration::Updates;
    for (const Updates updates : {Updates::Full, Updates::Limited}) {
      system_.begin_equilibrium(state_, factor);
      if (!newton_.solve(updates, NewtonIteration::Factors::Fresh, result_)) continue;
      system_.accept(state_);
      return true;
    }
    return false;
  }

  /// Pushes the mechanism along the motion; in the opposite direction if a slider would leave its line.
  bool leave(const UnstableMotion& motion) {
    const State start = state_;
    for (const double drag : kDragsOfFall) {
      if (!push(start, kPush * motion.direction) && !push(start, -kPush * motion.direction)) {
        result_.reason = StepResult::Reason::OffTheLine;
        return false;
      }
      const bool rests = settling_.settle(state_, 1, -drag * motion.curvature, result_);
      if (rests && NodeWays(model_, ways_between(start, state_)).largest() > kNear) return true;
    }
    return false;
  }

  bool push(const State& start, const Eigen::VectorXd& way) {
    system_.begin_equilibrium(start, 1);
    system_.update(way);
    if (!system_.evaluate(false)) return false;
    state_ = start;
    system_.accept(state_);
    return true;
  }

  const Model& model_;
  const Scheme& scheme_;
  const Scheme statics_;
  const StepSettings& settings_;
  State state_;
  StepSystem system_;
  NewtonIteration newton_;
  Settling settling_;
  std::optional<Descent> descent_;
  bool is_descending_ = false;
  StaticResult result_;
};

}  // namespace

StaticResult solve_static(const Model& model, const Scheme& scheme, const StepSettings& settings, int load_steps,
                          Equilibrium wanted, State& state, std::vector<double>* update_norms) {
  assert(load_steps >= 1);
  EquilibriumSearch search(model, scheme, settings, state);
  const bool is_found = search.find(load_steps, wanted);
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
