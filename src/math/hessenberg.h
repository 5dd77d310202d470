#pragma once
/// Balancing and the Hessenberg form of square matrices. With these, eigenvalues are accurate, and systems of equations
/// with many shifts (multiples of the identity) are cheap to solve.

#include <complex>

#include <Eigen/Core>

namespace flexarm {

/// A = S matrix S^-1, with a diagonal S of powers of two such that rows and columns have similar norms (Parlett and
/// Reinsch 1969). Results are then accurate even if coordinates have units of very different sizes.
struct Balanced {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd scales;  ///< the diagonal of S
};
Balanced balanced(Eigen::MatrixXd matrix);

/// A = Q H Q^T, where H is zero below its first subdiagonal.
struct Hessenberg {
  Eigen::MatrixXd reduced, basis;  ///< H, Q
};
Hessenberg hessenberg(Eigen::MatrixXd matrix);

/// Solves (shift - H) x = rights for x, with about as many operations per column as H has entries. The result is not
/// finite if the shift is an eigenvalue of H.
Eigen::MatrixXcd shifted_solution(const Eigen::MatrixXd& reduced, std::complex<double> shift, Eigen::MatrixXcd rights);

}  // namespace flexarm
