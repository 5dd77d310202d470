// Tests the solver for sparse matrices (LU).
#include "solver/linear_solver.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace flexarm {
namespace {

/// A matrix in compressed columns.
struct Compressed {
  std::vector<int> starts{0}, rows;
  std::vector<double> values;
  explicit Compressed(const Eigen::MatrixXd& matrix) {
    for (int j = 0; j < matrix.cols(); ++j) {
      for (int i = 0; i < matrix.rows(); ++i)
        if (matrix(i, j) != 0) rows.push_back(i), values.push_back(matrix(i, j));
      starts.push_back(static_cast<int>(rows.size()));
    }
  }
};

/// Returns a banded, unsymmetric, well-conditioned matrix.
Eigen::MatrixXd banded(int size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i)
    for (int j = std::max(0, i - 4); j < std::min(size, i + 5); ++j) matrix(i, j) = uniform(engine) + (i == j ? 6 : 0);
  return matrix;
}

double residual(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  return (matrix * x - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

constexpr double kSolutionRoundOff = 1e-13;  // some hundred operations per entry

TEST(LinearSolver, Solves) {
  const Eigen::MatrixXd matrix = banded(50, 1);
  const Compressed compressed(matrix);
  LinearSolver solver(50, compressed.starts, compressed.rows);
  ASSERT_TRUE(solver.factorise(compressed.values));
  for (int repeat = 0; repeat < 3; ++repeat) {  // several right-hand sides
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(50, 1, 2 + repeat);
    Eigen::VectorXd x = b;
    ASSERT_TRUE(solver.solve(x));
    EXPECT_LE(residual(matrix, x, b), kSolutionRoundOff);
  }
  EXPECT_EQ(solver.factorisations(), 1);
}

TEST(LinearSolver, RefactorisationEqualsAFreshOne) {
  const Compressed first(banded(40, 1));
  LinearSolver reused(40, first.starts, first.rows);
  ASSERT_TRUE(reused.factorise(first.values));
  for (unsigned seed = 2; seed < 6; ++seed) {
    const Eigen::MatrixXd matrix = banded(40, seed);
    const Compressed next(matrix);
    ASSERT_EQ(next.rows, first.rows);
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(40);
    Eigen::VectorXd x = b, fresh_x = b;
    ASSERT_TRUE(reused.factorise(next.values));
    ASSERT_TRUE(reused.solve(x));
    LinearSolver fresh(40, next.starts, next.rows);
    ASSERT_TRUE(fresh.factorise(next.values));
    ASSERT_TRUE(fresh.solve(fresh_x));
    EXPECT_LE(residual(matrix, x, b), kSolutionRoundOff);
    EXPECT_LE((x - fresh_x).lpNorm<Eigen::Infinity>(), kSolutionRoundOff);
  }
}

// The pivots of the first values are almost zero in the second values.
TEST(LinearSolver, ChoosesNewPivotsWhenTheOldOnesFail) {
  Eigen::MatrixXd good(3, 3), bad(3, 3);
  good << 4, 1, 0.5, 1, 5, 0.5, 0.5, 1, 6;
  for (const double pivot : {1e-18, 1e-30}) {
    bad << pivot, 1, 0.5, 1, pivot, 0.5, 0.5, 1, pivot;
    const Compressed first(good), second(bad);
    LinearSolver solver(3, first.starts, first.rows);
    ASSERT_TRUE(solver.factorise(first.values));
    ASSERT_TRUE(solver.factorise(second.values));
    const Eigen::VectorXd b = Eigen::Vector3d(1, 2, 3);
    Eigen::VectorXd x = b;
    ASSERT_TRUE(solver.solve(x));
    EXPECT_LE(residual(bad, x, b), kSolutionRoundOff);
  }
}

TEST(LinearSolver, ZeroPivotInARefactorisation) {
  Eigen::MatrixXd good(2, 2);
  good << 4, 1, 1, 3;
  const Compressed compressed(good);
  LinearSolver solver(2, compressed.starts, compressed.rows);
  ASSERT_TRUE(solver.factorise(compressed.values));
  const std::vector<double> swapped = {0, 1, 1, 0};
  ASSERT_TRUE(solver.factorise(swapped));
  Eigen::VectorXd x = Eigen::Vector2d(2, 3);
  ASSERT_TRUE(solver.solve(x));
  EXPECT_LE((x - Eigen::Vector2d(3, 2)).norm(), kSolutionRoundOff);
}

TEST(LinearSolver, DetectsASingularMatrixAndRecovers) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 4, 1, 1, 3;
  const Compressed compressed(matrix);
  LinearSolver solver(2, compressed.starts, compressed.rows);
  const std::vector<double> singular = {1, 1, 1, 1}, zero = {0, 0, 0, 0};
  EXPECT_FALSE(solver.factorise(singular));
  EXPECT_FALSE(solver.factorise(zero));
  ASSERT_TRUE(solver.factorise(compressed.values));
  EXPECT_FALSE(solver.factorise(singular));  // also if factors exist already
  ASSERT_TRUE(solver.factorise(compressed.values));
  Eigen::VectorXd x = Eigen::Vector2d(5, 4);
  ASSERT_TRUE(solver.solve(x));
  EXPECT_LE((x - Eigen::Vector2d(1, 1)).norm(), kSolutionRoundOff);
}

TEST(LinearSolver, StructurallySingular) {
  Eigen::MatrixXd matrix(3, 3);
  matrix << 1, 0, 2, 3, 0, 4, 5, 0, 6;  // an empty column
  const Compressed compressed(matrix);
  LinearSolver solver(3, compressed.starts, compressed.rows);
  EXPECT_FALSE(solver.factorise(compressed.values));
}

TEST(LinearSolver, RefusesWhatIsNotFinite) {
  Eigen::MatrixXd matrix(2, 2);
  matrix << 4, 1, 1, 3;
  const Compressed compressed(matrix);
  LinearSolver solver(2, compressed.starts, compressed.rows);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double value : {nan, infinity}) {
    const std::vector<double> values = {value, 1, 1, 3};
    Eigen::VectorXd x = Eigen::Vector2d(1, 1);
    EXPECT_FALSE(solver.factorise(values) && solver.solve(x));
  }
  ASSERT_TRUE(solver.factorise(compressed.values));
  Eigen::VectorXd x = Eigen::Vector2d(nan, 1);
  EXPECT_FALSE(solver.solve(x));
}

TEST(LinearSolver, NothingToSolve) {
  const std::vector<int> starts = {0}, rows;
  LinearSolver solver(0, starts, rows);
  EXPECT_TRUE(solver.factorise({}));
  Eigen::VectorXd x(0);
  EXPECT_TRUE(solver.solve(x));
}

}  // namespace
}  // namespace flexarm
