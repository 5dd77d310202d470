// Checks of tangents for the tests of elements; see kernel_checks.h.
#include "elements/kernel_checks.h"

namespace flexarm::test {

void expect_consistent_tangent(const Eigen::MatrixXd& tangent, const Eigen::VectorXd& residual,
                               const std::function<Eigen::VectorXd(int column, double h)>& residual_at, double size) {
  const double scale = std::max(largest(tangent), largest(residual));
  for (int column = 0; column < tangent.cols(); ++column) {
    const Eigen::VectorXd expected =
        difference([&](double h) { return residual_at(column, h); }, difference_step * size);
    EXPECT_LE(largest(tangent.col(column) - expected), difference_tolerance / size * scale) << "column " << column;
  }
}

}  // namespace flexarm::test
