#include "flexarm/simulation/linear_reduction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "math/gramians.h"
#include "math/invariant_subspace.h"
#include "math/least_squares.h"
#include "math/singular_values.h"
#include "simulation/linear_scaling.h"

namespace flexarm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Poles decay if their real part is below -kDecaying times the largest |pole|. Slower ones are doubtful: every free
/// motion has a double pole at 0, which round-off splits by as much.
const double kDecaying = std::sqrt(std::numeric_limits<double>::epsilon());
/// If all poles have larger damping ratios than this one, and none is 0 within round-off, all of them decay.
constexpr double kDamped = 1e-6;

/// The invariant subspace of some poles: x = basis z, z = projection x.
struct Part {
  MatrixXd basis, projection;
};

struct Parts {
  Part kept, decaying;
};

/// `zero`: see ScaledStates. `slowest`: poles that decay faster than this are not doubtful [1/s].
Parts parts_of(const MatrixXd& a, double zero, double slowest) {
  const auto decays = [&](std::complex<double> pole) {
    const double size = std::abs(pole);
    return pole.real() < -slowest || (size > zero && pole.real() < -kDamped * size);
  };
  Parts parts;
  parts.kept.basis = invariant_subspace(a, [&](std::complex<double> pole) { return !decays(pole); });
  if (parts.kept.basis.cols() == 0) {  // the scaled states themselves, since other coordinates would cost digits
    parts.kept.projection = MatrixXd(0, a.rows());
    parts.decaying.basis = parts.decaying.projection = MatrixXd::Identity(a.rows(), a.cols());
    return parts;
  }
  parts.decaying.basis = invariant_subspace(a, decays);
  MatrixXd both(a.rows(), a.cols());
  both << parts.kept.basis, parts.decaying.basis;
  const MatrixXd inverse = square_solution(both, MatrixXd::Identity(a.rows(), a.cols()));
  parts.kept.projection = inverse.topRows(parts.kept.basis.cols());
  parts.decaying.projection = inverse.bottomRows(parts.decaying.basis.cols());
  return parts;
}

/// Hankel singular values below this part of the largest are round-off: inputs do not reach these states, or outputs do
/// not see them.
constexpr double kSeen = 1e-14;

struct BalancedPart {
  GramianRoots roots;
  SingularValues hankel;
  Index seen = 0;  ///< number of singular values above round-off
};

BalancedPart balance(const Part& part, const MatrixXd& a, const MatrixXd& b, const MatrixXd& c) {
  BalancedPart out;
  if (part.basis.cols() == 0) return out;
  out.roots = gramian_roots(part.projection * a * part.basis, part.projection * b, c * part.basis);
  out.hankel = singular_values(out.roots.seen * out.roots.reached);
  const VectorXd& values = out.hankel.values;
  if (values.size() > 0) out.seen = (values.array() > kSeen * values[0]).count();
  return out;
}

/// The `order` states of the part that inputs reach and outputs see most.
Part truncated(const Part& part, const BalancedPart& balanced, Index order) {
  if (order == 0) return {MatrixXd(part.basis.rows(), 0), MatrixXd(0, part.basis.rows())};
  const auto& [roots, hankel, seen] = balanced;
  const VectorXd scales = hankel.values.head(order).cwiseSqrt().cwiseInverse();
  return {part.basis * (roots.reached * hankel.right.leftCols(order)) * scales.asDiagonal(),
          scales.asDiagonal() * (hankel.left.leftCols(order).transpose() * roots.seen) * part.projection};
}

}  // namespace

ReducedModel reduced(const LinearModel& model, int order) {
  const ScaledStates scaled = scaled_states(model);
  double largest = 0;
  bool all_decay = true;
  for (const Pole& pole : poles(model)) {
    largest = std::max(largest, std::abs(pole.value));
    all_decay = all_decay && std::abs(pole.value) > scaled.zero && pole.damping_ratio() > kDamped;
  }
  const auto [kept, decaying] =
      parts_of(scaled.a, all_decay ? scaled.zero : std::numeric_limits<double>::infinity(), kDecaying * largest);
  if (order < kept.basis.cols() || order > model.a.rows())
    throw std::invalid_argument(
        fmt::format("a reduced model has {} to {} states, {} of them of poles that do not decay; got {}",
                    kept.basis.cols(), model.a.rows(), kept.basis.cols(), order));
  const BalancedPart rest = balance(decaying, scaled.a, scaled.b, scaled.c);
  const Index more = std::min<Index>(order - kept.basis.cols(), rest.seen);
  const Part best = truncated(decaying, rest, more);

  MatrixXd basis(model.a.rows(), kept.basis.cols() + more), projection(basis.cols(), basis.rows());
  basis << kept.basis, best.basis;
  projection << kept.projection, best.projection;
  ReducedModel out{model, rest.hankel.values, static_cast<int>(kept.basis.cols())};
  out.model.a = projection * scaled.a * basis;
  out.model.b = projection * scaled.b;
  out.model.c = scaled.c * basis;
  out.model.drift = projection * (scaled.inverse * model.drift);
  out.model.positions = static_cast<int>(basis.cols());
  out.model.states.clear();
  for (Index i = 0; i < basis.cols(); ++i) out.model.states.push_back(fmt::format("reduced:{}", i));
  return out;
}

}  // namespace flexarm
