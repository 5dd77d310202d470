#include "solver/linear_solver.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace flexarm {
namespace {
/// With a backward error above this, the reused pivots no longer suit the values.
constexpr double kAcceptableBackwardError = 1e-10;
}  // namespace

LinearSolver::LinearSolver(int unknowns, const std::vector<int>& column_starts, const std::vector<int>& row_indices)
    : unknowns_(unknowns),
      column_starts_(column_starts),
      row_indices_(row_indices),
      right_hand_side_(unknowns),
      residual_(unknowns) {
  klu_defaults(&common_);
  common_.scale = 2;
  analyse();
}

LinearSolver::~LinearSolver() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
}

void LinearSolver::analyse() {
  assert(unknowns_ == 0 || static_cast<int>(column_starts_.size()) == unknowns_ + 1);
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  if (unknowns_ > 0)
    symbolic_ = klu_analyze(unknowns_, const_cast<int*>(column_starts_.data()), const_cast<int*>(row_indices_.data()),
                            &common_);
}

bool LinearSolver::factorise_anew() {
  if (numeric_) klu_free_numeric(&numeric_, &common_);
  numeric_ = klu_factor(const_cast<int*>(column_starts_.data()), const_cast<int*>(row_indices_.data()),
                        const_cast<double*>(values_->data()), symbolic_, &common_);
  unchecked_pivots_ = false;
  ++factorisations_;
  return numeric_ && common_.status == KLU_OK;
}

bool LinearSolver::factorise(const std::vector<double>& values, int pattern) {
  assert(unknowns_ == 0 || values.size() == row_indices_.size());
  values_ = &values;
  if (unknowns_ == 0) return true;
  if (pattern != pattern_) {
    pattern_ = pattern;
    analyse();
  }
  if (!symbolic_) return false;
  if (!numeric_) return factorise_anew();
  ++factorisations_;
  unchecked_pivots_ = true;
  const bool done = klu_refactor(const_cast<int*>(column_starts_.data()), const_cast<int*>(row_indices_.data()),
                                 const_cast<double*>(values.data()), symbolic_, numeric_, &common_) &&
                    common_.status == KLU_OK;
  return done || factorise_anew();
}

bool LinearSolver::solve_once(Eigen::VectorXd& b) {
  return klu_solve(symbolic_, numeric_, unknowns_, 1, b.data(), &common_) && b.allFinite();
}

double LinearSolver::backward_error(const Eigen::VectorXd& x) {
  // |A x - b| relative to the largest of |b| and of the terms of A x.
  double largest = right_hand_side_.lpNorm<Eigen::Infinity>();
  residual_ = right_hand_side_;
  for (int j = 0; j < unknowns_; ++j)
    for (int p = column_starts_[j]; p < column_starts_[j + 1]; ++p) {
      const double term = (*values_)[p] * x[j];
      residual_[row_indices_[p]] -= term;
      largest = std::max(largest, std::abs(term));
    }
  return largest > 0 ? residual_.lpNorm<Eigen::Infinity>() / largest : 0.0;
}

bool LinearSolver::solve(Eigen::VectorXd& b) {
  assert(b.size() == unknowns_ && (unknowns_ == 0 || values_) && "after factorise()");
  if (unknowns_ == 0) return true;
  right_hand_side_ = b;
  const bool finite = solve_once(b);
  if (!unchecked_pivots_) return finite;
  unchecked_pivots_ = false;
  if (finite && backward_error(b) < kAcceptableBackwardError) return true;
  b = right_hand_side_;
  return factorise_anew() && solve_once(b);
}

}  // namespace flexarm
