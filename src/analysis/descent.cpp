#include "analysis/descent.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "analysis/linearised_motion.h"
#include "math/dense_eigenpairs.h"

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
constexpr int kMostSteps = 200;
/// Number of bisections in the search for the shift of the curvature.
constexpr int kBisections = 100;
/// A step into a stop takes at most the part kPartOfGive of the depth by which the stop gives way. A step out of a stop
/// goes kBeyond beyond it.
constexpr double kPartOfGive = 0.1, kBeyond = 1e-12;
/// Steps of this length or less may lead into a stop. They are accepted even if the force grows, as long as the
/// potential changes by no more than round-off.
constexpr double kTiny = 1e-10;
/// Share of a coordinate in a motion above which it takes part.
constexpr double kTakesPart = 1e-3;
/// Relative to the curvature that weight and loads make: for larger curvatures round-off does not matter.
constexpr double kSoft = 1e-2;
/// The same: for smaller curvatures Newton's method may fail.
constexpr double kFirm = 1e-3;
/// If a step of Newton's method is not shorter than the last one by this factor, it is round-off.
constexpr double kShorter = 0.5;

Eigen::MatrixXd columns_and_rows(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& indices) {
  const auto size = static_cast<Eigen::Index>(indices.size());
  Eigen::MatrixXd part(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < size; ++k) part(i, k) = matrix(indices[i], indices[k]);
  return part;
}

}  // namespace

Descent::Descent(const Model& model, const Scheme& scheme, const StepSettings& settings)
    : potentials_(model, scheme, settings), tolerance_(settings.tolerance) {}

bool Descent::begin(const State& state) {
  return potentials_.begin(state);
}

/// Modes of the coordinates that are not fixed, after the fixed ones have moved by `ways`.
Descent::Modes Descent::modes(const JointPotential& at, const std::vector<bool>& is_fixed,
                              const Eigen::VectorXd& ways) {
  std::vector<Eigen::Index> open;
  for (std::size_t i = 0; i < is_fixed.size(); ++i)
    if (!is_fixed[i]) open.push_back(static_cast<Eigen::Index>(i));
  const auto size = static_cast<Eigen::Index>(open.size());
  const Eigen::VectorXd force = at.force + at.curvature * ways;
  Eigen::MatrixXd curvature = columns_and_rows(at.curvature, open);
  const Eigen::VectorXd scale = curvature.diagonal().unaryExpr(
      [&](double value) { return 1 / std::sqrt(std::max(1.0, std::abs(value) / potentials_.reference())); });
  curvature = (scale.asDiagonal() * curvature * scale.asDiagonal()).eval();
  const SymmetricEigenpairs pairs = symmetric_eigenpairs(curvature);
  Modes modes;
  modes.curvature = pairs.values;
  modes.motions = Eigen::MatrixXd::Zero(at.force.size(), size);
  for (Eigen::Index i = 0; i < size; ++i) modes.motions.row(open[i]) = scale[i] * pairs.vectors.row(i);
  modes.force = modes.motions.transpose() * force;
  // The round-off of beams matters for soft motions only.
  const auto soft = std::count_if(modes.curvature.data(), modes.curvature.data() + size,
                                  [&](double curvature) { return curvature < kSoft * potentials_.reference(); });
  modes.round_off.resize(size);
  modes.round_off.head(soft) = potentials_.round_off(at, modes.motions.leftCols(soft));
  for (Eigen::Index i = soft; i < size; ++i) modes.round_off[i] = potentials_.round_off_of_loads(modes.motions.col(i));
  return modes;
}

/// Minimum of the quadratic model within the radius, along the modes that are not flat.
Eigen::VectorXd Descent::step_in(const Modes& modes, double radius) {
  const Eigen::Index size = modes.curvature.size();
  std::vector<Eigen::Index> open;
  Eigen::Index lowest = -1;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (modes.is_flat(i)) continue;
    open.push_back(i);
    if (lowest < 0 || modes.curvature[i] < modes.curvature[lowest]) lowest = i;
  }
  Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
  if (lowest < 0) return step;
  const auto shifted = [&](double shift) {
    for (const Eigen::Index i : open) {
      const double curvature = modes.curvature[i] + shift;
      step[i] = modes.force[i] == 0 ? 0 : -modes.force[i] / std::max(curvature, std::numeric_limits<double>::min());
    }
    return step.norm();
  };
  const double least = std::max(0.0, -modes.curvature[lowest]);
  const bool is_convex = modes.curvature[lowest] > modes.round_off[lowest];
  if (is_convex && shifted(0) <= radius) return step;
  double low = least, high = least + modes.force.norm() / radius + std::numeric_limits<double>::min();
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (shifted(middle) > radius ? low : high) = middle;
  }
  const double length = shifted(high);
  // There is no force along the lowest curvature, which is negative: go to one side.
  if (modes.curvature[lowest] < -modes.round_off[lowest] && length < radius)
    step[lowest] += (modes.force[lowest] > 0 ? -1 : 1) * std::sqrt(radius * radius - length * length);
  return step;
}

/// Ends the motion of the coordinate that crosses a bound first, at this bound. Returns false if none does.
bool Descent::stop_at_bound(const JointPotential& at, std::vector<bool>& is_fixed, Eigen::VectorXd& ways) const {
  double earliest = 1;
  const JointPotentials::Bound* met = nullptr;
  for (const JointPotentials::Bound& bound : potentials_.bounds()) {
    const auto i = static_cast<Eigen::Index>(bound.axis);
    if (is_fixed[bound.axis] || ways[i] == 0) continue;
    const double begin = potentials_.position(at.state, bound.axis);
    const double way = ways[i] / potentials_.axes()[bound.axis].scale;
    const double depth = bound.inward * (begin - bound.place), deeper = bound.inward * way;
    const bool crosses = depth > 0 ? depth + deeper < 0 : depth + deeper > 0;
    if (!crosses || (depth > 0 && -depth / deeper > 1)) continue;
    const double part = std::max(0.0, -depth / deeper);
    if (part < earliest) earliest = part, met = &bound;
  }
  if (!met) return false;
  const auto i = static_cast<Eigen::Index>(met->axis);
  const double scale = potentials_.axes()[met->axis].scale;
  const double depth = met->inward * (potentials_.position(at.state, met->axis) - met->place);
  double wanted = -kBeyond;
  if (depth <= 0) {
    const double push = std::abs(at.force[i]) * scale / std::max(met->stiffness, std::numeric_limits<double>::min());
    wanted = std::clamp(push, kBeyond, std::min(kPartOfGive * met->give, kFirstRadius / scale));
  }
  const double way = scale * met->inward * (wanted - depth);
  // Not farther than without the bound.
  ways[i] = std::abs(way) < std::abs(ways[i]) ? way : ways[i];
  is_fixed[met->axis] = true;
  return true;
}

Descent::Step Descent::step_from(const JointPotential& at, double radius) {
  std::vector<bool> is_fixed(at.force.size(), false);
  Eigen::VectorXd fixed = Eigen::VectorXd::Zero(at.force.size());
  Step step;
  for (;;) {
    const Modes modes = this->modes(at, is_fixed, fixed);
    const Eigen::VectorXd along = step_in(modes, radius);
    step.ways = fixed + modes.motions * along;
    step.length = along.norm();
    std::vector<bool> now_fixed = is_fixed;
    Eigen::VectorXd ways = step.ways;
    if (!stop_at_bound(at, now_fixed, ways)) break;
    for (std::size_t i = 0; i < is_fixed.size(); ++i)
      if (now_fixed[i] && !is_fixed[i]) fixed[static_cast<Eigen::Index>(i)] = ways[static_cast<Eigen::Index>(i)];
    is_fixed = now_fixed;
    if (std::all_of(is_fixed.begin(), is_fixed.end(), [](bool fixed) { return fixed; })) {
      step.ways = fixed;
      step.length = 0;
      break;
    }
  }
  step.promise = -step.ways.dot(at.force + 0.5 * (at.curvature * step.ways));
  return step;
}

bool Descent::rests(const Modes& modes, double tolerance) {
  for (Eigen::Index i = 0; i < modes.curvature.size(); ++i)
    if (std::abs(modes.force[i]) > modes.round_off[i] && modes.way(i) > tolerance) return false;
  return true;
}

bool Descent::find(State& state, int load_steps, StepResult& result) {
  assert(load_steps >= 1);
  has_left_ = false;
  result.reason = StepResult::Reason::NotFinite;
  if (!begin(state)) return false;
  for (int step = 1; step <= load_steps && !potentials_.is_rigid(); ++step)
    if (!potentials_.rest(state, static_cast<double>(step) / load_steps, result)) return false;
  result.reason = StepResult::Reason::NeverRests;
  JointPotential at, next;
  at.state = state;
  if (!potentials_.look(at)) return false;
  double radius = kFirstRadius;
  for (int count = 0; count < kMostSteps; ++count) {
    state = at.state;
    if (potentials_.choose_axes(state) && !potentials_.look(at)) return false;
    const std::vector<bool> none(potentials_.axes().size(), false);
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(none.size()));
    ++result.iterations;
    const Modes whole = modes(at, none, still);
    if (rests(whole, tolerance_)) {
      bool is_minimum = true;
      for (Eigen::Index i = 0; i < whole.curvature.size(); ++i)
        is_minimum = is_minimum && whole.curvature[i] >= -whole.round_off[i];
      if (is_minimum) {
        // The estimate of round-off is for the worst case. Newton's method can often do better.
        bool is_sharp = true;
        for (Eigen::Index i = 0; i < whole.curvature.size(); ++i)
          is_sharp = is_sharp && (whole.curvature[i] <= whole.round_off[i] || whole.way(i) <= tolerance_);
        if (!is_sharp) sharpen(state);
        return true;
      }
      if (!has_left_) left_ = at.state;
      has_left_ = true;
    }
    const Step step = step_from(at, radius);
    if (step.ways.isZero(0)) return rests(whole, tolerance_);
    bool is_taken = false;
    double share = -1;
    if (potentials_.move(at, step.ways, next.state, result) && potentials_.look(next)) {
      // The fall of the potential along the actual motion, by Hermite's rule.
      const Eigen::VectorXd ways = potentials_.ways(at.state, next.state);
      const double fall = -0.5 * ways.dot(at.force + next.force) -
                          (ways.dot(at.curvature * ways) - ways.dot(next.curvature * ways)) / 12;
      const double noise = potentials_.round_off_of_loads(ways);
      share = step.promise > 0 ? fall / step.promise : -1;
      // At the corner of a stop, the quadratic model knows one side only.
      const bool is_tiny = ways.norm() <= kTiny;
      is_taken = share > kTaken || (std::abs(fall) <= noise && (is_tiny || next.force.norm() < at.force.norm()));
    }
    if (is_taken) std::swap(at, next);
    if (share < kPoor) radius = kShrinks * std::min(radius, std::max(step.length, kSmallestRadius));
    if (share > kGood && step.length > 0.9 * radius) radius = std::min(kGrows * radius, kLargestRadius);
    if (radius < kSmallestRadius) break;
  }
  state = at.state;
  return false;
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
  const std::vector<bool> none(potentials_.axes().size(), false);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(none.size()));
  JointPotential at;
  at.state = state;
  for (double last = std::numeric_limits<double>::infinity();;) {
    if (!potentials_.look(at)) return false;
    const Modes whole = modes(at, none, still);
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
  const std::vector<bool> none(potentials_.axes().size(), false);
  const Modes whole = modes(at, none, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(none.size())));
  hold = {};
  hold.least = std::numeric_limits<double>::infinity();
  std::vector<bool> is_free(none);
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

JointHold joint_hold(const Model& model, double contact_time, const State& equilibrium) {
  JointHold hold;
  if (!JointPotentials::exist(model, equilibrium)) return hold;
  const StepSettings settings;
  Descent(model, exact_equilibrium(contact_time), settings).judge(equilibrium, hold);
  return hold;
}

}  // namespace flexarm
