#pragma once
/// Square matrices in the form that makes all that is asked of them for many numbers cheap: their eigenvalues, and
/// systems of equations that differ by a multiple of the identity.

#include <complex>

#include <Eigen/Core>

namespace flexarm {

/// A = S matrix S^-1 with S of powers of two, such that rows and columns are alike (Parlett and Reinsch 1969): results
/// keep their digits where coordinates have units of very different sizes.
struct Balanced {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd scales;  ///< the diagonal of S
};
Balanced balanced(Eigen::MatrixXd matrix);

/// A = Q H Q^T, where H has one diagonal below its main one.
struct Hessenberg {
  Eigen::MatrixXd reduced, basis;
};
Hessenberg hessenberg(Eigen::MatrixXd matrix);

/// x of (shift - H) x = rights, in as many operations as H has entries for each column; not finite if the shift is an
/// eigenvalue.
Eigen::MatrixXcd shifted_solution(const Eigen::MatrixXd& reduced, std::complex<double> shift, Eigen::MatrixXcd rights);

}  // namespace flexarm
