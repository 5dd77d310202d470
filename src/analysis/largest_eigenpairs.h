#pragma once
/// The largest eigenvalues of a linear operation. They are in a file of their own since the solvers take long to
/// compile.

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace flexarm {

struct Eigenpair {
  std::complex<double> value;
  Eigen::VectorXcd vector;
};

/// A real square matrix of which only products with vectors are available.
class LinearOperation {
 public:
  virtual ~LinearOperation() = default;
  virtual Eigen::Index rows() const = 0;
  /// `in` and `out` have rows() numbers each.
  virtual void apply(const double* in, double* out) const = 0;
};

/// What the iteration does if eigenvalues are so close to each other that it cannot separate them.
enum class Crowded {
  Fail,
  LeaveOut  ///< returns fewer pairs, without those that have not converged
};

/// The `count` eigenpairs of largest magnitude, largest first. `is_small`: compute all of them, by a dense solver.
/// @throws std::runtime_error if the iteration does not converge.
std::vector<Eigenpair> largest_eigenpairs(const LinearOperation& operation, int count, bool is_small, Crowded crowded);

}  // namespace flexarm
