// Tests dense fronts (elimination with a border) against Schur complements and factors of the whole matrix.
#include "solver/dense_front.h"

#include <limits>

#include <gtest/gtest.h>

#include "elements/random_element.h"
#include "support/dense_solution.h"

namespace flexarm {
namespace {

using test::RandomSource;

// Some hundred operations on numbers of order one; the condition number is some hundred
constexpr double kRoundOff = 1e-12;

Eigen::MatrixXd random_matrix(int size, RandomSource& random) {
  Eigen::MatrixXd matrix(size, size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) matrix(i, k) = random.number();
  return matrix;
}

/// Returns a front of the unknowns 0 ... size - 1.
DenseFront front_of(const Eigen::MatrixXd& matrix) {
  const int size = static_cast<int>(matrix.rows());
  DenseFront front(size);
  for (int k = 0; k < size; ++k) {
    front.rows.push_back(k);
    front.columns.push_back(k);
  }
  front.start(size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) front.row(i)[k] = matrix(i, k);
  return front;
}

/// Checks that the rest after `pivots` is the Schur complement of the eliminated rows and columns.
void expect_schur_complement(const Eigen::MatrixXd& matrix, DenseFront& front, int pivots) {
  const int size = front.size();
  if (pivots == size) return;
  Eigen::MatrixXd ordered(size, size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) ordered(i, k) = matrix(front.rows[i], front.columns[k]);
  const int rest = size - pivots;
  const Eigen::MatrixXd expected =
      ordered.bottomRightCorner(rest, rest) -
      ordered.bottomLeftCorner(rest, pivots) *
          test::solution(ordered.topLeftCorner(pivots, pivots), ordered.topRightCorner(pivots, rest));
  for (int i = 0; i < rest; ++i)
    for (int k = 0; k < rest; ++k)
      EXPECT_NEAR(front.row(pivots + i)[pivots + k], expected(i, k), kRoundOff * (1 + expected.norm()));
}

/// Checks that L times the first rows of U gives the first columns and rows of the matrix.
void expect_factors(const Eigen::MatrixXd& matrix, DenseFront& front, int pivots) {
  const int size = front.size();
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, pivots), upper = Eigen::MatrixXd::Zero(pivots, size);
  for (int k = 0; k < pivots; ++k) {
    lower(k, k) = 1;
    for (int i = k + 1; i < size; ++i) lower(i, k) = front.lower(k)[i];
    for (int j = k; j < size; ++j) upper(k, j) = front.row(k)[j];
    EXPECT_DOUBLE_EQ(front.reciprocal(k), 1 / upper(k, k));
  }
  const Eigen::MatrixXd product = lower * upper;
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) {
      if (i >= pivots && k >= pivots) continue;
      EXPECT_NEAR(product(i, k), matrix(front.rows[i], front.columns[k]), kRoundOff * (1 + matrix.norm()));
    }
}

// Rows of the border are handled in fours plus a remainder. Certain unknowns (see eliminate()) are eliminated together,
// in one block.
TEST(DenseFront, LeavesTheSchurComplementAndItsFactors) {
  RandomSource random(1);
  for (const int size : {1, 4, 7, 18, 30, 41, 43}) {
    const Eigen::MatrixXd matrix = random_matrix(size, random) + 4 * Eigen::MatrixXd::Identity(size, size);
    for (const int candidates : {1, (size + 1) / 2, size})
      for (const int certain : {0, (candidates + 1) / 2, candidates}) {
        DenseFront front = front_of(matrix);
        ASSERT_EQ(front.eliminate(candidates, {certain}, true), candidates);
        expect_schur_complement(matrix, front, candidates);
        expect_factors(matrix, front, candidates);
      }
  }
}

// Each group searches for pivots in its own rows. Rows of other groups are updated in one block.
TEST(DenseFront, GroupsGoOneAfterTheOther) {
  RandomSource random(5);
  for (const int size : {19, 30, 43}) {
    const Eigen::MatrixXd matrix = random_matrix(size, random) + 4 * Eigen::MatrixXd::Identity(size, size);
    for (const std::vector<int>& certain : {std::vector<int>{0, 6, 6, 18}, {12, 18}, {3, 7, 14}, {5, 17, 17}})
      for (const int candidates : {18, size}) {
        DenseFront front = front_of(matrix);
        ASSERT_EQ(front.eliminate(candidates, certain, true), candidates);
        expect_schur_complement(matrix, front, candidates);
        expect_factors(matrix, front, candidates);
        for (std::size_t i = 0; i + 1 < certain.size(); ++i)
          for (int k = 0; k < certain[i]; ++k) EXPECT_LT(front.rows[k], certain[i]);
      }
  }
}

// A multiplier has a zero on the diagonal. The row or column of a coordinate can serve as pivot; multipliers without a
// pivot are passed on.
TEST(DenseFront, MultipliersFindPivotsOrWait) {
  RandomSource random(2);
  Eigen::MatrixXd matrix = random_matrix(9, random);
  matrix.block<3, 3>(1, 1).setZero();  // one coordinate, three multipliers
  DenseFront front = front_of(matrix);
  const int pivots = front.eliminate(4, {0}, false);
  EXPECT_EQ(pivots, 2) << "a coordinate gives one multiplier its pivot";
  expect_schur_complement(matrix, front, pivots);
  DenseFront closed = front_of(matrix);
  EXPECT_EQ(closed.eliminate(4, {0}, true), -1) << "two more find none";
  EXPECT_EQ(front_of(matrix).eliminate(9, {0}, true), 9);
}

// The couplings of this unknown are not complete yet. With a pivot of 1e-9 now, nine digits would be lost.
TEST(DenseFront, SmallPivotsWait) {
  RandomSource random(3);
  Eigen::MatrixXd matrix = random_matrix(6, random);
  matrix(0, 0) = 1e-9;
  matrix(0, 5) = 1;
  EXPECT_EQ(front_of(matrix).eliminate(1, {0}, false), 0);
  EXPECT_EQ(front_of(matrix).eliminate(1, {0}, true), 1) << "but for the last chance";
}

TEST(DenseFront, RoundOffIsNoPivot) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(3, 3, 1.0 / 3);
  matrix(1, 1) += std::numeric_limits<double>::epsilon();
  EXPECT_EQ(front_of(matrix).eliminate(2, {2}, true), -1);
  matrix(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(front_of(matrix).eliminate(2, {2}, true), -1);
}

TEST(DenseFront, FoldsColumnsThenRows) {
  RandomSource random(4);
  const Eigen::MatrixXd matrix = random_matrix(8, random);
  const Eigen::MatrixXd left = random_matrix(8, random).topLeftCorner(2, 3),
                        right = random_matrix(8, random).topLeftCorner(2, 3);
  DenseFront front(8);
  for (int k = 0; k < 8; ++k) {
    front.rows.push_back(k);
    front.columns.push_back(k);
  }
  front.start(6);
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) front.row(i)[k] = matrix(i, k);
  const int targets[] = {1, 2, 4};
  const Eigen::Matrix<double, 2, 3, Eigen::RowMajor> left_rows = left, right_rows = right;
  front.fold(6, 2, left_rows.data(), right_rows.data(), 3, targets, 3);
  Eigen::MatrixXd from_left = Eigen::MatrixXd::Identity(8, 6), from_right = from_left;
  for (int t = 0; t < 3; ++t) {
    from_left.col(targets[t]).tail<2>() = left.col(t);
    from_right.col(targets[t]).tail<2>() = right.col(t);
  }
  const Eigen::MatrixXd expected = from_left.transpose() * matrix * from_right;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(front.row(i)[k], expected(i, k), kRoundOff);
}

}  // namespace
}  // namespace flexarm
