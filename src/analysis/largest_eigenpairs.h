#pragma once
/// The largest eigenvalues of a linear operation, in a file of their own because the solvers take long to compile.

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

struct Eigenpair {
  std::complex<double> value;
  Eigen::VectorXcd vector;
};

/// A real square matrix, of which only products with vectors are known.
class LinearOperation {
 public:
  virtual ~LinearOperation() = default;
  virtual Eigen::Index rows() const = 0;
  /// Both have rows() numbers.
  virtual void apply(const double* in, double* out) const = 0;
};

/// What the iteration does where eigenvalues crowd so that it cannot tell them apart.
enum class Crowded {
  Fail,
  LeaveOut  ///< of the `count` those that have not converged
};

/// The `count` eigenpairs of largest magnitude, largest first. `is_small`: all are computed, by a dense solver.
/// @throws std::runtime_error if the iteration does not converge.
std::vector<Eigenpair> largest_eigenpairs(const LinearOperation& operation, int count, bool is_small, Crowded crowded);

}  // namespace flexarm
