#pragma once
/// A vector for what must not meet a special case.

#include <cmath>

#include <Eigen/Core>

namespace flexarm {

/// No component is special, nor are any two alike.
inline Eigen::VectorXd general_vector(Eigen::Index size) {
  Eigen::VectorXd vector(size);
  for (Eigen::Index k = 0; k < size; ++k) vector[k] = std::sin(1.0 + 2.3 * static_cast<double>(k));
  return vector;
}

}  // namespace flexarm
