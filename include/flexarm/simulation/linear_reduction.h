#pragma once
/// Smaller linear models with nearly the same response.

#include <Eigen/Core>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

struct ReducedModel {
  LinearModel model;  ///< of the states "reduced:0", ...; its equations of second order are those of the whole model
  Eigen::VectorXd hankel_singular_values;  ///< of the part that decays, the largest first
  int kept = 0;                            ///< states of poles that do not decay, all of which stay
};

/// Balanced truncation (Moore 1981; by square roots: Tombs and Postlethwaite 1987) of the part that decays. Poles that
/// do not decay, as those of motions that nothing resists, stay as they are. At any frequency no gain from inputs to
/// outputs changes by more than twice the sum of the Hankel singular values that are left out, which depend on the
/// units of inputs and outputs. The model has less than `order` states if the others cannot be reached from the inputs,
/// or not be seen in the outputs.
/// @throws std::invalid_argument if `order` is larger than the number of states, or smaller than the number of poles
/// that do not decay, or if the sizes of the model's matrices do not fit.
ReducedModel reduced(const LinearModel& model, int order);

}  // namespace flexarm
