#include "analysis/eigenpairs.h"

#include <cassert>
#include <stdexcept>

#include "analysis/largest_eigenpairs.h"
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
  mutable LinearSolver solver_;  // mutable because of its scratch memory
  std::vector<double> values_;
};

/// x -> (K + shift M)^-1 M x, whose eigenvalues are 1/(mu + shift).
class UndampedOperation : public LinearOperation {
 public:
  UndampedOperation(const LinearisedMotion& motion, double shift) : motion_(motion), solver_(motion, 0, shift) {}
  Eigen::Index rows() const override { return motion_.unknowns(); }
  void apply(const double* x, double* y) const override {
    Eigen::VectorXd::Map(y, rows()) = solver_.solve(motion_.mass() * Eigen::VectorXd::Map(x, rows()));
  }

 private:
  const LinearisedMotion& motion_;
  ShiftedSolver solver_;
};

/// Makes the problem linear by a second unknown z = lambda x / s. The operation {x, z} -> {p, q} is (K + s D + s^2 M) p
/// = -(s D + s^2 M) x - s^2 M z,  q = x + p. Its eigenvalues are 1/(lambda/s - 1). Parts of x along free motions F have
/// no effect on z, so they are dropped: p becomes p - F F^T M p. Otherwise lambda = 0 would be a multiple eigenvalue
/// with few eigenvectors, which round-off splits by its square root.
class DampedOperation : public LinearOperation {
 public:
  DampedOperation(const LinearisedMotion& motion, const Eigen::MatrixXd& free, double shift)
      : motion_(motion),
        free_(free),
        mass_free_(motion.mass() * free),
        shift_(shift),
        solver_(motion, shift, shift * shift) {}
  Eigen::Index rows() const override { return 2 * motion_.unknowns(); }
  void apply(const double* in, double* out) const override {
    const Eigen::Index n = motion_.unknowns();
    const auto x = Eigen::VectorXd::Map(in, n), z = Eigen::VectorXd::Map(in + n, n);
    auto p = Eigen::VectorXd::Map(out, n), q = Eigen::VectorXd::Map(out + n, n);
    p = -solver_.solve(shift_ * (motion_.damping() * x) + shift_ * shift_ * (motion_.mass() * (x + z)));
    q = x + p;
    p -= free_ * (mass_free_.transpose() * p);
  }
  /// The motion to which an eigenvector belongs, of any length: lambda x / s. Along free motions this is z.
  Eigen::VectorXcd motion_of(const Eigenpair& pair) const {
    const Eigen::VectorXcd x = pair.vector.head(motion_.unknowns()), z = pair.vector.tail(motion_.unknowns());
    const Eigen::VectorXcd motion = (1.0 + 1.0 / pair.value) * x + free_ * (mass_free_.transpose() * z);
    return motion.isZero(0) ? x : motion;
  }

 private:
  const LinearisedMotion& motion_;
  const Eigen::MatrixXd& free_;
  Eigen::MatrixXd mass_free_;
  double shift_;
  ShiftedSolver solver_;
};

}  // namespace

std::vector<Eigenpair> undamped_pairs(const LinearisedMotion& motion, double shift, int count) {
  assert(!(shift <= 0) && count >= 1);
  std::vector<Eigenpair> pairs =
      largest_eigenpairs(UndampedOperation(motion, shift), count, motion.unknowns() <= kDenseLimit, Crowded::Fail);
  for (Eigenpair& pair : pairs) pair.value = 1.0 / pair.value - shift;
  return pairs;
}

std::vector<Eigenpair> damped_pairs(const LinearisedMotion& motion, const Eigen::MatrixXd& free, double shift,
                                    int count) {
  assert(!(shift <= 0) && count >= 1);
  const DampedOperation operation(motion, free, shift);
  std::vector<Eigenpair> pairs =
      largest_eigenpairs(operation, count, motion.unknowns() <= kDenseLimit, Crowded::LeaveOut);
  for (Eigenpair& pair : pairs) pair = {shift * (1.0 + 1.0 / pair.value), operation.motion_of(pair)};
  return pairs;
}

}  // namespace flexarm
