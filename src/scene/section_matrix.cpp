#include "scene/section_matrix.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "scene/inertia_checks.h"

namespace flexarm::scene {
namespace {

constexpr double kMatrixTolerance = 1e-9;  // relative to the largest number of the matrix or block

/// The matrix with a unit diagonal: its definiteness does not depend on units. Needs a positive diagonal.
Matrix6 scaled_to_unit_diagonal(const Matrix6& matrix) {
  const Vector6 scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

}  // namespace

bool is_symmetric(const Matrix6& matrix) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double scale = std::max(
          {std::abs(matrix(i, j)), std::abs(matrix(j, i)), std::sqrt(std::abs(matrix(i, i)) * std::abs(matrix(j, j)))});
      if (!(std::abs(matrix(i, j) - matrix(j, i)) <= kMatrixTolerance * scale)) return false;
    }
  }
  return true;
}

bool is_positive_definite(const Matrix6& matrix) {
  if (!(matrix.diagonal().array() > 0).all()) return false;
  const Eigen::LLT<Matrix6> cholesky(scaled_to_unit_diagonal(matrix));
  return cholesky.info() == Eigen::Success;
}

bool is_inertia(const Matrix6& matrix) {
  const double mass = matrix(0, 0);
  const Matrix3 coupling = matrix.bottomLeftCorner<3, 3>(), rotary = matrix.bottomRightCorner<3, 3>();
  const auto small = [](const Matrix3& difference, double scale) {
    return difference.cwiseAbs().maxCoeff() <= kMatrixTolerance * scale;
  };
  if (!(mass > 0)) return false;
  if (!small(matrix.topLeftCorner<3, 3>() - mass * Matrix3::Identity(), mass)) return false;
  const double coupling_scale = coupling.cwiseAbs().maxCoeff(), rotary_scale = rotary.cwiseAbs().maxCoeff();
  if (!small(coupling + coupling.transpose(), coupling_scale)) return false;
  if (!small(matrix.topRightCorner<3, 3>() + coupling, coupling_scale)) return false;
  if (!small(rotary - rotary.transpose(), rotary_scale)) return false;
  return principal_moments(rotary + coupling * coupling / mass)[0] >= -kMatrixTolerance * rotary_scale;
}

}  // namespace flexarm::scene
