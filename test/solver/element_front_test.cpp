// Tests the elimination of an element's outer nodes against a dense solution of the whole element.
#include "solver/element_front.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "elements/kernel_checks.h"
#include "support/dense_solution.h"

namespace flexarm {
namespace {

/// Numbers of nodes and of unknowns per node, as a type.
template <int N, int U>
struct Size {
  static constexpr int nodes = N, unknowns = U;
};
template <class Of>
class ElementFrontOf : public ::testing::Test {};
using Sizes =
    ::testing::Types<Size<2, 6>, Size<3, 6>, Size<4, 6>, Size<5, 6>, Size<2, 3>, Size<3, 3>, Size<4, 3>, Size<5, 3>>;
TYPED_TEST_SUITE(ElementFrontOf, Sizes);

/// An element's tangent and the diagonal blocks of its nodes, as separate parts for a front, and their sum as one
/// matrix.
template <int Nodes, int U>
struct Front {
  using Element = ElementFront<Nodes, U>;
  using Block = Eigen::Matrix<double, U, U>;
  using BlockMap = Eigen::Map<Block, 0, Eigen::OuterStride<Element::kColumn>>;

  std::vector<double> blocks = std::vector<double>(Element::kSize);
  std::array<std::array<double, Element::kBlock>, Nodes> diagonals{};
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(U * Nodes, U* Nodes);
  std::array<unsigned char, Element::kEliminated> rows;

  BlockMap diagonal(int node) { return BlockMap(diagonals[node].data()); }
  BlockMap block(int i, int j) { return BlockMap(blocks.data() + Element::kBlock * (i * Nodes + j)); }

  /// Fills the matrix with random numbers, so that pivots off the diagonal are needed.
  explicit Front(unsigned seed) {
    test::RandomSource random(seed);
    for (int i = 0; i < Nodes; ++i) {
      for (int k = 0; k < U * U; ++k) diagonal(i)(k % U, k / U) = random.number();
      matrix.block<U, U>(U * i, U * i) = diagonal(i);
    }
    for (int i = 0; i < Nodes; ++i)
      for (int j = 0; j < Nodes; ++j) {
        for (int k = 0; k < U * U; ++k) block(i, j)(k % U, k / U) = random.number();
        matrix.block<U, U>(U * i, U * j) += block(i, j);
      }
  }
  /// Splits a given matrix: half of the diagonal blocks comes from other sources than the element.
  explicit Front(const Eigen::MatrixXd& whole) : matrix(whole) {
    for (int i = 0; i < Nodes; ++i) {
      diagonal(i) = 0.5 * whole.block<U, U>(U * i, U * i);
      for (int j = 0; j < Nodes; ++j) block(i, j) = (i == j ? 0.5 : 1.0) * whole.block<U, U>(U * i, U * j);
    }
  }
  bool eliminate(double* const* r = nullptr) {
    std::array<double*, Nodes> pointers;
    for (int i = 0; i < Nodes; ++i) pointers[i] = diagonals[i].data();
    diagonals[0].fill(0);
    return Element::eliminate(blocks.data(), pointers.data(), rows.data(), r);
  }
  bool has_diagonal_pivots() const {
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k] != k) return false;
    return true;
  }
};

/// Returns a matrix that is almost symmetric and positive definite, with eigenvalues from 1 to some 1e6, in changed
/// units: each unknown is scaled by a factor between a hundredth and a hundred.
Eigen::MatrixXd stiff_matrix(int size, unsigned seed) {
  test::RandomSource random(seed);
  Eigen::MatrixXd root(size, size), turned(size, size);
  for (int k = 0; k < root.size(); ++k) root.data()[k] = random.number(), turned.data()[k] = random.number();
  for (int k = 0; k < size; ++k) root.col(k) *= std::pow(1e3, static_cast<double>(k) / size);
  Eigen::MatrixXd matrix = root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
  matrix += 0.1 * (turned - turned.transpose());
  for (int k = 0; k < size; ++k) {
    const double unit = std::pow(100, random.number());
    matrix.row(k) *= unit;
    matrix.col(k) *= unit;
  }
  return matrix;
}

TYPED_TEST(ElementFrontOf, SolvesWithTheSchurComplement) {
  constexpr int kNodes = TypeParam::nodes, U = TypeParam::unknowns;
  using Element = ElementFront<kNodes, U>;
  constexpr int kOuter = Element::kEliminated;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Front<kNodes, U> front(seed);
    const Eigen::Matrix<double, U, U> own = front.diagonal(0);
    ASSERT_TRUE(front.eliminate());
    const Eigen::MatrixXd &a = front.matrix, outer = a.bottomRightCorner(kOuter, kOuter);
    const Eigen::MatrixXd expected = a.topLeftCorner(U, U) - own -
                                     a.topRightCorner(U, kOuter) * test::solution(outer, a.bottomLeftCorner(kOuter, U));
    // The condition number of random matrices is at most this.
    const double condition = outer.norm() * test::solution(outer, Eigen::MatrixXd::Identity(kOuter, kOuter)).norm();
    const double round_off = 1e2 * condition * std::numeric_limits<double>::epsilon();
    EXPECT_LE((front.diagonal(0) - expected).norm(), round_off * expected.norm());

    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(U * kNodes, -1, 2);
    Eigen::VectorXd x = b;
    std::array<double*, kNodes> r;
    for (int i = 0; i < kNodes; ++i) r[i] = x.data() + U * i;
    Element::forward(front.blocks.data(), front.rows.data(), r.data());
    x.head<U>() = test::solution(front.diagonal(0) + own, x.head<U>());
    Element::backward(front.blocks.data(), r.data());
    EXPECT_LE((a * x - b).norm(), round_off * (a.norm() * x.norm() + b.norm()));

    Front<kNodes, U> at_once(seed);  // with the right-hand side in the same pass
    Eigen::VectorXd y = b;
    for (int i = 0; i < kNodes; ++i) r[i] = y.data() + U * i;
    ASSERT_TRUE(at_once.eliminate(r.data()));
    y.head<U>() = test::solution(at_once.diagonal(0) + own, y.head<U>());
    Element::backward(at_once.blocks.data(), r.data());
    EXPECT_LE((a * y - b).norm(), round_off * (a.norm() * y.norm() + b.norm()));
  }
}

// The error in each row is at most the effect of rounding each entry of the row, times the number of operations.
TYPED_TEST(ElementFrontOf, SolvesOnTheDiagonalWithARightHandSideOnTheWay) {
  constexpr int kNodes = TypeParam::nodes, U = TypeParam::unknowns;
  using Element = ElementFront<kNodes, U>;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Eigen::MatrixXd a = stiff_matrix(U * kNodes, seed);
    Front<kNodes, U> front(a);
    const Eigen::Matrix<double, U, U> own = front.diagonal(0);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(U * kNodes, -1, 2);
    Eigen::VectorXd x = b;
    std::array<double*, kNodes> r;
    for (int i = 0; i < kNodes; ++i) r[i] = x.data() + U * i;
    ASSERT_TRUE(front.eliminate(r.data()));
    EXPECT_TRUE(front.has_diagonal_pivots());

    Eigen::VectorXd later = b;  // with the factors computed before
    for (int i = 0; i < kNodes; ++i) r[i] = later.data() + U * i;
    Element::forward(front.blocks.data(), front.rows.data(), r.data());
    for (Eigen::VectorXd* solved : {&x, &later}) {
      solved->head<U>() = test::solution(front.diagonal(0) + own, solved->head<U>());
      for (int i = 0; i < kNodes; ++i) r[i] = solved->data() + U * i;
      Element::backward(front.blocks.data(), r.data());
      const Eigen::VectorXd scale = a.cwiseAbs() * solved->cwiseAbs() + b.cwiseAbs();
      EXPECT_LE((a * *solved - b).cwiseAbs().cwiseQuotient(scale).maxCoeff(),
                std::pow(U * kNodes, 2) * std::numeric_limits<double>::epsilon());
    }
  }
}

TYPED_TEST(ElementFrontOf, RefusesWhatHasNoPivot) {
  constexpr int kNodes = TypeParam::nodes, U = TypeParam::unknowns;
  Front<kNodes, U> singular(1);
  for (int j = 0; j < kNodes; ++j) {  // a row of zeros
    singular.block(1, j).row(2).setZero();
    singular.diagonal(j).row(2).setZero();
  }
  EXPECT_FALSE(singular.eliminate());
  Front<kNodes, U> not_finite(1);
  not_finite.block(1, 1)(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(not_finite.eliminate());
}

}  // namespace
}  // namespace flexarm
