#pragma once
/// A vector in general position, for example as the start of an iteration or to test ranks.

#include <cmath>

#include <Eigen/Core>

namespace flexarm {

/// Returns a vector without zero or equal components.
inline Eigen::VectorXd general_vector(Eigen::Index size) {
  Eigen::VectorXd vector(size);
  for (Eigen::Index k = 0; k < size; ++k) vector[k] = std::sin(1.0 + 2.3 * static_cast<double>(k));
  return vector;
}

}  // namespace flexarm
