#include "analysis/descent.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "analysis/linearised_motion.h"

namespace flexarm {
namespace {

/// Radius of the trust region: at the start, and the largest [rad, or in units of the length scale].
constexpr double kFirstRadius = 0.5, kLargestRadius = 2;
/// If the radius becomes smaller than this, the search has failed.
constexpr double kSmallestRadius = 1e-14;
/// Ratio of the actual to the predicted fall of the potential. Below kTaken a step is rejected, below kPoor the radius
/// shrinks, above kGood it grows.
constexpr double kTaken = 1e-3, kPoor = 0.25, kGood = 0.7;
constexpr double kShrinks = 0.25, kGrows = 2;
/// Bound of the error of the actual fall, relative to the reference curvature times the fifth power of the step.
constexpr double kErrorOfFall = 1e-2;
constexpr int kMostSteps = 200;
/// A configuration at rest that is no minimum is left by steps of kFirstRadius, or shorter ones down to this.
constexpr double kNearestWayOut = 1e-6;
/// Negative curvature below this, relative to the reference curvature, counts as none if no step along it leads down.
constexpr double kSlight = 1e-9;
/// Most iterations by which stiff motions come to rest.
constexpr int kMostSinks = 20;
/// Most sets of coordinates that may leave their stops together.
constexpr std::size_t kMostSets = 64;
/// A coordinate that has moved this far moves without limit [rad, or in units of the length scale].
constexpr double kFar = 30;
/// Steps of this length or less may lead into a stop. They are accepted even if the force grows, as long as the
/// potential changes by no more than round-off.
constexpr double kTiny = 1e-10;
/// Share of a coordinate in a motion above which it takes part.
constexpr double kTakesPart = 1e-3;
/// The same: for smaller curvatures Newton's method may fail.
constexpr double kFirm = 1e-3;
/// If a step of Newton's method is not shorter than the last one by this factor, it is round-off.
constexpr double kShorter = 0.5;

}  // namespace

Descent::Descent(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : potentials_(model, scheme, settings), tolerance_(settings.tolerance) {}

bool Descent::begin(const State& state) {
  return potentials_.begin(state);
}

/// Makes the step if the potential falls. `share`: of its promise.
bool Descent::take(JointPotential& at, const Step& step, double& share, StepResult& result) {
  share = -1;
  if (!potentials_.move(at, step.ways, next_.state, result) || !potentials_.look(next_)) return false;
  // The fall of the potential along the actual motion: that of stops by their law, the rest by Hermite's rule.
  const Eigen::VectorXd ways = potentials_.ways(at.state, next_.state);
  const auto work = [&](const JointPotential& there) { return ways.dot(there.force - there.stop_force); };
  const auto bend = [&](const JointPotential& there) {
    return ways.dot(there.curvature * ways) - ways.dot(there.stop_curvature.cwiseProduct(ways));
  };
  const double fall =
      at.stop_energy - next_.stop_energy - 0.5 * (work(at) + work(next_)) - (bend(at) - bend(next_)) / 12;
  const double noise = potentials_.round_off_of_loads(ways);
  if (step.promise > 0) share = fall / step.promise;
  // At the corner of a stop, the quadratic model knows one side only.
  const bool is_tiny = ways.norm() <= kTiny;
  const bool is_taken =
      share > kTaken || (std::abs(fall) <= noise && (is_tiny || next_.force.norm() < at.force.norm()));
  if (is_taken) std::swap(at, next_);
  return is_taken;
}

/// Along a soft motion that is curved, as in a wrist that can turn almost freely with the arm before it, straight steps
/// climb up the stiff walls of the valley. So if only soft motions are not at rest: steps along them, after which the
/// stiff motions come to rest. With no force in stiff motions at either end, the potential falls by the work of the
/// mean force. Returns false if no such step is found.
bool Descent::follow_valley(JointPotential& at, TouchedStops& stops, StepResult& result) {
  const Modes before = modes(at, stops);
  for (Eigen::Index i = 0; i < before.curvature.size(); ++i)
    if (is_stiff(before, i) && before.way(i) > tolerance_) return false;
  for (double radius = kFirstRadius; radius > kNearestWayOut; radius *= kShrinks)
    if (take_and_sink(at, best_step(at, stops, radius), result)) return true;
  return false;
}

/// Makes the step, and lets stiff motions come to rest behind it, if the potential falls.
bool Descent::take_and_sink(JointPotential& at, const Step& step, StepResult& result) {
  if (!potentials_.move(at, step.ways, next_.state, result) || !potentials_.look(next_) || !sink(result)) return false;
  const Eigen::VectorXd ways = potentials_.ways(at.state, next_.state);
  const double noise = potentials_.round_off_of_loads(ways);
  if (ways.norm() > 2 * step.ways.norm() || !(ways.dot(at.force) < noise)) return false;
  if (!(ways.dot(at.force + next_.force) < -noise)) return false;
  std::swap(at, next_);
  return true;
}

bool Descent::is_stiff(const Modes& modes, Eigen::Index i) const {
  return modes.curvature[i] > kFirm * potentials_.reference();
}

/// Brings the stiff motions to rest, by Newton's method. Returns false if that fails.
bool Descent::sink(StepResult& result) {
  double last = kFirstRadius;
  for (int count = 0; count < kMostSinks; ++count) {
    const Modes now = modes(next_, TouchedStops(potentials_, next_));
    Eigen::VectorXd along = Eigen::VectorXd::Zero(now.force.size());
    for (Eigen::Index i = 0; i < along.size(); ++i)
      if (is_stiff(now, i)) along[i] = -now.force[i] / now.curvature[i];
    const double way = along.norm();
    if (!(way < last)) return last <= tolerance_;
    last = way;
    sunk_.state = next_.state;
    if (!potentials_.move(next_, now.motions * along, sunk_.state, result) || !potentials_.look(sunk_)) return false;
    std::swap(next_, sunk_);
  }
  return false;
}

/// Sets of the coordinates that may leave their stops, for which the curvature is negative in some motion. All sets are
/// tried, unless there are too many: then small ones, and that of all these coordinates.
std::vector<Descent::AxisSet> Descent::unstable_sets(const JointPotential& at, TouchedStops& stops) {
  const AxisSet loose = stops.free_to_leave();
  std::vector<AxisSet> sets{{}}, unstable;
  for (std::size_t i = 0; i < sets.size() && sets.size() < kMostSets; ++i)
    for (const std::size_t axis : loose) {
      if (!sets[i].empty() && axis <= sets[i].back()) continue;
      sets.push_back(sets[i]);
      sets.back().push_back(axis);
    }
  if (sets.size() >= kMostSets) sets.push_back(loose);
  for (const AxisSet& set : sets) {
    stops.open(set);
    const Modes modes = this->modes(at, stops);
    if ((modes.curvature.array() < -modes.round_off.array()).any()) unstable.push_back(set);
  }
  stops.open({});
  return unstable;
}

/// Steps along negative curvature, the most promising ones first.
std::vector<Descent::Step> Descent::ways_out(const JointPotential& at, TouchedStops& stops,
                                             const std::vector<AxisSet>& sets, double radius) {
  std::vector<Step> steps;
  for (const AxisSet& set : sets) {
    stops.open(set);
    for (const double side : {1.0, -1.0}) {
      const Step step = step_from(at, stops, {radius, side, stops.weak_force()});
      if (step.promise > potentials_.round_off_of_loads(step.ways)) steps.push_back(step);
    }
  }
  stops.open({});
  std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.promise > b.promise; });
  return steps;
}

/// Makes a step along negative curvature, if the potential falls as the model promises.
bool Descent::step_out(JointPotential& at, const Step& step, StepResult& result) {
  const double error = kErrorOfFall * potentials_.reference() * std::pow(step.ways.norm(), 5);
  double share = 0;
  if (step.promise > error && take(at, step, share, result)) {
    if (share > kPoor) return true;
    std::swap(at, next_);
  }
  return take_and_sink(at, step, result);
}

/// Leaves a configuration at rest that is no minimum. Returns false if no way leads down from there.
bool Descent::leave(JointPotential& at, TouchedStops& stops, StepResult& result) {
  const std::vector<AxisSet> sets = unstable_sets(at, stops);
  if (sets.empty()) return false;
  State here = at.state;
  for (double radius = kFirstRadius; radius > kNearestWayOut; radius *= kShrinks)
    for (const Step& step : ways_out(at, stops, sets, radius)) {
      if (!step_out(at, step, result)) continue;
      if (!has_left_) left_ = std::move(here);
      has_left_ = true;
      return true;
    }
  return false;
}

bool Descent::find(State& state, int load_steps, StepResult& result) {
  assert(load_steps >= 1);
  has_left_ = false;
  result.reason = StepResult::Reason::NotFinite;
  if (!begin(state)) return false;
  for (int step = 1; step <= load_steps && !potentials_.is_rigid(); ++step)
    if (!potentials_.rest(state, static_cast<double>(step) / load_steps, result)) return false;
  JointPotential at;
  at.state = state;
  if (!potentials_.look(at)) return false;
  const State start = state;
  const bool is_found = descend(at, result);
  state = at.state;
  if (is_found)
    polish(at, state);
  else
    find_unheld(start, state, result);
  return is_found;
}

bool Descent::descend(JointPotential& at, StepResult& result) {
  double radius = kFirstRadius;
  for (int count = 0; count < kMostSteps && radius >= kSmallestRadius; ++count) {
    if (potentials_.choose_axes(at.state) && !potentials_.look(at)) return false;
    ++result.iterations;
    TouchedStops stops(potentials_, at);
    if (rests(at, stops)) {
      if (leave(at, stops, result)) continue;
      const Modes modes = this->modes(at, stops);
      const double slight = kSlight * potentials_.reference();
      return (modes.curvature.array() >= -modes.round_off.array().max(slight)).all();
    }
    const Step step = best_step(at, stops, radius);
    if (step.ways.isZero(0)) return false;
    double share = 0;
    if (!take(at, step, share, result) && follow_valley(at, stops, result)) continue;
    if (share < kPoor) radius = kShrinks * std::min(radius, std::max(step.length, kSmallestRadius));
    if (share > kGood && step.length > 0.9 * radius) radius = std::min(kGrows * radius, kLargestRadius);
  }
  return false;
}

/// The estimate of round-off is for the worst case. Newton's method can often do better.
void Descent::polish(const JointPotential& at, State& state) {
  const Modes all = modes(at);
  for (Eigen::Index i = 0; i < all.curvature.size(); ++i)
    if (all.curvature[i] > all.round_off[i] && all.way(i) > tolerance_) {
      sharpen(state);
      return;
    }
}

void Descent::find_unheld(const State& start, const State& end, StepResult& result) {
  result.reason = StepResult::Reason::NoConvergence;
  const Eigen::VectorXd ways = potentials_.ways(start, end).cwiseAbs();
  Eigen::Index farthest = 0;
  if (!(ways.maxCoeff(&farthest) > kFar)) return;
  result.reason = StepResult::Reason::NeverRests;
  result.failure.place = {};
  result.failure.place.coordinate = static_cast<int>(potentials_.axes()[farthest].coordinate);
}

bool Descent::rest(State& state, StepResult& result) {
  return begin(state) && potentials_.rest(state, 1, result);
}

bool Descent::find_multipliers(const State& equilibrium, Eigen::VectorXd& multipliers) {
  JointPotential at;
  at.state = equilibrium;
  if (!begin(equilibrium) || !potentials_.look(at)) return false;
  multipliers = at.multipliers;
  return true;
}

bool JointHold::is_firm() const {
  return free.empty() && least > kFirm;
}

bool Descent::sharpen(State& state) {
  if (!begin(state)) return false;
  JointPotential at;
  at.state = state;
  for (double last = std::numeric_limits<double>::infinity();;) {
    if (!potentials_.look(at)) return false;
    const Modes whole = modes(at);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(whole.force.size());
    for (Eigen::Index i = 0; i < along.size(); ++i)
      if (std::abs(whole.curvature[i]) > whole.round_off[i]) along[i] = -whole.force[i] / whole.curvature[i];
    State moved;
    const double norm = potentials_.shift(at, whole.motions * along, moved);
    if (!std::isfinite(norm)) return false;
    at.state = moved;
    if (!(norm < kShorter * last)) break;
    last = norm;
  }
  state = at.state;
  return true;
}

bool Descent::judge(const State& equilibrium, JointHold& hold) {
  if (!begin(equilibrium)) return false;
  JointPotential at;
  at.state = equilibrium;
  if (!potentials_.look(at)) return false;
  const Modes whole = modes(at);
  hold = {};
  hold.least = std::numeric_limits<double>::infinity();
  std::vector<bool> is_free(potentials_.axes().size(), false);
  for (Eigen::Index i = 0; i < whole.curvature.size(); ++i) {
    const Eigen::VectorXd motion = whole.motions.col(i);
    if (whole.is_flat(i)) {
      for (std::size_t k = 0; k < is_free.size(); ++k)
        is_free[k] = is_free[k] || std::abs(motion[static_cast<Eigen::Index>(k)]) > kTakesPart * motion.norm();
      continue;
    }
    hold.least = std::min(hold.least, whole.curvature[i] / potentials_.reference());
    Eigen::Index most = 0;
    motion.cwiseAbs().maxCoeff(&most);
    const JointPotentials::Axis& axis = potentials_.axes()[most];
    const double weakness = std::abs(motion[most]) * whole.round_off[i] / std::abs(whole.curvature[i]) / axis.scale;
    if (weakness > hold.weakness) hold.weakness = weakness, hold.weakest = axis.coordinate;
  }
  for (std::size_t k = 0; k < is_free.size(); ++k)
    if (is_free[k]) hold.free.push_back(potentials_.axes()[k].coordinate);
  return true;
}

JointHold joint_hold(const Model& model, const State& equilibrium) {
  JointHold hold;
  if (!JointPotentials::exist(model, equilibrium)) return hold;
  const StepSettings settings;
  Descent(model, exact_equilibrium(), settings).judge(equilibrium, hold);
  return hold;
}

}  // namespace flexarm
