#pragma once
/// Sparse LU factorisation of the reduced tangent by KLU, with reuse of the symbolic analysis and the pivots.

#include <vector>

#include <Eigen/Core>

#include <klu.h>

namespace flexarm {

/// Solves A x = b for a sparsity pattern that seldom changes. After the first factorisation it allocates memory only
/// for a new pattern, or if the reused pivot order is inaccurate and a new one is chosen.
class LinearSolver {
 public:
  /// The matrix's pattern in compressed columns, as pattern number 0. Both vectors must outlive the solver.
  LinearSolver(int unknowns, const std::vector<int>& column_starts, const std::vector<int>& row_indices);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Factorises the values. Returns false if the matrix is singular or not finite. `pattern`: a number that changes
  /// when the contents of the constructor's vectors change.
  bool factorise(const std::vector<double>& values, int pattern = 0);
  /// Replaces b by x, with the factors of the last factorise(). At the first solve after it, its values must still
  /// exist unchanged. Returns false if the result is not finite.
  bool solve(Eigen::VectorXd& b);

  int factorisations() const { return factorisations_; }

 private:
  void analyse();
  bool factorise_anew();
  bool solve_once(Eigen::VectorXd& b);
  double backward_error(const Eigen::VectorXd& x);

  int unknowns_, pattern_ = 0;
  const std::vector<int>& column_starts_;
  const std::vector<int>& row_indices_;
  const std::vector<double>* values_ = nullptr;
  klu_common common_;
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
  bool unchecked_pivots_ = false;  ///< factorised with old pivots whose accuracy has not been checked yet
  int factorisations_ = 0;
  Eigen::VectorXd right_hand_side_, residual_;
};

}  // namespace flexarm
