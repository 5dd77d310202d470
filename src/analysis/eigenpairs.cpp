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
/// = -(s D + s^2 M) x - s^2 M z,  q = x + p. Its eigenvalues are 1/(lambda/s - 1).
class DampedOperation : public LinearOperation {
 public:
  DampedOperation(const LinearisedMotion& motion, double shift)
      : motion_(motion), shift_(shift), solver_(motion, shift, shift * shift) {}
  Eigen::Index rows() const override { return 2 * motion_.unknowns(); }
  void apply(const double* in, double* out) const override {
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

}  // namespace

std::vector<Eigenpair> undamped_pairs(const LinearisedMotion& motion, double shift, int count) {
  assert(!(shift <= 0) && count >= 1);
  std::vector<Eigenpair> pairs =
      largest_eigenpairs(UndampedOperation(motion, shift), count, motion.unknowns() <= kDenseLimit, Crowded::Fail);
  for (Eigenpair& pair : pairs) pair.value = 1.0 / pair.value - shift;
  return pairs;
}

std::vector<Eigenpair> damped_pairs(const LinearisedMotion& motion, double shift, int count) {
  assert(!(shift <= 0) && count >= 1);
  std::vector<Eigenpair> pairs =
      largest_eigenpairs(DampedOperation(motion, shift), count, motion.unknowns() <= kDenseLimit, Crowded::LeaveOut);
  for (Eigenpair& pair : pairs) pair = {shift * (1.0 + 1.0 / pair.value), pair.vector.head(motion.unknowns())};
  return pairs;
}

}  // namespace flexarm
