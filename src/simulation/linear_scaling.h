#pragma once
/// Scales the states of linear models so that stiff and soft motions separate. (docs/notes/linearisation.md)

#include <vector>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// The model x = basis z,  z' = a z + b u,  v = c z + d u. Its `a` is graded: large entries come first, and entries are
/// large only in rows and columns of stiff motions.
struct ScaledStates {
  Eigen::MatrixXd a, b, c;
  Eigen::MatrixXd basis, inverse;
  /// Where stiffnesses are 0 within round-off: the root of that round-off, per mass, and how far the error of an
  /// eigenvalue solver may split a double pole at 0 [1/s]. Both are 0 if there are no such stiffnesses, or if that is
  /// not known.
  double zero = 0, split = 0;
};
/// Scales by the modes of mass and stiffness. These need not be the modes of the model itself, since any scaling gives
/// the same model. If a model has no such matrices for its states, such as a reduced one, its states are only balanced.
/// @throws std::invalid_argument if the sizes of a, b, c, d and positions do not agree.
ScaledStates scaled_states(const LinearModel& model);

/// For each of these position states, its index among the model's coordinates. Empty if one of them is no coordinate,
/// as in reduced models.
std::vector<Eigen::Index> places_of(const LinearModel& model, const std::vector<Eigen::Index>& states);

}  // namespace flexarm
