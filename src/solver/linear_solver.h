#pragma once
/// Sparse LU of the reduced tangent: KLU with one symbolic analysis.

#include <vector>

#include <Eigen/Core>

#include <klu.h>

namespace flexarm {

/// Solves A x = b for a sparsity pattern that seldom changes. After the first factorisation nothing allocates, unless
/// the pattern is a new one, or the reused pivot order turns out to be inaccurate and a new one is chosen.
class LinearSolver {
 public:
  /// Pattern number 0 in compressed columns; both vectors must outlive the solver.
  LinearSolver(int unknowns, const std::vector<int>& column_starts, const std::vector<int>& row_indices);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Factorises the values; false if the matrix is singular or not finite. `pattern`: a number that changes with what
  /// the vectors of the constructor contain.
  bool factorise(const std::vector<double>& values, int pattern = 0);
  /// Replaces b by x, with the factors of the last factorise(), whose values must still stand at the first solve after
  /// it. False if the result is not finite.
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
  bool unchecked_pivots_ = false;  ///< refactorised with old pivots, and not yet seen to be accurate
  int factorisations_ = 0;
  Eigen::VectorXd right_hand_side_, residual_;
};

}  // namespace flexarm
