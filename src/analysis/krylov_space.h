#pragma once
/// A block Krylov subspace (Golub and Van Loan, Matrix Computations, section 10.3.6), for eigenvalue iterations.

#include <random>

#include <Eigen/Core>

namespace flexarm {

class LinearOperation;

/// An orthonormal basis that grows, and what the operation A does to its first k vectors V_k:
/// A V_k = V_{k + kBlock} H, with `coefficients(k)` = H, of k + kBlock rows and k columns.
class KrylovSpace {
 public:
  /// An eigenvalue that comes up to so many times is found so many times: beams with round sections have each twice.
  static constexpr Eigen::Index kBlock = 4;

  /// Begins with the same random vectors on every machine. `most`: of the sizes that it may have.
  KrylovSpace(const LinearOperation& operation, Eigen::Index most);

  /// Up to k = `size`: one product with the operation for each vector.
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
