#pragma once
/// A block Krylov subspace (Golub and Van Loan, Matrix Computations, section 10.3.6), for eigenvalue iterations.

#include <random>

#include <Eigen/Core>

namespace flexarm {

class LinearOperation;

/// An orthonormal basis that grows, and the effect of the operation A on its first k vectors V_k: A V_k = V_{k +
/// kBlock} H, where H is coefficients(), with k + kBlock rows and k columns, and k is size().
class KrylovSpace {
 public:
  /// Eigenvalues up to this multiplicity are found completely. Beams with round sections have each eigenvalue twice.
  static constexpr Eigen::Index kBlock = 4;

  /// Begins with the same random vectors on every machine. `most`: the largest size.
  KrylovSpace(const LinearOperation& operation, Eigen::Index most);

  /// Grows to k = `size`, by one product with the operation for each vector.
  void grow(Eigen::Index size);

  Eigen::Index size() const { return size_; }
  auto basis() const { return basis_.leftCols(size_); }
  auto coefficients() const { return coefficients_.topLeftCorner(size_ + kBlock, size_); }

 private:
  void add_random_vector();
  Eigen::VectorXd take_off_basis(Eigen::VectorXd& vector) const;

  const LinearOperation& operation_;
  Eigen::MatrixXd basis_, coefficients_;
  std::mt19937 random_;
  Eigen::Index size_ = 0, vectors_ = 0;
};

}  // namespace flexarm
