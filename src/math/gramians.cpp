#include "math/gramians.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "math/least_squares.h"

namespace flexarm {
namespace {

/// In the worst case, an iteration halves an eigenvalue that is far from -1. So eigenvalues down to 1e-30 of the
/// largest one would converge.
constexpr int kMostSteps = 100;
/// The iteration has converged if its relative change is below kShort, and above kShorter times the previous change.
/// This is then round-off, since changes decrease quadratically.
constexpr double kShort = 1e-3, kShorter = 0.5;

/// Returns F with F^T F = [first; second]^T [first; second] and at most as many rows as columns.
Eigen::MatrixXd root_of_sum(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  Eigen::MatrixXd stacked(first.rows() + second.rows(), first.cols());
  stacked << first, second;
  return stacked.rows() > stacked.cols() ? triangular_factor(stacked) : stacked;
}

}  // namespace

GramianRoots gramian_roots(Eigen::MatrixXd a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c) {
  assert(a.rows() == a.cols() && b.rows() == a.rows() && c.cols() == a.cols());
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(a.rows(), a.cols());
  Eigen::MatrixXd reached = b.transpose(), seen = c;  // `reached` is transposed here, so that both grow by rows
  double last = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostSteps; ++n) {
    const Eigen::MatrixXd inverse = square_solution(a, identity);
    const double scale = std::sqrt(a.norm() / inverse.norm());
    const Eigen::MatrixXd next = a / (2 * scale) + inverse * (scale / 2);
    if (!next.allFinite()) break;
    const double part = 1 / std::sqrt(2 * scale);
    reached = root_of_sum(part * reached, (part * scale) * (reached * inverse.transpose()));
    seen = root_of_sum(part * seen, (part * scale) * (seen * inverse));
    const double change = (next - a).norm() / next.norm();
    a = next;
    if (change == 0 || (change < kShort && change > kShorter * last))
      return {reached.transpose() / std::sqrt(2.0), seen / std::sqrt(2.0)};
    last = change;
  }
  throw std::runtime_error("the Gramians are not found: some pole hardly decays");
}

}  // namespace flexarm
