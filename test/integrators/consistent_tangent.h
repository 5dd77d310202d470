#pragma once
/// Compares the tangent of a whole step with differences of its residual.

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "integrators/step_system.h"
#include "solver/sparse_tangent.h"

namespace flexarm::test {

/// The tangent of a system that was made with BackendChoice::Matrix.
inline const SparseTangent& matrix_of(const StepSystem& system) {
  return system.tangent().matrix();
}

inline Eigen::MatrixXd dense(const SparseTangent& assembler) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(assembler.unknowns(), assembler.unknowns());
  for (int column = 0; column < assembler.unknowns(); ++column)
    for (int p = assembler.column_starts()[column]; p < assembler.column_starts()[column + 1]; ++p)
      matrix(assembler.row_indices()[p], column) += assembler.values()[p];
  return matrix;
}

/// Compares every column of the tangent with differences. `size`: size of an update over which the residual stays
/// smooth; it scales the steps of the differences and the tolerance.
inline void expect_consistent_tangent(StepSystem& system, double size) {
  ASSERT_TRUE(system.evaluate(true));  // the first tangent of a step uses the strains at the beginning of the step
  ASSERT_TRUE(system.evaluate(true));
  const Eigen::MatrixXd tangent = dense(matrix_of(system));
  const double scale = std::max(largest(tangent), largest(system.residual()));
  for (int column = 0; column < tangent.cols(); ++column) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(tangent.cols(), column);
    const Eigen::VectorXd expected = difference(
        [&](double h) {
          system.update(h * unit);
          system.evaluate(false);
          const Eigen::VectorXd residual = system.residual();
          system.update(-h * unit);
          system.evaluate(false);  // undo the whole update, because the iterative interpolation depends on the path
          return residual;
        },
        difference_step * size);
    ASSERT_LE(largest(tangent.col(column) - expected), difference_tolerance / size * scale) << "unknown " << column;
  }
}

inline Eigen::VectorXd random_update(int size, RandomSource& random, double scale) {
  Eigen::VectorXd update(size);
  for (int i = 0; i < size; ++i) update[i] = scale * random.number();
  return update;
}

}  // namespace flexarm::test
