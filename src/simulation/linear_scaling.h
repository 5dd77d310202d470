#pragma once
/// Scales the states of linear models so that stiff and soft motions separate. (docs/notes/linearisation.md)

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// The model x = basis z,  z' = a z + b u,  v = c z + d u. Its `a` is graded: large entries come first, and entries are
/// large only in rows and columns of stiff motions.
struct ScaledStates {
  Eigen::MatrixXd a, b, c;
  Eigen::MatrixXd basis, inverse;
  /// Poles with a smaller |pole| are 0 within round-off [1/s]. 0: there are no such poles; infinite: not known.
  double zero = 0;
  /// For each position state, its index among the model's coordinates. Empty if states are not scaled by modes.
  std::vector<Eigen::Index> places;
};
/// Scales by the modes of mass and stiffness. These need not be the modes of the model itself, since any scaling gives
/// the same model. If a model has no such matrices for its states, such as a reduced one, its states are only balanced.
/// @throws std::invalid_argument if the sizes of a, b, c, d and positions do not agree.
ScaledStates scaled_states(const LinearModel& model);

}  // namespace flexarm
