// Tests elements whose interior nodes are eliminated in parallel (in packs) against the matrix of the whole structure.
#include "solver/interior_condensation.h"

#include <limits>

#include "building/model_builder.h"
#include "elements/random_element.h"
#include "math/lanes.h"
#include "solver/tree_tangent.h"
#include "support/dense_solution.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

constexpr int kElements = 6;  // a pack and half a pack

Model cantilever(int order) {
  return build_model(test::scene_of(test::robot(
      test::joint("clamp", "fixed", "world", "beam") +
      fmt::format(R"(<link name="beam"><beam elements="{}" order="{}"><centerline><line to="6 0 0"/></centerline>
        <section ea="1" ga2="1" ga3="1" gj="1" ei2="1" ei3="1" mass="1" j1="1" j2="1" j3="1"/></beam></link>)",
                  kElements, order))));
}

/// A tangent of random numbers, in which half of the diagonal blocks comes from other sources than elements, and its
/// matrix.
template <int Nodes>
class RandomTangent {
 public:
  RandomTangent() : model_(cantilever(Nodes - 1)), dof_(model_), tangent_(model_, dof_) {
    tangent_.condense_interiors();
  }

  /// Fills in a matrix that is almost symmetric and positive definite, except for one element.
  void fill(int element_without_pivots, unsigned seed) {
    test::RandomSource random(seed);
    tangent_.set_zero();
    matrix_ = Eigen::MatrixXd::Zero(6 * dof_.node_count, 6 * dof_.node_count);
    int e = 0;
    for_each_element(model_.beams, [&](const auto& element) {
      if constexpr (std::decay_t<decltype(element)>::kNodes == Nodes)
        fill(element, e, e == element_without_pivots ? -1.0 : 1.0, random);
      ++e;
    });
    EXPECT_EQ(e, kElements);
    for (int node = 0; node < dof_.node_count; ++node) {
      Matrix6 diagonal;
      for (int k = 0; k < 36; ++k) diagonal.data()[k] = random.number();
      tangent_.add_to_node(node, diagonal);
      matrix_.block<6, 6>(6 * node, 6 * node) += diagonal;
    }
  }

  /// Checks solutions with new and with kept factors, to within round-off.
  void expect_solutions() {
    const int size = dof_.unknowns, held = 6;  // the clamped node is the first one
    const Eigen::MatrixXd a = matrix_.bottomRightCorner(size, size);
    ASSERT_EQ(size + held, matrix_.rows());
    const double condition = a.norm() * test::solution(a, Eigen::MatrixXd::Identity(size, size)).norm();
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(size, -1, 2 + repeat);
      Eigen::VectorXd x = b;
      ASSERT_TRUE(repeat == 0 ? tangent_.factorise_and_solve(x) : tangent_.solve(x));
      const double round_off = condition * std::numeric_limits<double>::epsilon();
      EXPECT_LE((a * x - b).norm(), round_off * (a.norm() * x.norm() + b.norm()));
    }
  }

  /// Returns the number of elements that are condensed.
  int condensed() {
    int count = 0;
    TreeBlocks blocks(model_, dof_);
    for (int part = 0; part < kElements; ++part)
      count += tangent_.condensation()->prepare(part, blocks, nullptr) != nullptr;
    return count;
  }

  /// Factorises with one bad number in a block between the ends of an element.
  bool factorises_with(double number, int lane) {
    tangent_.condensation()->template system<Nodes>(0).tangent[1][0](2, 3).set(lane, number);
    return tangent_.factorise();
  }

 private:
  template <class Element>
  void fill(const Element& element, int e, double sign, test::RandomSource& random) {
    Eigen::MatrixXd own(6 * Nodes, 6 * Nodes);
    for (int k = 0; k < own.size(); ++k) own.data()[k] = random.number();
    own = sign * (own * own.transpose() + 12 * Eigen::MatrixXd::Identity(own.rows(), own.cols())) +
          0.5 * (own - own.transpose());
    auto& blocks = tangent_.condensation()->template system<Nodes>(e / Pack::kLanes).tangent;
    for (int i = 0; i < Nodes; ++i)
      for (int j = 0; j < Nodes; ++j) {
        const Matrix6 block = own.block<6, 6>(6 * i, 6 * j);
        for (int lane = e % Pack::kLanes; lane < Pack::kLanes; ++lane) set_lane(blocks[i][j], lane, block);
        matrix_.block<6, 6>(6 * element.nodes[i], 6 * element.nodes[j]) += block;
      }
  }

  Model model_;
  DegreesOfFreedom dof_;
  TreeTangent tangent_;
  Eigen::MatrixXd matrix_;
};

template <class Of>
class InteriorCondensationOf : public ::testing::Test {};
using NodeCounts =
    ::testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>, std::integral_constant<int, 5>>;
TYPED_TEST_SUITE(InteriorCondensationOf, NodeCounts);

TYPED_TEST(InteriorCondensationOf, SolvesWithTheMatrixOfTheWhole) {
  RandomTangent<TypeParam::value> tangent;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    tangent.fill(-1, seed);
    tangent.expect_solutions();
    EXPECT_EQ(tangent.condensed(), kElements);
  }
}

// Such an element and the others in its pack are left whole. The elements are tried one after the other, so that a pack
// that was left whole is condensed again.
TYPED_TEST(InteriorCondensationOf, LeavesElementsWholeThatWantASearchForPivots) {
  RandomTangent<TypeParam::value> tangent;
  for (int element = 0; element < kElements; ++element) {
    tangent.fill(element, 10 + element);
    tangent.expect_solutions();
    EXPECT_EQ(tangent.condensed(), element < Pack::kLanes ? kElements - Pack::kLanes : Pack::kLanes);
  }
}

TYPED_TEST(InteriorCondensationOf, RefusesWhatIsNotFinite) {
  RandomTangent<TypeParam::value> tangent;
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    tangent.fill(-1, 1);
    EXPECT_FALSE(tangent.factorises_with(number, 2));
  }
  tangent.fill(-1, 1);
  tangent.expect_solutions();
}

}  // namespace
}  // namespace flexarm
