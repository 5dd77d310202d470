#pragma once
/// Scales the states of linear models such that stiff and soft motions separate. (docs/notes/linearisation.md)

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// x = basis z,  z' = a z + b u,  v = c z + d u, where `a` is graded: its large entries come first, and none is large
/// but beside a motion that is stiff itself.
struct ScaledStates {
  Eigen::MatrixXd a, b, c;
  Eigen::MatrixXd basis, inverse;
  /// Poles that are smaller are 0 but for round-off [1/s]; 0: there are none, infinite: nothing is known of that.
  double zero = 0;
};
/// Scales by the modes of mass and stiffness. They need not be those of the model itself, since any scaling gives the
/// same model. A model without such matrices for its states, such as a reduced one, is only balanced.
/// @throws std::invalid_argument if a, b, c, d and positions are not of one size.
ScaledStates scaled_states(const LinearModel& model);

}  // namespace flexarm
