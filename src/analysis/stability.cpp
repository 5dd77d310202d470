#include "analysis/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/QR>
#include <Eigen/SparseCholesky>

#include "analysis/linearised_motion.h"
#include "analysis/long_chain.h"
#include "analysis/node_ways.h"
#include "math/dense_eigenpairs.h"

namespace flexarm {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Stiffness of the springs that replace loop constraints, relative to the stiffness of the parts that they join.
constexpr double kLoopStiffness = 1e3;
/// Added to the diagonal, which is scaled to 1, so that zeros there do not stop the factorisation.
constexpr double kShift = 1e-14;
/// A pivot below this may belong to a motion that nothing holds: eight digits are lost.
constexpr double kSmallPivot = 1e-8;
/// See neutral_curvature().
constexpr double kNeutral = 1e-6;
/// Chains of more joints have matrices that are dense and large.
constexpr std::size_t kMostCoordinates = 1000;
/// Most motions that are examined; the softest come first.
constexpr std::size_t kMostMotions = 64;
/// The motions of at most kMostRefined negative pivots are refined, by kProducts products with the inverse.
constexpr std::size_t kMostRefined = 8;
constexpr Eigen::Index kProducts = 3;
/// Motions are dependent if the smallest eigenvalue of their products is below this part of the largest one.
constexpr double kDependent = 1e-6;

/// The matrix with springs in place of loop constraints, for the unknowns that are no multipliers.
Matrix with_springs(const Matrix& whole, Eigen::Index multipliers) {
  if (multipliers == 0) return whole;
  const Eigen::Index motions = whole.cols() - multipliers;
  const Matrix curvature = whole.topLeftCorner(motions, motions);
  Eigen::SparseMatrix<double, Eigen::RowMajor> constraints = whole.bottomLeftCorner(multipliers, motions);
  const Eigen::VectorXd stiffness = curvature.diagonal().cwiseAbs();
  for (Eigen::Index row = 0; row < multipliers; ++row) {
    double square = 0, held = 0;
    for (decltype(constraints)::InnerIterator entry(constraints, row); entry; ++entry) {
      square += entry.value() * entry.value();
      held += entry.value() * entry.value() * stiffness[entry.col()];
    }
    constraints.row(row) *= std::sqrt(kLoopStiffness * (held > 0 ? held / square : 1.0) / square);
  }
  return curvature + Matrix(constraints.transpose() * constraints);
}

using Factors = Eigen::SimplicialLDLT<Matrix>;

/// Ritz vectors of negative curvature in the space of the `start` and their products with powers of the inverse. A
/// motion that belongs to a negative pivot may be far from the motion of lowest curvature: it contains stiff motions.
Eigen::MatrixXd ritz_vectors(const Matrix& curvature, const Factors& factors, Eigen::MatrixXd start) {
  const Eigen::Index count = start.cols();
  Eigen::MatrixXd space(start.rows(), std::min(start.rows(), (kProducts + 1) * count));
  for (Eigen::Index product = 0; (product + 1) * count <= space.cols(); ++product) {
    if (product > 0) start = factors.solve(start).eval();
    start.colwise().normalize();
    space.middleCols(product * count, count) = start;
  }
  space.conservativeResize(Eigen::NoChange, space.cols() / count * count);
  if (!space.allFinite()) return {};
  const Eigen::HouseholderQR<Eigen::MatrixXd> decomposition(space);
  const Eigen::MatrixXd basis = decomposition.householderQ() * Eigen::MatrixXd::Identity(space.rows(), space.cols());
  const SymmetricEigenpairs pairs = symmetric_eigenpairs(basis.transpose() * (curvature * basis));
  const auto negative = std::count_if(pairs.values.data(), pairs.values.data() + pairs.values.size(),
                                      [](double value) { return value < 0; });
  return basis * pairs.vectors.leftCols(negative);
}

/// Soft motions of a curvature, one entry per unknown.
class SoftMotions {
 public:
  /// `multipliers`: how many of the unknowns are multipliers of loops; they are the last ones.
  SoftMotions(const Matrix& whole, Eigen::Index multipliers);

  std::vector<Eigen::VectorXd> of_pivots;  // that belong to negative or small pivots, the lowest ones first
  std::vector<Eigen::VectorXd> unstable;   // in which the potential falls steeply; independent
  /// The displacement that balances forces.
  Eigen::VectorXd answer(const Eigen::VectorXd& forces) const;

 private:
  Eigen::VectorXd whole_vector(const Eigen::VectorXd& scaled) const;

  const Eigen::Index unknowns_;
  Eigen::VectorXd scale_;
  Factors factors_;
};

Eigen::VectorXd SoftMotions::whole_vector(const Eigen::VectorXd& scaled) const {
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(unknowns_);
  whole.head(scaled.size()) = scale_.cwiseProduct(scaled);
  return whole;
}

Eigen::VectorXd SoftMotions::answer(const Eigen::VectorXd& forces) const {
  Eigen::VectorXd scaled = Eigen::VectorXd::Zero(scale_.size());
  const Eigen::Index size = std::min(scaled.size(), forces.size());
  scaled.head(size) = scale_.head(size).cwiseProduct(forces.head(size));
  return whole_vector(factors_.solve(scaled));
}

SoftMotions::SoftMotions(const Matrix& whole, Eigen::Index multipliers) : unknowns_(whole.cols()) {
  Matrix curvature = with_springs(whole, multipliers);
  const Eigen::Index size = curvature.cols();
  scale_ =
      curvature.diagonal().unaryExpr([](double value) { return value == 0 ? 1.0 : 1 / std::sqrt(std::abs(value)); });
  Matrix shift(size, size);
  shift.setIdentity();
  curvature = scale_.asDiagonal() * curvature * scale_.asDiagonal();
  curvature += kShift * shift;
  factors_.compute(curvature);
  if (factors_.info() != Eigen::Success) return;
  const Eigen::VectorXd pivots = factors_.vectorD();
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < size; ++k)
    if (pivots[k] < kSmallPivot) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return pivots[a] < pivots[b]; });
  order.resize(std::min(order.size(), kMostMotions));
  Eigen::MatrixXd start(size, 0);
  for (const Eigen::Index k : order) {
    Eigen::VectorXd motion = Eigen::VectorXd::Unit(size, k);
    factors_.matrixU().solveInPlace(motion);
    motion = (factors_.permutationPinv() * motion).eval();
    of_pivots.push_back(whole_vector(motion));
    if (pivots[k] >= 0 || start.cols() == static_cast<Eigen::Index>(kMostRefined)) continue;
    start.conservativeResize(Eigen::NoChange, start.cols() + 1);
    start.rightCols(1) = motion;
  }
  if (start.cols() == 0) return;
  const Eigen::MatrixXd refined = ritz_vectors(curvature, factors_, start);
  for (Eigen::Index k = 0; k < refined.cols(); ++k) unstable.push_back(whole_vector(refined.col(k)));
}

/// By how much the forces on the unknowns grow as the factor of gravity and loads grows from 0 to 1.
Eigen::VectorXd load_forces(const Model& model, const State& equilibrium) {
  StepSystem system(model, exact_equilibrium(), BackendChoice::Matrix);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(system.degrees_of_freedom().unknowns);
  for (const double factor : {0.0, 1.0}) {
    system.begin_equilibrium(equilibrium, factor);
    if (system.evaluate(false)) forces = system.residual() - forces;
  }
  return -forces;
}

/// A motion of the span of unstable ones: the part there of `growth`, by which the equilibrium moves as loads grow. It
/// shows in which direction imperfections of a mechanism, such as a small load across a column, let it buckle. Parts
/// are those in the norm of Drag. If the work of loads along `growth` would be no more than `noise`, nothing tells a
/// direction, and the motion of lowest curvature is as good as any.
UnstableMotion motion_away(const Model& model, const LinearisedMotion& system, const Matrix& curvature,
                           const std::vector<Eigen::VectorXd>& motions, const Eigen::VectorXd& growth, double noise) {
  const auto count = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd span(curvature.cols(), count), drag(count, count);
  std::vector<std::vector<ComplexVector6>> nodes;
  nodes.reserve(motions.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    span.col(k) = motions[static_cast<std::size_t>(k)];
    nodes.push_back(system.expand(span.col(k).cast<std::complex<double>>()).node_motion);
  }
  const auto product = [&](const std::vector<ComplexVector6>& a, const std::vector<ComplexVector6>& b) {
    const double square = model.length_scale * model.length_scale;
    double sum = 0;
    for (std::size_t n = 0; n < a.size(); ++n)
      sum +=
          a[n].head<3>().real().dot(b[n].head<3>().real()) / square + a[n].tail<3>().real().dot(b[n].tail<3>().real());
    return sum;
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < nodes.size(); ++k)
      drag(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = product(nodes[i], nodes[k]);
  const SymmetricEigenpairs drags = symmetric_eigenpairs(drag);
  Eigen::MatrixXd base(curvature.cols(), 0);  // orthonormal in that norm
  for (Eigen::Index k = 0; k < count; ++k) {
    if (drags.values[k] <= kDependent * drags.values[count - 1]) continue;
    base.conservativeResize(Eigen::NoChange, base.cols() + 1);
    base.rightCols(1) = span * drags.vectors.col(k) / std::sqrt(drags.values[k]);
  }
  const SymmetricEigenpairs pairs = symmetric_eigenpairs(base.transpose() * (curvature * base));
  const Eigen::MatrixXd own = base * pairs.vectors;
  const std::vector<ComplexVector6> moved = system.expand(growth.cast<std::complex<double>>()).node_motion;
  Eigen::VectorXd parts(own.cols());
  for (Eigen::Index k = 0; k < own.cols(); ++k)
    parts[k] =
        pairs.values[k] >= 0 ? 0 : product(system.expand(own.col(k).cast<std::complex<double>>()).node_motion, moved);
  const bool is_told = parts.allFinite() && parts.cwiseAbs().maxCoeff() * -pairs.values[0] > noise;
  const Eigen::VectorXd direction = is_told ? Eigen::VectorXd(own * parts) : Eigen::VectorXd(own.col(0));
  const NodeWays ways(model, system.expand(direction.cast<std::complex<double>>()).node_motion);
  return {direction / ways.largest(), pairs.values[0], ways.link()};
}

}  // namespace

double neutral_curvature(const Model& model, const State& equilibrium) {
  return kNeutral * work_of_forces(model, equilibrium);
}

Stability judge_stability(const Model& model, const State& equilibrium) {
  Stability stability;
  if (model.coordinates.size() > kMostCoordinates) {
    if (model.closures.empty() && !is_circulatory(model, equilibrium))
      stability.motion = falling_motion(model, equilibrium);
    return stability;
  }
  const LinearisedMotion system(model, equilibrium);
  if (system.freedoms() <= 0) return stability;
  const double neutral = neutral_curvature(model, equilibrium);
  const Matrix curvature = system.curvature();
  const SoftMotions soft(curvature, multiplier_count(model));
  std::vector<Eigen::VectorXd> unstable;
  for (const std::vector<Eigen::VectorXd>* motions : {&soft.unstable, &soft.of_pivots})
    for (const Eigen::VectorXd& motion : *motions) {
      const std::vector<ComplexVector6> nodes = system.expand(motion.cast<std::complex<double>>()).node_motion;
      const NodeWays ways(model, nodes);
      const double own = motion.dot(curvature * motion), round_off = system.round_off(nodes),
                   least = round_off + neutral * ways.sum_of_squares();
      if (motions == &soft.of_pivots && std::abs(own) <= least && system.strain_energy(nodes) <= round_off)
        stability.loose_link = ways.link();
      if (own < -least) unstable.push_back(motion / ways.largest());
    }
  if (!unstable.empty() && !system.is_circulatory())
    stability.motion = motion_away(model, system, curvature, unstable, soft.answer(load_forces(model, equilibrium)),
                                   kStiffnessRoundOff * work_of_forces(model, equilibrium));
  return stability;
}

}  // namespace flexarm
