#include "analysis/largest_eigenpairs.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "analysis/krylov_space.h"
#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

/// Dense matrices of more rows would take minutes.
constexpr Eigen::Index kMostRows = 1000;
/// Largest residual of a converged pair, relative to its value.
constexpr double kAccuracy = 1e-13;

Eigenpairs all_pairs(const LinearOperation& operation) {
  const Eigen::Index n = operation.rows();
  Eigen::MatrixXd dense(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
    operation.apply(unit.data(), dense.col(j).data());
  }
  return dense_eigenpairs(dense);
}

/// The first `count` pairs of `pairs`, largest first.
Eigenpairs largest(const Eigenpairs& pairs, int count) {
  std::vector<Eigen::Index> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&pairs](Eigen::Index a, Eigen::Index b) {
    return std::abs(pairs.values[a]) > std::abs(pairs.values[b]);
  });
  order.resize(std::min<std::size_t>(order.size(), count));
  Eigenpairs out{Eigen::VectorXcd(order.size()), Eigen::MatrixXcd(pairs.vectors.rows(), order.size())};
  for (std::size_t k = 0; k < order.size(); ++k) {
    out.values[k] = pairs.values[order[k]];
    out.vectors.col(k) = pairs.vectors.col(order[k]);
  }
  return out;
}

/// At most `count` eigenpairs in the space: those that are pairs of the operation itself, to round-off.
Eigenpairs converged_pairs(const KrylovSpace& space, int count) {
  const Eigen::Index size = space.size();
  const Eigenpairs ritz = largest(dense_eigenpairs(space.coefficients().topRows(size)), count);
  Eigenpairs out{Eigen::VectorXcd(ritz.values.size()), Eigen::MatrixXcd(space.basis().rows(), ritz.values.size())};
  Eigen::Index found = 0;
  for (Eigen::Index k = 0; k < ritz.values.size(); ++k) {
    // The residual is the part that leaves the space.
    const Eigen::VectorXcd rest = space.coefficients().bottomRows(KrylovSpace::kBlock) * ritz.vectors.col(k);
    if (!(rest.norm() <= kAccuracy * std::abs(ritz.values[k]))) continue;
    out.values[found] = ritz.values[k];
    out.vectors.col(found++) = space.basis() * ritz.vectors.col(k);
  }
  return {out.values.head(found), out.vectors.leftCols(found)};
}

/// The largest space of the iteration. Once a space has more than half of the rows, all pairs at once take less time
/// than this and the larger ones that may follow.
Eigen::Index most_vectors(Eigen::Index rows, int count) {
  if (rows <= kMostRows) return rows / 2;
  return std::min<Eigen::Index>(rows - KrylovSpace::kBlock, 10 * count + 400);
}

Eigen::Index first_vectors(int count) {
  return 2 * count + 20;
}

/// Arnoldi's iteration without restarts. The wanted eigenvalues are well separated from the others, so that few steps
/// find them.
Eigenpairs arnoldi_pairs(const LinearOperation& operation, int count, Crowded crowded) {
  const Eigen::Index most = most_vectors(operation.rows(), count);
  KrylovSpace space(operation, most);
  for (Eigen::Index size = std::min(first_vectors(count), most);; size = std::min(size + size / 2, most)) {
    space.grow(size);
    Eigenpairs pairs = converged_pairs(space, count);
    if (pairs.values.size() == count) return pairs;
    if (size < most) continue;
    if (pairs.values.size() > 0 && crowded == Crowded::LeaveOut && operation.rows() > kMostRows) return pairs;
    throw std::runtime_error("the eigenvalue iteration did not converge");
  }
}

/// If the iteration fails, computes all pairs, provided that this takes only seconds.
Eigenpairs iterated_pairs(const LinearOperation& operation, int count, Crowded crowded) {
  try {
    return arnoldi_pairs(operation, count, crowded);
  } catch (const std::runtime_error&) {
    if (operation.rows() <= kMostRows) return largest(all_pairs(operation), count);
    throw std::runtime_error(
        fmt::format("the {} softest of {} eigenvalues are not found: Arnoldi's iteration does not converge", count,
                    operation.rows()));
  }
}

}  // namespace

std::vector<Eigenpair> largest_eigenpairs(const LinearOperation& operation, int count, bool is_small, Crowded crowded) {
  assert(count >= 1);
  const Eigen::Index rows = operation.rows();
  const bool takes_all = is_small || 2 * count + KrylovSpace::kBlock >= rows ||
                         (rows <= kMostRows && first_vectors(count) > most_vectors(rows, count));
  const auto [values, vectors] =
      takes_all ? largest(all_pairs(operation), count) : iterated_pairs(operation, count, crowded);
  std::vector<Eigenpair> pairs;
  pairs.reserve(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) pairs.push_back({values[k], vectors.col(k)});
  return pairs;
}

}  // namespace flexarm
