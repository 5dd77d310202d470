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

/// Poles decay if their damping ratio is larger than this, or their real part is below -kDecaying times the largest
/// |pole|.
constexpr double kDamped = 1e-6;
const double kDecaying = std::sqrt(std::numeric_limits<double>::epsilon());

/// The invariant subspace of some poles: x = basis z, z = projection x.
struct Part {
  MatrixXd basis, projection;
};

/// Groups of poles: those that are 0, those that swing or grow, and those that decay.
enum Group { kZeroPoles, kSwingingPoles, kDecayingPoles, kPoleGroups };

/// All poles, with their groups. Of a conjugate pair, only the one with imaginary part >= 0.
class GroupedPoles {
 public:
  explicit GroupedPoles(const LinearModel& model) : poles_(poles(model)) {
    for (const Pole& pole : poles_) largest_ = std::max(largest_, std::abs(pole.value));
  }
  Group group(const Pole& pole) const {
    if (pole.value == 0.0) return kZeroPoles;
    return pole.damping_ratio() > kDamped || pole.value.real() < -kDecaying * largest_ ? kDecayingPoles
                                                                                       : kSwingingPoles;
  }
  /// The group of the pole next to an eigenvalue, which may have fewer digits.
  Group group_next_to(std::complex<double> eigenvalue) const {
    const std::complex<double> upper(eigenvalue.real(), std::abs(eigenvalue.imag()));
    const auto nearer = [&](const Pole& one, const Pole& other) {
      return std::abs(one.value - upper) < std::abs(other.value - upper);
    };
    return group(*std::min_element(poles_.begin(), poles_.end(), nearer));
  }
  bool all_decay() const {
    return std::all_of(poles_.begin(), poles_.end(), [&](const Pole& pole) { return group(pole) == kDecayingPoles; });
  }
  /// The smallest |pole| that is not 0; 1 if there is none [1/s].
  double slowest() const {
    double slowest = std::numeric_limits<double>::infinity();
    for (const Pole& pole : poles_)
      if (pole.value != 0.0) slowest = std::min(slowest, std::abs(pole.value));
    return std::isfinite(slowest) ? slowest : 1;
  }

 private:
  std::vector<Pole> poles_;
  double largest_ = 0;
};

/// One part for each group.
std::vector<Part> parts_of(const MatrixXd& a, const GroupedPoles& poles) {
  std::vector<Part> parts(kPoleGroups, {MatrixXd(a.rows(), 0), MatrixXd(0, a.rows())});
  if (poles.all_decay()) {  // the scaled states themselves, since other coordinates would cost digits
    parts[kDecayingPoles].basis = parts[kDecayingPoles].projection = MatrixXd::Identity(a.rows(), a.cols());
    return parts;
  }
  const std::vector<MatrixXd> bases =
      invariant_subspaces(a, kPoleGroups, [&](std::complex<double> pole) { return int(poles.group_next_to(pole)); });
  MatrixXd all(a.rows(), a.cols());
  all << bases[kZeroPoles], bases[kSwingingPoles], bases[kDecayingPoles];
  const MatrixXd inverse = square_solution(all, MatrixXd::Identity(a.rows(), a.cols()));
  Index first = 0;
  for (int group = 0; group < kPoleGroups; ++group) {
    const Index size = bases[group].cols();
    parts[group] = {bases[group], inverse.middleRows(first, size)};
    first += size;
  }
  return parts;
}

/// A rate below this part of the scale of its part's matrix is round-off.
constexpr double kNoMotion = 1e-6;

/// Hankel singular values below these parts of the largest are round-off: inputs do not reach these states, or outputs
/// do not see them. In invariant subspaces there is more of it.
constexpr double kSeen = 1e-14, kSeenInSubspace = 1e-10;

struct BalancedPart {
  GramianRoots roots;
  SingularValues hankel;
  Index seen = 0;  ///< number of singular values above round-off
};

/// Balances the part with a - decay, which has the same reachable and visible states as a.
BalancedPart balance(const Part& part, const ScaledStates& scaled, double decay, double least) {
  BalancedPart out;
  const Index size = part.basis.cols();
  if (size == 0) return out;
  out.roots = gramian_roots(part.projection * scaled.a * part.basis - decay * MatrixXd::Identity(size, size),
                            part.projection * scaled.b, scaled.c * part.basis);
  out.hankel = singular_values(out.roots.seen * out.roots.reached);
  const VectorXd& values = out.hankel.values;
  if (values.size() > 0) out.seen = (values.array() > least * values[0]).count();
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

/// A smaller part, of the states that inputs reach and outputs see, in which poles at 0 are 0 to the last bit: its
/// matrix is zero on and below the diagonal. `scale`: size of its other entries.
Part still_part(const Part& part, const MatrixXd& a, double scale) {
  MatrixXd basis = part.basis, projection = part.projection;
  for (Index first = 0; first < basis.cols();) {
    const MatrixXd rest = projection.bottomRows(basis.cols() - first) * a * basis.rightCols(basis.cols() - first);
    const SingularValues values = singular_values(rest);
    const Index stays = std::max<Index>(1, (values.values.array() <= kNoMotion * scale).count()),
                moves = rest.cols() - stays;
    MatrixXd turn(rest.cols(), rest.cols());  // what stays comes first
    turn << values.right.rightCols(stays), values.right.leftCols(moves);
    basis.rightCols(turn.cols()) = (basis.rightCols(turn.cols()) * turn).eval();
    projection.bottomRows(turn.cols()) = (turn.transpose() * projection.bottomRows(turn.cols())).eval();
    first += stays;
  }
  return {basis, projection};
}

/// The parts side by side, without couplings between them.
LinearModel joined(const LinearModel& model, const ScaledStates& scaled, const std::vector<Part>& parts) {
  Index size = 0;
  for (const Part& part : parts) size += part.basis.cols();
  LinearModel out = model;
  out.a = MatrixXd::Zero(size, size);
  out.b.resize(size, model.b.cols());
  out.c.resize(model.c.rows(), size);
  out.drift.resize(size);
  Index first = 0;
  for (const Part& part : parts) {
    const Index own = part.basis.cols();
    out.a.block(first, first, own, own) = part.projection * scaled.a * part.basis;
    out.b.middleRows(first, own) = part.projection * scaled.b;
    out.c.middleCols(first, own) = scaled.c * part.basis;
    out.drift.segment(first, own) = part.projection * (scaled.inverse * model.drift);
    first += own;
  }
  out.positions = static_cast<int>(size);
  out.states.clear();
  for (Index i = 0; i < size; ++i) out.states.push_back(fmt::format("reduced:{}", i));
  return out;
}

}  // namespace

ReducedModel reduced(const LinearModel& model, int order) {
  const ScaledStates scaled = scaled_states(model);
  const GroupedPoles poles(model);
  std::vector<Part> parts = parts_of(scaled.a, poles);
  for (const int group : {kZeroPoles, kSwingingPoles}) {
    const BalancedPart seen = balance(parts[group], scaled, poles.slowest(), kSeenInSubspace);
    parts[group] = truncated(parts[group], seen, seen.seen);
  }
  parts[kZeroPoles] = still_part(parts[kZeroPoles], scaled.a, poles.slowest());
  const Index still = parts[kZeroPoles].basis.cols(), kept = still + parts[kSwingingPoles].basis.cols();
  if (order < kept || order > model.a.rows())
    throw std::invalid_argument(fmt::format(
        "a reduced model has {} to {} states, {} of them of poles that do not decay and that the inputs move; got {}",
        kept, model.a.rows(), kept, order));
  const BalancedPart rest = balance(parts[kDecayingPoles], scaled, 0, kSeen);
  parts[kDecayingPoles] = truncated(parts[kDecayingPoles], rest, std::min<Index>(order - kept, rest.seen));
  ReducedModel out{joined(model, scaled, parts), rest.hankel.values, static_cast<int>(kept)};
  out.model.a.topLeftCorner(still, still).triangularView<Eigen::Lower>().setZero();
  return out;
}

}  // namespace flexarm
