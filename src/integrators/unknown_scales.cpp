#include "integrators/unknown_scales.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {

UnknownScales::UnknownScales(const Model& model, const DegreesOfFreedom& dof) : length_(model.length_scale) {
  for (int i = 0; i < dof.node_count; ++i) {
    const int equation = dof.equation[dof.first[i]];
    for (int k = 0; k < 6 && equation >= 0; ++k) unknowns_.push_back({equation + k, k >= 3});
  }
  for (const Coordinate& coordinate : model.coordinates) {
    const int equation = dof.equation[dof.first[dof.variable_of_joint(coordinate.joint)] + coordinate.component];
    if (equation >= 0) unknowns_.push_back({equation, is_rotation(model, coordinate)});
  }
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
  double displacement = 0, norm = 0;
  const auto count = [](double value, double& largest) {
    largest = std::max(largest, std::isfinite(value) ? std::abs(value) : std::numeric_limits<double>::infinity());
  };
  for (const Unknown& unknown : unknowns_)
    count(increment[unknown.equation], unknown.is_rotation ? norm : displacement);
  norm = std::max(norm, displacement / length_);
  if (step == 0 || mass_ == 0) return norm;
  const double way = step * step / (mass_ * length_);
  for (const Multiplier& multiplier : multipliers_) count(way / multiplier.arm * increment[multiplier.equation], norm);
  return norm;
}

double UnknownScales::largest_moment(const Eigen::VectorXd& residual) const {
  double largest = 0;
  for (const Unknown& unknown : unknowns_)
    largest = std::max(largest, std::abs(residual[unknown.equation]) * (unknown.is_rotation ? 1.0 : length_));
  return largest;
}

double UnknownScales::largest_rotation(const Eigen::VectorXd& increment) const {
  double largest = 0;
  for (const Unknown& unknown : unknowns_)
    if (unknown.is_rotation) largest = std::max(largest, std::abs(increment[unknown.equation]));
  return largest;
}

void UnknownScales::choose_order(IncrementHistory& history) const {
  if (history.count < 2) return;
  double smallest = std::numeric_limits<double>::infinity();
  for (int order = IncrementHistory::kNoMotion; order <= IncrementHistory::kHighestOrder; ++order) {
    const IncrementHistory::Weights weights = history.weights(order, 1, history.steps[0]);
    if (weights[1] == 0 && order > IncrementHistory::kNoMotion) continue;
    double displacement = 0, rotation = 0;
    for (const Unknown& unknown : unknowns_) {
      double foreseen = 0;
      for (int i = 1; i <= 1 + order; ++i) foreseen += weights[i] * history.increments[i][unknown.equation];
      double& largest = unknown.is_rotation ? rotation : displacement;
      largest = std::max(largest, std::abs(history.increments[0][unknown.equation] - foreseen));
    }
    const double error = std::max(rotation, displacement / length_);
    if (error < smallest) smallest = error, history.order = order;
  }
}

}  // namespace flexarm
