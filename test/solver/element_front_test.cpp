// Elimination of an element's outboard nodes against a dense solution of the whole element.
#include "solver/element_front.h"

#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "elements/kernel_checks.h"
#include "support/dense_solution.h"

namespace flexarm {
namespace {

template <class Count>
class ElementFrontOf : public ::testing::Test {};
TYPED_TEST_SUITE(ElementFrontOf, test::NodeCounts);

/// An element's tangent and the diagonal blocks of its nodes, as a front wants them, and their sum as one matrix.
template <int Nodes>
struct Front {
  std::vector<double> blocks = std::vector<double>(ElementFront<Nodes>::kSize);
  std::array<Eigen::Matrix<double, 6, 6>, Nodes> diagonals;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6 * Nodes, 6 * Nodes);
  std::array<unsigned char, ElementFront<Nodes>::kEliminated> rows;

  explicit Front(unsigned seed) {
    test::RandomSource random(seed);
    for (int i = 0; i < Nodes; ++i) {
      for (int k = 0; k < 36; ++k) diagonals[i](k) = random.number();
      matrix.block<6, 6>(6 * i, 6 * i) = diagonals[i];
    }
    for (int i = 0; i < Nodes; ++i)
      for (int j = 0; j < Nodes; ++j) {
        Eigen::Map<Eigen::Matrix<double, 6, 6>> block(blocks.data() + 36 * (i * Nodes + j));
        for (int k = 0; k < 36; ++k) block(k) = random.number();
        matrix.block<6, 6>(6 * i, 6 * j) += block;
      }
  }
  bool eliminate() {
    std::array<double*, Nodes> pointers;
    for (int i = 0; i < Nodes; ++i) pointers[i] = diagonals[i].data();
    diagonals[0].setZero();
    return ElementFront<Nodes>::eliminate(blocks.data(), pointers.data(), rows.data());
  }
};

TYPED_TEST(ElementFrontOf, SolvesWithTheSchurComplement) {
  constexpr int kNodes = TypeParam::value, kOuter = ElementFront<kNodes>::kEliminated;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Front<kNodes> front(seed);
    const Eigen::Matrix<double, 6, 6> own = front.diagonals[0];
    ASSERT_TRUE(front.eliminate());
    const Eigen::MatrixXd &a = front.matrix, outer = a.bottomRightCorner(kOuter, kOuter);
    const Eigen::MatrixXd expected = a.topLeftCorner(6, 6) - own -
                                     a.topRightCorner(6, kOuter) * test::solution(outer, a.bottomLeftCorner(kOuter, 6));
    // Random matrices are no better conditioned than this says.
    const double condition = outer.norm() * test::solution(outer, Eigen::MatrixXd::Identity(kOuter, kOuter)).norm();
    const double round_off = 1e2 * condition * std::numeric_limits<double>::epsilon();
    EXPECT_LE((front.diagonals[0] - expected).norm(), round_off * expected.norm());

    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(6 * kNodes, -1, 2);
    Eigen::VectorXd x = b;
    std::array<double*, kNodes> r;
    for (int i = 0; i < kNodes; ++i) r[i] = x.data() + 6 * i;
    ElementFront<kNodes>::forward(front.blocks.data(), front.rows.data(), r.data());
    x.head<6>() = test::solution(front.diagonals[0] + own, x.head<6>());
    ElementFront<kNodes>::backward(front.blocks.data(), r.data());
    EXPECT_LE((a * x - b).norm(), round_off * (a.norm() * x.norm() + b.norm()));
  }
}

TYPED_TEST(ElementFrontOf, RefusesWhatHasNoPivot) {
  constexpr int kNodes = TypeParam::value;
  Front<kNodes> singular(1);
  for (int j = 0; j < kNodes; ++j) {  // a row without entries
    Eigen::Map<Eigen::Matrix<double, 6, 6>>(singular.blocks.data() + 36 * (kNodes + j)).row(2).setZero();
    singular.diagonals[j].row(2).setZero();
  }
  EXPECT_FALSE(singular.eliminate());
  Front<kNodes> not_finite(1);
  not_finite.blocks[36 * (kNodes + 1)] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(not_finite.eliminate());
}

}  // namespace
}  // namespace flexarm
