#include "analysis/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/SparseCholesky>

#include "analysis/linearised_motion.h"
#include "analysis/long_chain.h"
#include "analysis/node_ways.h"

namespace flexarm {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Stiffness of the springs that replace loop constraints, relative to the stiffness of the parts that they join.
constexpr double kLoopStiffness = 1e3;
/// Added to the diagonal, which is scaled to 1, so that zeros there do not stop the factorisation.
constexpr double kShift = 1e-12;
/// A pivot below this may belong to a motion that nothing holds: eight digits are lost.
constexpr double kSmallPivot = 1e-8;
/// See neutral_curvature().
constexpr double kNeutral = 1e-6;
/// Chains of more joints have matrices that are dense and large.
constexpr std::size_t kMostCoordinates = 1000;
/// Most motions that are examined; the softest come first.
constexpr std::size_t kMostMotions = 64;

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

/// The motions that belong to negative or small pivots, one entry per unknown.
std::vector<Eigen::VectorXd> soft_motions(const Matrix& whole, Eigen::Index multipliers) {
  Matrix curvature = with_springs(whole, multipliers);
  const Eigen::Index size = curvature.cols();
  const Eigen::VectorXd scale =
      curvature.diagonal().unaryExpr([](double value) { return value == 0 ? 1.0 : 1 / std::sqrt(std::abs(value)); });
  Matrix shift(size, size);
  shift.setIdentity();
  curvature = scale.asDiagonal() * curvature * scale.asDiagonal();
  curvature += kShift * shift;
  const Eigen::SimplicialLDLT<Matrix> factors(curvature);
  if (factors.info() != Eigen::Success) return {};
  const Eigen::VectorXd pivots = factors.vectorD();
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < size; ++k)
    if (pivots[k] < kSmallPivot) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return pivots[a] < pivots[b]; });
  order.resize(std::min(order.size(), kMostMotions));
  std::vector<Eigen::VectorXd> motions;
  for (const Eigen::Index k : order) {
    Eigen::VectorXd motion = Eigen::VectorXd::Unit(size, k);
    factors.matrixU().solveInPlace(motion);
    motion = scale.cwiseProduct(factors.permutationPinv() * motion);
    motions.push_back(Eigen::VectorXd::Zero(whole.cols()));
    motions.back().head(size) = motion;
  }
  return motions;
}

}  // namespace

double neutral_curvature(const Model& model, const State& equilibrium) {
  return kNeutral * work_of_forces(model, equilibrium);
}

Stability judge_stability(const Model& model, const Scheme& scheme, const State& equilibrium) {
  Stability stability;
  if (model.coordinates.size() > kMostCoordinates) {
    if (model.closures.empty() && !is_circulatory(model, equilibrium))
      stability.motion = falling_motion(model, scheme, equilibrium);
    return stability;
  }
  const LinearisedMotion system(model, equilibrium, scheme.contact_time);
  if (system.freedoms() <= 0) return stability;
  const double neutral = neutral_curvature(model, equilibrium);
  const Matrix curvature = system.curvature();
  for (const Eigen::VectorXd& motion : soft_motions(curvature, (system.unknowns() - system.freedoms()) / 2)) {
    const std::vector<ComplexVector6> nodes = system.expand(motion.cast<std::complex<double>>()).node_motion;
    const NodeWays ways(model, nodes);
    const double own = motion.dot(curvature * motion), round_off = system.round_off(nodes),
                 least = round_off + neutral * ways.sum_of_squares();
    if (std::abs(own) <= least && system.strain_energy(nodes) <= round_off) stability.loose_link = ways.link();
    const double per_way = own / ways.sum_of_squares();
    if (own < -least && !system.is_circulatory() && per_way < stability.motion.curvature)
      stability.motion = {motion / ways.largest(), per_way, ways.link()};
  }
  return stability;
}

}  // namespace flexarm
