// Tests eigenvalues of dense matrices by each iteration, and the errors if there are none.
#include "math/dense_eigenpairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace flexarm {
namespace {

/// Returns a matrix with eigenvalues -1 +- 20 i, 3 and -1e4, coupled. `spread` is the ratio of the scales of
/// neighbouring coordinates.
Eigen::MatrixXd general_matrix(double spread) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4, 4);
  matrix.topLeftCorner(2, 2) << -1, 20, -20, -1;
  matrix.diagonal().tail(2) << 3, -1e4;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 2; j < 4; ++j) matrix(i, j) = 0.7 * (i + 1) - 0.2 * j;
  for (int i = 0; i < 4; ++i) {
    matrix.row(i) *= std::pow(spread, i);
    matrix.col(i) /= std::pow(spread, i);
  }
  return matrix;
}

TEST(Eigenpairs, OfEachIteration) {
  for (const double spread : {1.0, 1e3}) {
    const Eigen::MatrixXd matrix = general_matrix(spread);
    for (const auto& find : {dense_eigenpairs, complex_eigenpairs}) {
      const Eigenpairs pairs = find(matrix);
      for (int i = 0; i < 4; ++i) {
        const Eigen::VectorXcd vector = pairs.vectors.col(i);
        // The algorithm is backward stable: the residual is round-off of the matrix, a few operations per row.
        EXPECT_LT((matrix * vector - pairs.values[i] * vector).norm(),
                  64 * std::numeric_limits<double>::epsilon() * matrix.norm());
        EXPECT_NEAR(vector.norm(), 1, 1e-12);
      }
    }
  }
}

TEST(Eigenpairs, OfWhatIsNotFiniteAreRefusedInOurWords) {
  Eigen::MatrixXd matrix = general_matrix(1);
  matrix(2, 1) = std::numeric_limits<double>::infinity();
  try {
    dense_eigenpairs(matrix);
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "the eigenvalues of a matrix of 4 rows are not found: not all of its entries are finite");
  }
}

}  // namespace
}  // namespace flexarm
