#pragma once
/// How an element of the energy-momentum family keeps the energy (beyond.md 1.3).

#include "elements/conserving_point.h"

namespace flexarm::conserving {

/// The element's energy multiplier mu. The stresses work on the defect Delta Sigma - s of the conjugate strain, which
/// the relative rotations of the nodes alone make. Moments mu (w_i - mean w), which sum to zero, do that work
/// (beyond.md 1.3).
template <int Nodes, typename S>
struct EnergyMultiplier {
  /// Relative increments below this [rad] are rest: there is nothing that a correction could work on.
  static constexpr double kRest = 1e-7;

  std::array<Vector3T<S>, Nodes> relative;  ///< w_i - mean w
  S square = S(0);                          ///< sum of their squares
  S work = S(0), seen_work = S(0);          ///< of the trial configuration's stresses, and of those that are carried

  void set_relative(const std::array<Vector3T<S>, Nodes>& increments) {
    const Vector3T<S> mean = mean_of<Nodes, S>(increments);
    for (int i = 0; i < Nodes; ++i) {
      relative[i] = increments[i] - mean;
      square += so3::dot(relative[i], relative[i]);
    }
  }

  void add(const S& weight, const SectionStiffness<S>& stiffness, const PointKinematicsT<S>& begin,
           const PointKinematicsT<S>& end, Point<Nodes, S>& p) {
    // Tangent-scaled vector of Q = Lambda_{n+1} Lambda_n^T: 4 vee(Q) / (1 + tr Q).
    Vector3T<S> axial = so3::cross(begin.rotation.col(0), end.rotation.col(0));
    S trace = so3::dot(begin.rotation.col(0), end.rotation.col(0));
    for (int c = 1; c < 3; ++c) {
      axial += so3::cross(begin.rotation.col(c), end.rotation.col(c));
      trace += so3::dot(begin.rotation.col(c), end.rotation.col(c));
    }
    const Vector3T<S> turn = (S(2) / (S(1) + trace)) * axial;
    // Delta Gamma - s_Gamma = Lambda_bar^T (arm x (w_point - w)), free of cancellation.
    Vector6T<S> defect;  // Delta Sigma - s
    defect.template head<3>() = p.average_rotation.transpose() * so3::cross(p.arm, Vector3T<S>(turn - p.increment));
    defect.template tail<3>() =
        end.strain.template tail<3>() - begin.strain.template tail<3>() - p.own.conjugate_strain.template tail<3>();
    work += weight * dot6(p.own.stress, defect);
    seen_work += weight * dot6(p.seen.stress, defect);
    p.half_defect_stress = S(0.5) * stiffness.stress(defect);
  }

  /// d(mu) / d(work).
  S slope() const { return square / guarded(); }
  /// d(work) as a linear form at a point, with the stresses that are seen.
  PointForm<S> form(const S& weight, const Point<Nodes, S>& p) const {
    return strain_form<Nodes, S>(p, -weight * p.seen.stress,
                                 weight * Vector6T<S>(p.half_defect_stress + p.seen.stress));
  }

  /// Adds the moments, and to `carried` what the seen stresses would add to them.
  void add_moments(BlockSystem<Nodes, S>& system, bool has_carried) const {
    const S mu = work * slope(), rest = seen_work * slope() - mu;
    for (int i = 0; i < Nodes; ++i) system.residual[i].template tail<3>() += mu * relative[i];
    for (int i = 0; i < Nodes && has_carried; ++i) system.carried[i].template tail<3>() += rest * relative[i];
  }
  /// Adds their tangent. `work_row`: d(work) for {dr, spin} of the nodes; `inverse_tangent`: S(w)^{-1}.
  void add_tangent(const std::array<Vector6T<S>, Nodes>& work_row,
                   const std::array<Matrix3T<S>, Nodes>& inverse_tangent, BlockTangent<Nodes, S>& tangent) const {
    const S by_work = slope(), mu = seen_work * by_work, by_square = seen_work / guarded() - S(2) * mu * by_work;
    for (int j = 0; j < Nodes; ++j) {
      Vector6T<S> row = by_work * work_row[j];
      row.template tail<3>() += (S(2) * by_square) * (inverse_tangent[j].transpose() * relative[j]);
      for (int i = 0; i < Nodes; ++i) {
        Matrix6T<S>& block = tangent[i][j];
        block.template bottomRows<3>() += relative[i].lazyProduct(row.transpose());
        block.template bottomRightCorner<3, 3>() += (mu * S((i == j ? 1.0 : 0.0) - 1.0 / Nodes)) * inverse_tangent[j];
      }
    }
  }

 private:
  S guarded() const { return square * square + S(kRest * kRest * kRest * kRest); }
};

}  // namespace flexarm::conserving
