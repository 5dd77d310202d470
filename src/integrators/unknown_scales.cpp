#include "integrators/unknown_scales.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

/// Largest absolute value; NaN where one is not a number.
template <class Values>
double largest(const Eigen::ArrayBase<Values>& values) {
  return values.size() > 0 ? values.abs().template maxCoeff<Eigen::PropagateNaN>() : 0.0;
}

}  // namespace

UnknownScales::UnknownScales(const Model& model, const DegreesOfFreedom& dof)
    : length_(model.length_scale),
      scales_(Eigen::ArrayXd::Zero(dof.unknowns)),
      rotations_(Eigen::ArrayXd::Zero(dof.unknowns)) {
  const auto add = [&](int equation, bool is_rotation) {
    if (equation < 0) return;
    scales_[equation] = is_rotation ? 1.0 : 1 / length_;
    rotations_[equation] = is_rotation ? 1.0 : 0.0;
  };
  for (int i = 0; i < dof.node_count; ++i)
    for (int k = 0; k < 6; ++k) add(dof.equation[dof.first[i] + k], k >= 3);
  for (const Coordinate& coordinate : model.coordinates)
    add(dof.equation[dof.scalar_of(coordinate)], is_rotation(model, coordinate));
  mass_ = mass_of(model);
  for (std::size_t k = 0; k < model.closures.size(); ++k) {
    const int first = dof.first[dof.variable_of_closure(static_cast<int>(k))];
    const std::vector<ClosureConstraint>& constraints = model.closures[k].constraints;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      const bool is_gap = constraints[i].kind == ClosureConstraint::Kind::Gap;
      multipliers_.push_back({dof.equation[first + i], is_gap ? 1.0 : length_});
    }
  }
}

double UnknownScales::norm(const Eigen::VectorXd& increment, double step) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double norm = largest(increment.array() * scales_);
  if (!std::isfinite(norm)) return infinity;
  if (step == 0 || mass_ == 0) return norm;
  const double way = step * step / (mass_ * length_);
  for (const Multiplier& multiplier : multipliers_) {
    const double size = std::abs(way / multiplier.arm * increment[multiplier.equation]);
    norm = std::max(norm, std::isfinite(size) ? size : infinity);
  }
  return norm;
}

double UnknownScales::largest_moment(const Eigen::VectorXd& residual) const {
  return largest((scales_ > 0).select(residual.array() / scales_, 0.0));
}

double UnknownScales::largest_rotation(const Eigen::VectorXd& increment) const {
  return largest(increment.array() * rotations_);
}

void UnknownScales::choose_order(IncrementHistory& history) const {
  if (history.count < 2 || scales_.size() == 0) return;
  const auto made = [&](int i) {
    return Eigen::Map<const Eigen::ArrayXd>(history.increments[i].data(), scales_.size());
  };
  double smallest = std::numeric_limits<double>::infinity();
  for (int order = IncrementHistory::kNoMotion; order <= IncrementHistory::kHighestOrder; ++order) {
    const IncrementHistory::Weights weights = history.weights(order, 1, history.steps[0]);
    if (weights[1] == 0 && order > IncrementHistory::kNoMotion) continue;
    static_assert(IncrementHistory::kLength == 4);
    const double error =
        largest((made(0) - (weights[1] * made(1) + weights[2] * made(2) + weights[3] * made(3))) * scales_);
    if (error < smallest) smallest = error, history.order = order;
  }
}

}  // namespace flexarm
