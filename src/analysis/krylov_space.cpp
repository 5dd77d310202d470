#include "analysis/krylov_space.h"

#include <cassert>
#include <cmath>
#include <stdexcept>

#include "analysis/largest_eigenpairs.h"

namespace flexarm {

KrylovSpace::KrylovSpace(const LinearOperation& operation, Eigen::Index most)
    : operation_(operation),
      basis_(operation.rows(), most + kBlock),
      coefficients_(Eigen::MatrixXd::Zero(most + kBlock, most)) {
  assert(most + kBlock <= operation.rows());
  for (Eigen::Index k = 0; k < kBlock; ++k) add_random_vector();
}

void KrylovSpace::grow(Eigen::Index size) {
  assert(size <= coefficients_.cols());
  Eigen::VectorXd image(basis_.rows());
  for (; size_ < size; ++size_) {
    operation_.apply(basis_.col(size_).data(), image.data());
    const double whole = image.norm();
    if (!std::isfinite(whole)) throw std::runtime_error("a vector of the eigenvalue iteration is not finite");
    coefficients_.col(size_).head(vectors_) = take_off_basis(image);
    const double rest = image.norm();
    // A remainder of round-off is no direction: the space already contains all images of this vector. Continue with
    // another one.
    if (rest <= 1e-14 * whole) {
      add_random_vector();
    } else {
      coefficients_(vectors_, size_) = rest;
      basis_.col(vectors_++) = image / rest;
    }
  }
}

void KrylovSpace::add_random_vector() {
  Eigen::VectorXd vector(basis_.rows());
  for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] = random_() / double(std::mt19937::max()) - 0.5;
  take_off_basis(vector);
  basis_.col(vectors_++) = vector.normalized();
}

/// Removes from `vector` its parts along the basis, and returns them. Two passes are enough for orthogonality to
/// round-off (Giraud, Langou, Rozloznik and van den Eshof, 2005).
Eigen::VectorXd KrylovSpace::take_off_basis(Eigen::VectorXd& vector) const {
  const auto vectors = basis_.leftCols(vectors_);
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(vectors_);
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd part = vectors.transpose() * vector;
    vector.noalias() -= vectors * part;
    parts += part;
  }
  return parts;
}

}  // namespace flexarm
