#pragma once
/// What every beam kernel must satisfy.

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"

namespace flexarm::test {

/// The number of nodes as a type, for typed tests.
template <int N>
struct NodeCount {
  static constexpr int value = N;
};
using NodeCounts = ::testing::Types<NodeCount<2>, NodeCount<3>, NodeCount<4>, NodeCount<5>>;

/// Compares the tangent of kernel(nodes, with_tangent) -> ElementSystem with differences of its residual. `size`: over
/// what increment the residual changes its shape; the differences' step follows it, their round-off grows inversely.
template <int Nodes, class Kernel>
void expect_consistent_tangent(const RandomStep<Nodes>& step, const Kernel& kernel, double size = 1) {
  const ElementSystem<Nodes> system = kernel(step.nodes, true);
  EXPECT_LE(largest(kernel(step.nodes, false).residual - system.residual),
            1e-13 * largest(system.residual));  // the same without a tangent
  const double scale = std::max(largest(system.tangent), largest(system.residual));
  for (int column = 0; column < 6 * Nodes; ++column) {
    const Eigen::Matrix<double, 6 * Nodes, 1> expected =
        difference([&](double h) { return kernel(step.perturbed(column, h), false).residual; }, difference_step * size);
    EXPECT_LE(largest(system.tangent.col(column) - expected), difference_tolerance / size * scale)
        << "column " << column;
  }
}

}  // namespace flexarm::test
