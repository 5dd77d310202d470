#include "analysis/largest_eigenpairs.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <stdexcept>

#include <Spectra/GenEigsSolver.h>
#include <fmt/format.h>

#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

/// Dense matrices of more rows would take minutes.
constexpr Eigen::Index kMostRows = 1000;

Eigenpairs all_pairs(const LinearOperation& operation) {
  const Eigen::Index n = operation.rows();
  Eigen::MatrixXd dense(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, j);
    operation.perform_op(unit.data(), dense.col(j).data());
  }
  return dense_eigenpairs(dense);
}

Eigenpairs arnoldi_pairs(const LinearOperation& operation, int count, Crowded crowded) {
  Spectra::GenEigsSolver<const LinearOperation> solver(
      operation, count, std::min<Eigen::Index>(operation.rows(), std::max(2 * count + 20, 40)));
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, crowded == Crowded::Fail ? 2000 : 200, 1e-13);
  const Eigen::VectorXcd values = solver.eigenvalues();  // that have converged
  if (values.size() == 0 || (values.size() < count && crowded == Crowded::Fail))
    throw std::runtime_error("the eigenvalue iteration did not converge");
  return {values, solver.eigenvectors()};
}

/// Where the iteration breaks down, all of them, if that takes seconds.
Eigenpairs iterated_pairs(const LinearOperation& operation, int count, Crowded crowded) {
  try {
    return arnoldi_pairs(operation, count, crowded);
  } catch (const std::runtime_error&) {
    if (operation.rows() <= kMostRows) return all_pairs(operation);
    throw std::runtime_error(
        fmt::format("the {} softest of {} eigenvalues are not found: Arnoldi's iteration does not converge", count,
                    operation.rows()));
  }
}

}  // namespace

std::vector<Eigenpair> largest_eigenpairs(const LinearOperation& operation, int count, bool is_small, Crowded crowded) {
  assert(count >= 1);
  const auto [values, vectors] =
      is_small || 2 * count + 2 >= operation.rows() ? all_pairs(operation) : iterated_pairs(operation, count, crowded);
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&values = values](int a, int b) { return std::abs(values[a]) > std::abs(values[b]); });
  order.resize(std::min<std::size_t>(order.size(), count));
  std::vector<Eigenpair> pairs;
  pairs.reserve(order.size());
  for (const int k : order) pairs.push_back({values[k], vectors.col(k)});
  return pairs;
}

}  // namespace flexarm
