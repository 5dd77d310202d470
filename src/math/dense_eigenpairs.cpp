#include "math/dense_eigenpairs.h"

#include <Spectra/LinAlg/UpperHessenbergEigen.h>

#include "math/hessenberg.h"

namespace flexarm {

Eigenpairs dense_eigenpairs(const Eigen::MatrixXd& matrix) {
  const Hessenberg hessenberg = flexarm::hessenberg(matrix);
  Spectra::UpperHessenbergEigen<double> solver(hessenberg.reduced);
  return {solver.eigenvalues(), hessenberg.basis * solver.eigenvectors()};
}

}  // namespace flexarm
