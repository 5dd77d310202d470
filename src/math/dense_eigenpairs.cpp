#include "math/dense_eigenpairs.h"

#include <Spectra/LinAlg/UpperHessenbergEigen.h>

#include "math/hessenberg.h"

namespace flexarm {

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Hessenberg hessenberg = flexarm::hessenberg(matrix);
  Spectra::UpperHessenbergEigen<double> solver(hessenberg.reduced);
  return {solver.eigenvalues(), hessenberg.basis * solver.eigenvectors()};
}

Eigenpairs balanced_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Balanced balanced = flexarm::balanced(matrix);
  Eigenpairs pairs = dense_eigenpairs(balanced.matrix);
  pairs.vectors = balanced.scales.asDiagonal() * pairs.vectors;
  pairs.vectors.colwise().normalize();
  return pairs;
}

}  // namespace flexarm
