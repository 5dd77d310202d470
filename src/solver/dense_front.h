#pragma once
/// A dense front of the block elimination with any variables in it: folds slaves, eliminates with partial pivoting.

#include <vector>

#include "solver/front_lanes.h"

namespace flexarm {

/// A square matrix by rows whose rows and columns are scalars of the mechanism (indices of DegreesOfFreedom). First
/// those that may be eliminated, then those that ride along, last those that are folded into others.
///
/// The loops run through simd::run().
class DenseFront {
 public:
  /// Rows and columns, which differ where pivots off the diagonal have left others behind. To be filled, then start().
  std::vector<int> rows, columns;
  /// Of `scalar_count` scalars in all.
  explicit DenseFront(int scalar_count) : row_place_(scalar_count, -1), column_place_(scalar_count, -1) {}

  /// Room for fronts of this size.
  void reserve(int size);
  void clear();
  /// Zero matrix of the rows and columns. `active`: of them that are not folded.
  void start(int active);
  int size() const { return static_cast<int>(rows.size()); }
  int active() const { return active_; }
  int stride() const { return stride_; }
  double* row(int i) { return numbers(values_) + static_cast<std::size_t>(stride_) * i; }
  /// Place of a scalar; -1: it is not in the front.
  int row_place(int scalar) const { return row_place_[scalar]; }
  int column_place(int scalar) const { return column_place_[scalar]; }

  /// Adds a matrix, whose columns are `distance` apart, to the rows from the scalar `row` on and the columns from
  /// `column` on, which follow each other in the front.
  void add(int row, int column, const double* values, int row_count, int column_count, int distance);

  /// Columns d(scalars `slave` ... slave + count - 1) = right d(targets), rows of targets += left^T (rows of slave).
  /// `left`, `right`: count rows of `target_count` values, at the distance `distance`; `targets`: scalars of the front.
  void fold(int slave, int count, const double* left, const double* right, int distance, const int* targets,
            int target_count);
  /// Replaces the row of a scalar by zeros.
  void clear_row(int scalar);

  /// Eliminates of the first `candidates` rows and columns those that are certain, group by group up to the ends that
  /// are given: every group looks for pivots in its own rows. Then those of the others whose pivots are large enough
  /// beside the rest of their columns; `all`: every one of them. They are put first, and their rows have become those
  /// of U (from the diagonal on); the rest is the Schur complement. -1 if a pivot that must be taken has no correct
  /// digits.
  int eliminate(int candidates, const std::vector<int>& certain, bool all);
  /// Columns of L behind the diagonal, by columns, and reciprocal pivots.
  const double* lower(int k) const { return numbers(lower_) + static_cast<std::size_t>(lower_stride()) * k; }
  double reciprocal(int k) const { return reciprocals_[k]; }

 private:
  /// Vectors that begin with the first row of a border may end behind the last one.
  int lower_stride() const { return stride_ + 4; }

  int active_ = 0, stride_ = 0;
  FrontMemory values_, lower_, right_, column_sizes_;
  std::vector<double> scales_, reciprocals_;
  std::vector<int> row_place_, column_place_;
};

}  // namespace flexarm
