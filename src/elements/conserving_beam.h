#pragma once
/// Beam residual and tangent over a step for the energy-momentum (EM) family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I_t^i' m - I_t^i r'_arm x n} ds,  n = Lambda_bar N_a,  m = Lambda_bar M_a.
/// Momenta are conserved for any stress N_a, M_a and any test functions with sum I_t = 1, if the arm r'_arm suits the
/// rule of the velocities.
///
/// Templates on their numbers; those of four elements side by side (S = Pack) are what runs (conserving_pack.h). A step
/// goes by stages, which are compiled each by itself: set_points() (conserving_points.h), set_strains() and
/// set_forces() here, add_tangent() (conserving_tangent.h).

#include <cassert>

#include "elements/conserving_points.h"
#include "elements/conserving_terms.h"
#include "math/cayley.h"

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

namespace flexarm {
namespace conserving {

/// See translational_forces(). Sets the system.
template <int Nodes, typename S>
void set_translation(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, double factor,
                     double step, bool with_tangent, BlockSystem<Nodes, S>& system) {
  const auto translation = translational_forces<Vector3T<S>, Nodes>(element, nodes, factor, step);
  system.dissipated = translation.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    const Vector3T<S>& force = translation.forces[i];
    system.residual[i].template head<3>() = force;
    system.residual[i].template tail<3>().setConstant(S(0));
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      Matrix6T<S>& block = system.tangent[i][j];
      block.setConstant(S(0));
      block.diagonal().template head<3>().setConstant(translation.slope * element.mass(i, j));
    }
  }
}

/// Strains and elastic stresses at the points of set_points(). `begin`, `end`: those at t_n and t_{n+1}; `carried`:
/// what the geometric part of the tangent sees in the place of the latter's strains; may be null.
template <int Nodes, typename S>
void set_strains(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes,
                 const PointKinematicsT<S>* begin, const PointKinematicsT<S>* end,
                 const CarriedStrains<Nodes, S>* carried, StepPoints<Nodes, S>& at) {
  for (int k = 0; k < Nodes - 1; ++k) {
    Point<Nodes, S>& p = at.points[k];
    set_strains<Nodes, S>((*at.mid)[k], element.section(k), nodes, begin[k], end[k], p);
    p.seen = p.own;
    if (carried)
      p.seen = PointStress<S>(element.section(k), begin[k].strain, carried->end[k],
                              carried->has_conjugate ? carried->conjugate[k] : p.own.conjugate_strain);
  }
}

/// Internal forces, damping and translational inertia of one element over a step of length `step`, EM family, at the
/// points of set_points(). `begin` holds them at t_n, `end` at t_{n+1}; `memory`, `end_memory` serve numerical
/// dissipation and damped elements; without either they may be null. Rotary inertia is added elsewhere, the tangent of
/// what is not linear by add_tangent() (conserving_tangent.h).
///
/// The moment rows are tested with, and the increments interpolated by, generalised shape functions of about the middle
/// of the step: those of mid_functions() (MidFunctions::Explicit) or of the beginning (Symmetric), averaged with those
/// of the end; then the tangent, which leaves their variation out, makes Newton converge linearly, by a factor that
/// falls with the step. Any of them conserve momenta (sum I_g = 1) and, with the multiplier, energy; those of the
/// middle make Delta(strain) - s third order in the step. With the Lagrange functions (beyond.md 1.1) it is first order
/// wherever an element is deformed.
///
/// With a tangent, strains may be carried along (`has_carried`): then what its geometric part sees are not those of the
/// trial configuration. The residual does not depend on them (docs/notes/newton.md).
template <int Nodes, typename S>
void set_forces(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                const PointKinematicsT<S>* begin, const PointKinematicsT<S>* end, const StrainMemoryT<S>* memory,
                double step, bool with_tangent, bool has_carried, StrainMemoryT<S>* end_memory,
                StepPoints<Nodes, S>& at, EnergyMultiplier<Nodes, S>& multiplier, BlockSystem<Nodes, S>& system) {
  constexpr int kPoints = Nodes - 1;
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool has_memory = rule.dissipation.any() || element.has_stiffness_damping;
  assert(step != 0 && begin && end);
  assert(!has_memory || (memory && end_memory));
  set_translation<Nodes, S>(element, nodes, rule.velocity_factor(), step, with_tangent, system);

  const ElementFunctions<Nodes, S>& mid = *at.mid;
  if (is_corrected) multiplier.set_relative(nodes.increment);
  for (int k = 0; k < kPoints && is_corrected; ++k)
    multiplier.add(element.points[k].weight, element.section(k), begin[k], end[k], at.points[k]);

  const DamperParts<S> damper_parts(element.stiffness_damping, rule.damping_relaxation);
  for (int i = 0; i < Nodes && has_carried; ++i) system.carried[i].setConstant(S(0));
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    const SectionStiffness<S>& section = element.section(k);
    Point<Nodes, S>& p = at.points[k];
    S factor = S(0);
    Vector6T<S> stress = p.own.stress, seen = p.seen.stress;
    if (rule.dissipation.any()) {
      const NumericalDamper<S> damper(rule.dissipation, memory[k], p.own.conjugate_strain, section, step);
      factor += damper.factor;
      stress -= damper.remembered;
      seen -= damper.remembered;
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k].average = damper.average;
    }
    const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
    SectionStiffness<S> damped;  // D C D, with a factor of its own
    S damped_factor = S(0);
    if (is_uneven) damped = section.scaled(element.damping_scale);
    if (element.has_stiffness_damping) {
      const Vector6T<S> damped_stress = is_uneven ? damped.stress(p.own.conjugate_strain) : p.own.conjugate_stress;
      const StructuralDamper<S> damper(damper_parts, rule.damping_relaxation, memory[k], p.own.conjugate_strain,
                                       damped_stress, is_uneven ? damped : section, step);
      if (is_uneven) {
        damped_factor = damper.factor;
        stress += damped_factor * damped_stress;
        seen += damped_factor * damped.stress(p.seen.conjugate_strain);
      } else {
        factor += damper.factor;
      }
      stress -= damper.remembered;
      seen -= damper.remembered;
      system.dissipated += constants.weight * damper.dissipated;
      end_memory[k].delayed_rate = damper.delayed_rate;
    }
    if (has_memory) end_memory[k].rate = end_rate(memory[k], p.own.conjugate_strain, step);
    stress += factor * p.own.conjugate_stress;
    const Vector6T<S> weighted = constants.weight * stress;
    add_residual<Nodes, S>(constants.derivative, mid[k], p.average_rotation * weighted.template head<3>(),
                           p.average_rotation * weighted.template tail<3>(), p.arm, system.residual);
    if (!with_tangent) continue;
    p.seen_resultants = constants.weight * Vector6T<S>(seen + factor * p.seen.conjugate_stress);
    p.factor = factor;
    p.damped_factor = damped_factor;
    if (has_carried) {
      const Vector6T<S> more = p.seen_resultants - weighted;
      add_residual<Nodes, S>(constants.derivative, mid[k], p.average_rotation * more.template head<3>(),
                             p.average_rotation * more.template tail<3>(), p.arm, system.carried);
    }
  }
  if (is_corrected) multiplier.add_moments(system, has_carried);
}

/// What the strains become along a Newton update {dr, spin} of the nodes, to first order, from those of set_strains().
template <int Nodes, typename S>
void carry_strains(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes,
                   const StepPoints<Nodes, S>& at, const std::array<Vector6T<S>, Nodes>& update,
                   const PointKinematicsT<S>* end, CarriedStrains<Nodes, S>& carried) {
  std::array<Vector3T<S>, Nodes> displacement, spin, increment;
  for (int i = 0; i < Nodes; ++i) {
    displacement[i] = update[i].template head<3>();
    spin[i] = update[i].template tail<3>();
    increment[i] = cayley::inverse_tangent(nodes.increment[i]) * spin[i];
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const Point<Nodes, S>& p = at.points[k];
    PointVariation<S> variation;
    variation.position = interpolate<Nodes>(element.points[k].derivative, displacement);
    variation.spin = sum_of<Nodes, S>(p.generalised.values, spin);
    variation.spin_derivative = sum_of<Nodes, S>(p.generalised.derivatives, spin);
    variation.increment = sum_of<Nodes, S>((*at.mid)[k].values, increment);
    variation.increment_derivative = sum_of<Nodes, S>((*at.mid)[k].derivatives, increment);
    const StrainSlopes<S> slopes = strain_slopes<Nodes, S>(p, variation);
    carried.end[k] = end[k].strain + slopes.end;
    carried.conjugate[k] = p.own.conjugate_strain + slopes.conjugate;
  }
  carried.has_conjugate = true;
}

}  // namespace conserving
}  // namespace flexarm
