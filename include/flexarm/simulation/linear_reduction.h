#pragma once
/// Reduces the order of linear models while nearly keeping their response.

#include <Eigen/Core>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// A linear model of lower order.
struct ReducedModel {
  LinearModel model;  ///< with the states "reduced:0", ...; mass, damping, stiffness are those of the original model
  Eigen::VectorXd hankel_singular_values;  ///< of the decaying part, in descending order
  int kept = 0;  ///< number of states whose poles do not decay; only those that no input moves or no output shows go
};

/// Reduces the decaying part of a model by balanced truncation (Moore 1981; square-root method of Tombs and
/// Postlethwaite 1987). Poles that do not decay, such as those of free motions, are kept unchanged, except those that
/// no input moves or no output shows. At any frequency, no gain from inputs to outputs changes by more than twice the
/// sum of the removed Hankel singular values. These values depend on the units of inputs and outputs. The result has
/// less than `order` states if further states are uncontrollable or unobservable.
/// @throws std::invalid_argument if `order` is larger than the number of states or smaller than the number of states
/// that are kept, or if the sizes of the model's matrices do not match.
ReducedModel reduced(const LinearModel& model, int order);

}  // namespace flexarm
