/// Tests the properties that define Lagrange shape functions, for every number of nodes.

#include "math/shape_functions.h"
#include "math/quadrature.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/node_counts.h"

namespace flexarm {
namespace {

// Round-off of sums of at most five products, each of at most four factors below 11 in magnitude.
constexpr double shape_roundoff = 200 * std::numeric_limits<double>::epsilon();

template <typename Count>
class ShapeFunctionsTest : public ::testing::Test {};

TYPED_TEST_SUITE(ShapeFunctionsTest, test::NodeCounts);

// The nodal polynomial is orthogonal to all polynomials of degree nodes - 3. This defines the Gauss-Lobatto points.
TYPED_TEST(ShapeFunctionsTest, NodesAreTheGaussLobattoPoints) {
  constexpr int nodes = TypeParam::value;
  EXPECT_EQ(node_coordinate<nodes>(0), -1.0);
  EXPECT_EQ(node_coordinate<nodes>(nodes - 1), 1.0);
  for (int i = 1; i < nodes; ++i) EXPECT_LT(node_coordinate<nodes>(i - 1), node_coordinate<nodes>(i));
  for (int degree = 0; degree <= nodes - 3; ++degree) {
    double integral = 0;
    for (std::size_t k = 0; k < GaussLegendre<5>::points.size(); ++k) {
      const double xi = GaussLegendre<5>::points[k];
      double polynomial = std::pow(xi, degree);
      for (int i = 0; i < nodes; ++i) polynomial *= xi - node_coordinate<nodes>(i);
      integral += GaussLegendre<5>::weights[k] * polynomial;
    }
    EXPECT_NEAR(integral, 0.0, shape_roundoff);
  }
}

TYPED_TEST(ShapeFunctionsTest, EachIsOneAtItsNodeAndZeroAtTheOthers) {
  constexpr int nodes = TypeParam::value;
  for (int k = 0; k < nodes; ++k) {
    const ShapeFunctions<nodes> at_node = lagrange<nodes>(node_coordinate<nodes>(k));
    for (int i = 0; i < nodes; ++i) EXPECT_NEAR(at_node.values[i], i == k ? 1.0 : 0.0, shape_roundoff);
  }
}

TYPED_TEST(ShapeFunctionsTest, ReproducePolynomialsUpToTheirOrder) {
  constexpr int nodes = TypeParam::value;
  for (const double xi : {-1.0, -0.7, 0.0, 0.31, 1.0, 1.2}) {
    const ShapeFunctions<nodes> shape = lagrange<nodes>(xi);
    for (int degree = 0; degree < nodes; ++degree) {
      double value = 0, derivative = 0;
      for (int i = 0; i < nodes; ++i) {
        const double nodal = std::pow(node_coordinate<nodes>(i), degree);
        value += shape.values[i] * nodal;
        derivative += shape.derivatives[i] * nodal;
      }
      EXPECT_NEAR(value, std::pow(xi, degree), shape_roundoff) << "degree " << degree << " at " << xi;
      const double expected = degree == 0 ? 0.0 : degree * std::pow(xi, degree - 1);
      EXPECT_NEAR(derivative, expected, shape_roundoff) << "degree " << degree << " at " << xi;
    }
  }
}

TYPED_TEST(ShapeFunctionsTest, AreMirrorImages) {
  constexpr int nodes = TypeParam::value;
  const ShapeFunctions<nodes> right = lagrange<nodes>(0.37), left = lagrange<nodes>(-0.37);
  for (int i = 0; i < nodes; ++i) {
    EXPECT_NEAR(right.values[i], left.values[nodes - 1 - i], shape_roundoff);
    EXPECT_NEAR(right.derivatives[i], -left.derivatives[nodes - 1 - i], shape_roundoff);
  }
}

}  // namespace
}  // namespace flexarm
