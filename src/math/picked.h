#pragma once
/// Selects rows, columns and parts of matrices by lists of indices. Eigen itself can do this from version 3.4 on.

#include <vector>

#include <Eigen/Core>

namespace flexarm {

/// Returns out with out.row(k) = matrix.row(rows[k]). For a column vector, selects entries.
template <class Matrix, class Place>
auto picked_rows(const Eigen::MatrixBase<Matrix>& matrix, const std::vector<Place>& rows) {
  Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, Matrix::ColsAtCompileTime> out(rows.size(), matrix.cols());
  if (out.size() == 0) return out;  // a matrix without columns has no memory in which a row could be
  for (std::size_t k = 0; k < rows.size(); ++k) out.row(k) = matrix.row(rows[k]);
  return out;
}

/// Returns out with out.col(k) = matrix.col(columns[k]). For a row vector, selects entries.
template <class Matrix, class Place>
auto picked_columns(const Eigen::MatrixBase<Matrix>& matrix, const std::vector<Place>& columns) {
  Eigen::Matrix<typename Matrix::Scalar, Matrix::RowsAtCompileTime, Eigen::Dynamic> out(matrix.rows(), columns.size());
  if (out.size() == 0) return out;
  for (std::size_t k = 0; k < columns.size(); ++k) out.col(k) = matrix.col(columns[k]);
  return out;
}

/// Returns out with out(i, k) = matrix(rows[i], columns[k]).
template <class Matrix, class Place>
auto picked(const Eigen::MatrixBase<Matrix>& matrix, const std::vector<Place>& rows,
            const std::vector<Place>& columns) {
  return picked_columns(picked_rows(matrix, rows), columns);
}

/// Does to.row(rows[k]) += what.row(k) for all k.
template <class To, class What, class Place>
void add_to_rows(Eigen::MatrixBase<To>& to, const std::vector<Place>& rows, const Eigen::MatrixBase<What>& what) {
  if (what.size() == 0) return;
  for (std::size_t k = 0; k < rows.size(); ++k) to.row(rows[k]) += what.row(k);
}

}  // namespace flexarm
