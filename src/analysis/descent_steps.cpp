// The steps of a descent.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/descent.h"
#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

/// Number of bisections in the search for the shift of the curvature.
constexpr int kBisections = 100;
/// Relative to the curvature that weight and loads make: for larger curvatures round-off does not matter.
constexpr double kSoft = 1e-2;

Eigen::MatrixXd columns_and_rows(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& indices) {
  const auto size = static_cast<Eigen::Index>(indices.size());
  Eigen::MatrixXd part(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < size; ++k) part(i, k) = matrix(indices[i], indices[k]);
  return part;
}

}  // namespace

/// Modes of the coordinates that are not fixed.
Descent::Modes Descent::modes(const JointPotential& at, const Eigen::VectorXd& force, const Eigen::MatrixXd& curvature,
                              const std::vector<bool>& is_fixed) {
  std::vector<Eigen::Index> open;
  for (std::size_t i = 0; i < is_fixed.size(); ++i)
    if (!is_fixed[i]) open.push_back(static_cast<Eigen::Index>(i));
  const auto size = static_cast<Eigen::Index>(open.size());
  if (size == 0) return {Eigen::VectorXd(), Eigen::VectorXd(), Eigen::VectorXd(), Eigen::MatrixXd(force.size(), 0)};
  Eigen::MatrixXd part = columns_and_rows(curvature, open);
  const Eigen::VectorXd scale = part.diagonal().unaryExpr(
      [&](double value) { return 1 / std::sqrt(std::max(1.0, std::abs(value) / potentials_.reference())); });
  part = (scale.asDiagonal() * part * scale.asDiagonal()).eval();
  const SymmetricEigenpairs pairs = symmetric_eigenpairs(part);
  Modes modes;
  modes.curvature = pairs.values;
  modes.motions = Eigen::MatrixXd::Zero(force.size(), size);
  for (Eigen::Index i = 0; i < size; ++i) modes.motions.row(open[i]) = scale[i] * pairs.vectors.row(i);
  modes.force = modes.motions.transpose() * force;
  // The round-off of beams matters for soft motions only.
  const auto soft = std::count_if(modes.curvature.data(), modes.curvature.data() + size,
                                  [&](double value) { return value < kSoft * potentials_.reference(); });
  modes.round_off.resize(size);
  modes.round_off.head(soft) = potentials_.round_off(at, curvature, modes.motions.leftCols(soft));
  for (Eigen::Index i = soft; i < size; ++i) modes.round_off[i] = potentials_.round_off_of_loads(modes.motions.col(i));
  return modes;
}

/// All modes, with stops as they are.
Descent::Modes Descent::modes(const JointPotential& at) {
  return modes(at, at.force, at.curvature, std::vector<bool>(potentials_.axes().size(), false));
}

/// Modes of the coordinates that stops let move.
Descent::Modes Descent::modes(const JointPotential& at, const TouchedStops& stops) {
  return modes(at, stops.force(), stops.curvature(), stops.shut());
}

/// Minimum of the quadratic model within the radius, along the modes that are not flat.
Eigen::VectorXd Descent::step_in(const Modes& modes, const Search& search, bool& has_two_sides) {
  const Eigen::Index size = modes.curvature.size();
  std::vector<Eigen::Index> open;
  Eigen::Index lowest = -1;
  Eigen::VectorXd force = modes.force;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (modes.is_flat(i)) continue;
    open.push_back(i);
    if (lowest < 0 || modes.curvature[i] < modes.curvature[lowest]) lowest = i;
    const double none = std::max(search.weak, modes.round_off[i]);
    if (modes.curvature[i] < -modes.round_off[i] && std::abs(force[i]) <= none) force[i] = 0;
  }
  Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
  if (lowest < 0) return step;
  const auto shifted = [&](double shift) {
    for (const Eigen::Index i : open) {
      const double curvature = modes.curvature[i] + shift;
      step[i] = force[i] == 0 ? 0 : -force[i] / std::max(curvature, std::numeric_limits<double>::min());
    }
    return step.norm();
  };
  const double least = std::max(0.0, -modes.curvature[lowest]);
  const bool is_convex = modes.curvature[lowest] > modes.round_off[lowest];
  if (is_convex && shifted(0) <= search.radius) return step;
  double low = least, high = least + force.norm() / search.radius + std::numeric_limits<double>::min();
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (shifted(middle) > search.radius ? low : high) = middle;
  }
  const double length = shifted(high);
  if (modes.curvature[lowest] >= -modes.round_off[lowest]) return step;
  has_two_sides = has_two_sides || force[lowest] == 0;
  // There is no force along the lowest curvature, which is negative: go to one side.
  if (length < search.radius)
    step[lowest] +=
        (force[lowest] > 0 ? -search.side : search.side) * std::sqrt(search.radius * search.radius - length * length);
  return step;
}

/// The step to the minimum of the quadratic model within the radius. Coordinates end at the stops that they meet.
Descent::Step Descent::step_from(const JointPotential& at, const TouchedStops& stops, const Search& search) {
  const Eigen::VectorXd force = stops.force();
  const Eigen::MatrixXd curvature = stops.curvature();
  std::vector<bool> is_fixed = stops.shut();
  Eigen::VectorXd fixed = Eigen::VectorXd::Zero(force.size());
  Step step;
  for (;;) {
    const Modes modes = this->modes(at, force + curvature * fixed, curvature, is_fixed);
    const Eigen::VectorXd along = step_in(modes, search, step.has_two_sides);
    step.ways = fixed + modes.motions * along;
    step.length = along.norm();
    Encounter met{};
    if (!stops.meets(step.ways, is_fixed, met)) break;
    is_fixed[met.axis] = true;
    fixed[static_cast<Eigen::Index>(met.axis)] = met.way;
  }
  step.promise = -step.ways.dot(force + 0.5 * (curvature * step.ways));
  return step;
}

/// The step that promises most, of those to both sides of negative curvature without a force, and with coordinates that
/// graze stops held there or not.
Descent::Step Descent::best_step(const JointPotential& at, TouchedStops& stops, double radius) {
  const AxisSet none;
  Step best;
  best.promise = -std::numeric_limits<double>::infinity();
  const AxisSet grazing = stops.grazing();
  for (const AxisSet* open : {&none, &grazing}) {
    if (open == &grazing && grazing.empty()) break;
    stops.open(*open);
    for (const double side : {1.0, -1.0}) {
      const Step step = step_from(at, stops, {radius, side});
      if (step.promise > best.promise) best = step;
      if (!step.has_two_sides) break;
    }
  }
  stops.open({});
  return best;
}

bool Descent::rests(const JointPotential& at, const TouchedStops& stops) {
  const Modes modes = this->modes(at, stops);
  for (Eigen::Index i = 0; i < modes.curvature.size(); ++i)
    if (std::abs(modes.force[i]) > modes.round_off[i] && modes.way(i) > tolerance_) return false;
  return true;
}

}  // namespace flexarm
