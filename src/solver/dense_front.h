#pragma once
/// A dense front of the block elimination, with arbitrary variables: folds slaves, eliminates with partial pivoting.

#include <vector>

#include "solver/front_lanes.h"

namespace flexarm {

/// A square matrix, stored by rows. Its rows and columns are scalars of the mechanism (indices of DegreesOfFreedom).
/// The order is: variables that may be eliminated; variables that ride along for later fronts; variables that are
/// folded.
///
/// The loops are compiled by simd::run().
class DenseFront {
 public:
  /// Scalars of the rows and columns. They differ after off-diagonal pivots of earlier fronts. To be filled before
  /// start().
  std::vector<int> rows, columns;
  /// `scalar_count`: number of scalars in the mechanism.
  explicit DenseFront(int scalar_count) : row_place_(scalar_count, -1), column_place_(scalar_count, -1) {}

  /// Reserves memory for fronts of this size.
  void reserve(int size);
  void clear();
  /// Sets the matrix of these rows and columns to zero. `active`: number of rows that are not folded.
  void start(int active);
  int size() const { return static_cast<int>(rows.size()); }
  int active() const { return active_; }
  int stride() const { return stride_; }
  double* row(int i) { return numbers(values_) + static_cast<std::size_t>(stride_) * i; }
  /// Place of a scalar in the front; -1 if the front does not contain it.
  int row_place(int scalar) const { return row_place_[scalar]; }
  int column_place(int scalar) const { return column_place_[scalar]; }

  /// Adds a column-major matrix, whose columns are `distance` apart in memory. It goes to the rows from the scalar
  /// `row` on and the columns from the scalar `column` on, which are contiguous in the front.
  void add(int row, int column, const double* values, int row_count, int column_count, int distance);

  /// Folds a slave: columns d(scalars `slave` ... slave + count - 1) = right d(targets), then rows of targets += left^T
  /// (rows of the slave). `left`, `right`: count rows of `target_count` values, `distance` apart; `targets`: scalars of
  /// the front.
  void fold(int slave, int count, const double* left, const double* right, int distance, const int* targets,
            int target_count);
  /// Sets the row of a scalar to zero.
  void clear_row(int scalar);

  /// Eliminates among the first `candidates` rows and columns. First the certain ones, in groups that end at the given
  /// indices; each group searches pivots in its own rows. Then those of the others whose pivots are sufficiently large
  /// relative to the rest of their columns; with `all`, every one of them. Eliminated rows and columns are moved to the
  /// beginning, and their rows become rows of U, from the diagonal on. The rest becomes the Schur complement. Returns
  /// the number of pivots, or -1 if a pivot that must be taken has no correct digits.
  int eliminate(int candidates, const std::vector<int>& certain, bool all);
  /// Column k of L below the diagonal, and the reciprocal of pivot k.
  const double* lower(int k) const { return numbers(lower_) + static_cast<std::size_t>(lower_stride()) * k; }
  double reciprocal(int k) const { return reciprocals_[k]; }

 private:
  /// Includes padding: vectors that start at the first row of a border may extend beyond the last row.
  int lower_stride() const { return stride_ + 4; }

  int active_ = 0, stride_ = 0;
  FrontMemory values_, lower_, right_, column_sizes_;
  std::vector<double> scales_, reciprocals_;
  std::vector<int> row_place_, column_place_;
};

}  // namespace flexarm
