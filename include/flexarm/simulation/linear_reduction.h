#pragma once
/// Smaller linear models that answer nearly alike.

#include <Eigen/Core>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

struct ReducedModel {
  LinearModel model;  ///< of the states "reduced:0", ...; its equations of second order are those of the whole model
  Eigen::VectorXd hankel_singular_values;  ///< of the part that decays, the largest first
  int kept = 0;                            ///< states of poles that do not decay, all of which stay
};

/// Balanced truncation (Moore 1981; by square roots: Tombs and Postlethwaite 1987) of what decays; poles that do not,
/// as those of motions that nothing holds, stay as they are. No gain from inputs to outputs is off by more than twice
/// the sum of the Hankel singular values that are left out, at any frequency. These depend on the units of inputs and
/// outputs. The model has less than `order` states where the others would be such as inputs do not reach, or outputs do
/// not see.
/// @throws std::invalid_argument if `order` is larger than the number of states, or smaller than that of poles which do
/// not decay; or if the matrices of the model are not of one size.
ReducedModel reduced(const LinearModel& model, int order);

}  // namespace flexarm
