#include "math/matrix_exponential.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace flexarm {
namespace {

/// Number of terms of the series. For a norm of at most 1/2, the next term is below 1e-19 of the first.
constexpr int kTerms = 15;

}  // namespace

Eigen::MatrixXd matrix_exponential_less_identity(Eigen::MatrixXd matrix) {
  assert(matrix.rows() == matrix.cols());
  const double norm = matrix.rows() > 0 ? matrix.cwiseAbs().colwise().sum().maxCoeff() : 0;
  int squarings = 0;
  if (norm > 0 && std::isfinite(norm)) squarings = std::max(0, static_cast<int>(std::ceil(std::log2(norm))) + 1);
  matrix *= std::exp2(-squarings);
  Eigen::MatrixXd sum = matrix / kTerms;
  for (int k = kTerms - 1; k > 0; --k) sum = ((matrix + matrix * sum) / k).eval();
  for (int k = 0; k < squarings; ++k) sum = (2 * sum + sum * sum).eval();
  return sum;
}

}  // namespace flexarm
