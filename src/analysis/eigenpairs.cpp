#include "analysis/eigenpairs.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <Spectra/GenEigsSolver.h>
#include <Eigen/Eigenvalues>

#include "solver/linear_solver.h"

namespace flexarm {
namespace {

/// Up to this number of unknowns all eigenvalues are computed by a dense solver.
constexpr int kDenseLimit = 200;

/// x -> (K + d D + m M)^-1 x.
class ShiftedSolver {
 public:
  ShiftedSolver(const LinearisedMotion& motion, double damping_factor, double mass_factor)
      : solver_(motion.unknowns(), motion.column_starts(), motion.row_indices()),
        values_(motion.stiffness().valuePtr(), motion.stiffness().valuePtr() + motion.stiffness().nonZeros()) {
    const double *damping = motion.damping().valuePtr(), *mass = motion.mass().valuePtr();
    for (std::size_t p = 0; p < values_.size(); ++p) values_[p] += damping_factor * damping[p] + mass_factor * mass[p];
    if (!solver_.factorise(values_)) throw std::runtime_error("the shifted stiffness is singular");
  }
  Eigen::VectorXd solve(Eigen::VectorXd b) const {
    if (!solver_.solve(b)) throw std::runtime_error("the eigenvalue problem is singular");
    return b;
  }

 private:
  mutable LinearSolver solver_;  // its scratch
  std::vector<double> values_;
};

/// x -> (K + shift M)^-1 M x, whose eigenvalues are 1/(mu + shift).
class UndampedOperation {
 public:
  using Scalar = double;
  UndampedOperation(const LinearisedMotion& motion, double shift) : motion_(motion), solver_(motion, 0, shift) {}
  Eigen::Index rows() const { return motion_.unknowns(); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* x, double* y) const {
    Eigen::VectorXd::Map(y, rows()) = solver_.solve(motion_.mass() * Eigen::VectorXd::Map(x, rows()));
  }

 private:
  const LinearisedMotion& motion_;
  ShiftedSolver solver_;
};

/// The linearisation with the second unknown lambda x / s, {x, z} -> {p, q}:
/// (K + s D + s^2 M) p = -(s D + s^2 M) x - s^2 M z,  q = x + p. Its eigenvalues are 1/(lambda/s - 1).
class DampedOperation {
 public:
  using Scalar = double;
  DampedOperation(const LinearisedMotion& motion, double shift)
      : motion_(motion), shift_(shift), solver_(motion, shift, shift * shift) {}
  Eigen::Index rows() const { return 2 * motion_.unknowns(); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* in, double* out) const {
    const Eigen::Index n = motion_.unknowns();
    const auto x = Eigen::VectorXd::Map(in, n), z = Eigen::VectorXd::Map(in + n, n);
    auto p = Eigen::VectorXd::Map(out, n), q = Eigen::VectorXd::Map(out + n, n);
    p = -solver_.solve(shift_ * (motion_.damping() * x) + shift_ * shift_ * (motion_.mass() * (x + z)));
    q = x + p;
  }

 private:
  const LinearisedMotion& motion_;
  double shift_;
  ShiftedSolver solver_;
};

/// What the iteration does where eigenvalues crowd so that it cannot tell them apart.
enum class Crowded {
  Fail,
  LeaveOut  ///< of the `count` those that have not converged
};

/// The `count` eigenpairs of largest magnitude, largest first.
template <class Operation>
std::vector<Eigenpair> largest(Operation operation, int count, bool is_small, Crowded crowded) {
  const Eigen::Index n = operation.rows();
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  if (is_small || 2 * count + 2 >= n) {
    Eigen::MatrixXd dense(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
      operation.perform_op(unit.data(), dense.col(j).data());
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(dense);
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  } else {
    Spectra::GenEigsSolver<Operation> solver(operation, count, std::min<Eigen::Index>(n, std::max(2 * count + 20, 40)));
    solver.init();
    solver.compute(Spectra::SortRule::LargestMagn, crowded == Crowded::Fail ? 2000 : 200, 1e-13);
    values = solver.eigenvalues();  // that have converged
    if (values.size() == 0 || (values.size() < count && crowded == Crowded::Fail))
      throw std::runtime_error("the eigenvalue iteration did not converge");
    vectors = solver.eigenvectors();
  }
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::abs(values[a]) > std::abs(values[b]); });
  order.resize(std::min<std::size_t>(order.size(), count));
  std::vector<Eigenpair> pairs;
  pairs.reserve(order.size());
  for (const int k : order) pairs.push_back({values[k], vectors.col(k)});
  return pairs;
}

}  // namespace

std::vector<Eigenpair> undamped_pairs(const LinearisedMotion& motion, double shift, int count) {
  std::vector<Eigenpair> pairs =
      largest(UndampedOperation(motion, shift), count, motion.unknowns() <= kDenseLimit, Crowded::Fail);
  for (Eigenpair& pair : pairs) pair.value = 1.0 / pair.value - shift;
  return pairs;
}

std::vector<Eigenpair> damped_pairs(const LinearisedMotion& motion, double shift, int count) {
  std::vector<Eigenpair> pairs =
      largest(DampedOperation(motion, shift), count, motion.unknowns() <= kDenseLimit, Crowded::LeaveOut);
  for (Eigenpair& pair : pairs) pair = {shift * (1.0 + 1.0 / pair.value), pair.vector.head(motion.unknowns())};
  return pairs;
}

}  // namespace flexarm
