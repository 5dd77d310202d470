#include "flexarm/simulation/linear_reduction.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

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

/// Poles decay if their damping ratio is larger than kDamped, or their real part is below -kDecaying times the largest
/// |pole|.
constexpr double kDamped = 1e-6;
const double kDecaying = std::sqrt(std::numeric_limits<double>::epsilon());

/// The poles that do not decay, both of each conjugate pair.
struct KeptPoles {
  std::vector<std::complex<double>> zeros, others;
  double slowest = 1;  ///< the smallest |pole| that is not 0 [1/s]
  double shift = 1;    ///< a rate by which they can be shifted so that all of them decay [1/s]
  std::vector<std::complex<double>> all() const {
    std::vector<std::complex<double>> both = zeros;
    both.insert(both.end(), others.begin(), others.end());
    return both;
  }
};

KeptPoles kept_poles(const LinearModel& model) {
  const std::vector<Pole> all = poles(model);
  double largest = 0, slowest = std::numeric_limits<double>::infinity(), growth = 0;
  for (const Pole& pole : all) {
    largest = std::max(largest, std::abs(pole.value));
    if (pole.value != 0.0) slowest = std::min(slowest, std::abs(pole.value));
  }
  KeptPoles out;
  for (const Pole& pole : all) {
    if (pole.damping_ratio() > kDamped || pole.value.real() < -kDecaying * largest) continue;
    growth = std::max(growth, pole.value.real());
    (pole.value == 0.0 ? out.zeros : out.others).push_back(pole.value);
    if (pole.value.imag() != 0) out.others.push_back(std::conj(pole.value));
  }
  if (std::isfinite(slowest)) out.slowest = slowest;
  out.shift = growth + out.slowest;
  return out;
}

/// The invariant subspace of some poles: x = basis z, z = projection x.
struct Part {
  MatrixXd basis, projection;
  Index size() const { return basis.cols(); }
  MatrixXd matrix(const MatrixXd& a) const { return projection * a * basis; }
};

Part nothing_of(Index states) {
  return {MatrixXd(states, 0), MatrixXd(0, states)};
}

/// Splits a part into that of these poles and that of its other ones.
std::pair<Part, Part> split(const Part& whole, const MatrixXd& a, const std::vector<std::complex<double>>& wanted) {
  // The part itself where nothing is split, since other coordinates would cost digits.
  if (wanted.empty()) return {nothing_of(a.rows()), whole};
  if (static_cast<Index>(wanted.size()) == whole.size()) return {whole, nothing_of(a.rows())};
  const auto [first, second] = invariant_subspaces(whole.matrix(a), wanted);
  MatrixXd both(whole.size(), whole.size());
  both << first, second;
  const MatrixXd inverse = square_solution(both, whole.projection);
  return {{whole.basis * first, inverse.topRows(first.cols())},
          {whole.basis * second, inverse.bottomRows(second.cols())}};
}

/// Hankel singular values below these parts of the largest are round-off: inputs do not reach these states, or outputs
/// do not see them. Poles that do not decay have more of it, since round-off couples multiple ones.
constexpr double kSeen = 1e-14, kSeenOfKept = 1e-10;

struct BalancedPart {
  GramianRoots roots;
  SingularValues hankel;
  Index seen = 0;  ///< number of singular values above round-off
};

/// Balances a part whose poles are shifted to the left, which changes none of the states that are reached or seen.
BalancedPart balance(const Part& part, const ScaledStates& scaled, double shift, double least) {
  BalancedPart out;
  if (part.size() == 0) return out;
  out.roots = gramian_roots(part.matrix(scaled.a) - shift * MatrixXd::Identity(part.size(), part.size()),
                            part.projection * scaled.b, scaled.c * part.basis);
  out.hankel = singular_values(out.roots.seen * out.roots.reached);
  const VectorXd& values = out.hankel.values;
  if (values.size() > 0) out.seen = (values.array() > least * values[0]).count();
  return out;
}

/// The `order` states of the part that inputs reach and outputs see most.
Part truncated(const Part& part, const BalancedPart& balanced, Index order) {
  if (order == 0) return nothing_of(part.basis.rows());
  const auto& [roots, hankel, seen] = balanced;
  const VectorXd scales = hankel.values.head(order).cwiseSqrt().cwiseInverse();
  return {part.basis * (roots.reached * hankel.right.leftCols(order)) * scales.asDiagonal(),
          scales.asDiagonal() * (hankel.left.leftCols(order).transpose() * roots.seen) * part.projection};
}

/// The states of a part that inputs reach and outputs see. Its poles do not decay.
Part seen_part(const Part& part, const ScaledStates& scaled, double shift) {
  const BalancedPart balanced = balance(part, scaled, shift, kSeenOfKept);
  return truncated(part, balanced, balanced.seen);
}

/// A rate below this part of the slowest other pole is round-off.
constexpr double kNoMotion = 1e-6;

/// Turns the states of a part whose poles are 0, so that its matrix is zero on and below the diagonal but for
/// round-off: first come states that stand still, then those that move these, and so on.
Part still_part(Part part, const MatrixXd& a, double slowest) {
  for (Index first = 0; first < part.size();) {
    const Index size = part.size() - first;
    const SingularValues values = singular_values(part.projection.bottomRows(size) * a * part.basis.rightCols(size));
    const Index moving = (values.values.array() > kNoMotion * slowest).count();
    if (moving == size) break;
    MatrixXd turn(size, size);
    turn << values.right.rightCols(size - moving), values.right.leftCols(moving);
    part.basis.rightCols(size) = (part.basis.rightCols(size) * turn).eval();
    part.projection.bottomRows(size) = (turn.transpose() * part.projection.bottomRows(size)).eval();
    first += size - moving;
  }
  return part;
}

/// The model of these parts side by side, which round-off does not couple.
LinearModel joined(const LinearModel& model, const ScaledStates& scaled, const std::vector<Part>& parts) {
  Index size = 0;
  for (const Part& part : parts) size += part.size();
  LinearModel out = model;
  out.a = MatrixXd::Zero(size, size);
  out.b.resize(size, model.b.cols());
  out.c.resize(model.c.rows(), size);
  out.drift.resize(size);
  out.positions = static_cast<int>(size);
  out.states.clear();
  for (Index i = 0; i < size; ++i) out.states.push_back(fmt::format("reduced:{}", i));
  Index first = 0;
  for (const Part& part : parts) {
    out.a.block(first, first, part.size(), part.size()) = part.matrix(scaled.a);
    out.b.middleRows(first, part.size()) = part.projection * scaled.b;
    out.c.middleCols(first, part.size()) = scaled.c * part.basis;
    out.drift.segment(first, part.size()) = part.projection * (scaled.inverse * model.drift);
    first += part.size();
  }
  return out;
}

}  // namespace

ReducedModel reduced(const LinearModel& model, int order) {
  const ScaledStates scaled = scaled_states(model);
  const KeptPoles poles = kept_poles(model);
  const Part whole{MatrixXd::Identity(model.a.rows(), model.a.rows()),
                   MatrixXd::Identity(model.a.rows(), model.a.rows())};
  const auto [kept, decaying] = split(whole, scaled.a, poles.all());
  const auto [zero, lasting] = split(kept, scaled.a, poles.zeros);
  const Part still = still_part(seen_part(zero, scaled, poles.slowest), scaled.a, poles.slowest);
  const Part swinging = seen_part(lasting, scaled, poles.shift);
  const Index least = still.size() + swinging.size();
  if (order < least || order > model.a.rows())
    throw std::invalid_argument(fmt::format(
        "a reduced model has {} to {} states, {} of them of poles that do not decay and that the inputs move; got {}",
        least, model.a.rows(), least, order));
  const BalancedPart rest = balance(decaying, scaled, 0, kSeen);
  const Part best = truncated(decaying, rest, std::min<Index>(order - least, rest.seen));
  ReducedModel out{joined(model, scaled, {still, swinging, best}), rest.hankel.values, static_cast<int>(least)};
  out.model.a.topLeftCorner(still.size(), still.size()).triangularView<Eigen::Lower>().setZero();
  return out;
}

}  // namespace flexarm
