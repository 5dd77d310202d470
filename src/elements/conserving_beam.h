#pragma once
/// Beam residual and tangent over a step for the energy-momentum (EM) family (beam.md 3.2, beyond.md 1):
///   g_v^i = int {I^i' n,  I_t^i' m - I_t^i r'_* x n} ds,  n = Lambda_bar N_a,  m = Lambda_bar M_a.
/// Momenta are conserved for any stress N_a, M_a and any test functions with sum I_t = 1, if the arm r'_* suits the
/// rule of the velocities.
///
/// One source for one element (S = double) and for four of them side by side (S = Pack). The algebra is by 3 x 3 blocks
/// in world axes: the linearisation of a point has few of them that are not zero, and fewer still where the section
/// couples no forces with curvatures.

#include <cassert>

#include "elements/conserving_point.h"
#include "elements/strain_dampers.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {

template <int Nodes, typename S>
Vector3T<S> mean_of(const std::array<Vector3T<S>, Nodes>& vectors) {
  Vector3T<S> sum = vectors[0];
  for (int i = 1; i < Nodes; ++i) sum += vectors[i];
  return S(1.0 / Nodes) * sum;
}

/// Generalised shape functions for the middle of a step from `orientation` by the `foreseen` tangent-scaled increments:
/// those of the configuration half-way.
template <int Nodes, typename S>
void mid_functions(const ConservingElement<Nodes, S>& element, const std::array<QuaternionT<S>, Nodes>& orientation,
                   const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  std::array<QuaternionT<S>, Nodes> half_way;
  for (int i = 0; i < Nodes; ++i) half_way[i] = cayley::half_quaternion(foreseen[i]) * orientation[i];
  const LocalRotationVariation<Nodes, S> local{LocalRotations<Nodes, S>(half_way)};
  for (int k = 0; k < Nodes - 1; ++k)
    local.evaluate(element.points[k].shape, element.points[k].derivative, functions[k]);
}

/// The stretch P = I + (cos(theta/2) - 1) e e^T, angle theta about e, of the mean of the `foreseen` increments: values
/// P^-1 I_g P and derivatives P I_g' P. With it the conjugate strain of a step that turns the element by any angle is
/// exact to first order in what else it does, and the energy multiplier has little to make up for (beyond.md 1.3).
template <int Nodes, typename S>
void stretch_mid_functions(const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  const Vector3T<S> mean = mean_of<Nodes, S>(foreseen);
  const Matrix3T<S> stretch = cayley::axial_stretch(mean), inverse = cayley::inverse_axial_stretch(mean);
  for (int k = 0; k < Nodes - 1; ++k) {
    for (int i = 0; i < Nodes; ++i) {
      const Matrix3T<S> value = functions[k].values[i].lazyProduct(stretch),
                        derivative = functions[k].derivatives[i].lazyProduct(stretch);
      functions[k].values[i] = inverse.lazyProduct(value);
      functions[k].derivatives[i] = stretch.lazyProduct(derivative);
    }
  }
}

/// The stiffness points for given nodal positions and rotations.
template <int Nodes, typename S>
void element_points(const ConservingElement<Nodes, S>& element, const std::array<Vector3T<S>, Nodes>& position,
                    const std::array<QuaternionT<S>, Nodes>& orientation, PointKinematicsT<S>* points) {
  const LocalRotations<Nodes, S> local(orientation);
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    points[k] = point_kinematics(local.evaluate(constants.shape, constants.derivative),
                                 interpolate<Nodes>(constants.derivative, position), constants.reference_strain);
  }
}

namespace conserving {

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

/// Translational inertia (1/h) int I^i I^j mass (v_{n+1} - v_n), v_{n+1} = factor Delta r / h - (factor - 1) v_n, and
/// mass-proportional damping by the mean velocity Delta r / h. Sets the system.
template <int Nodes, typename S>
void set_translation(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, double factor,
                     double step, bool with_tangent, BlockSystem<Nodes, S>& system) {
  std::array<Vector3T<S>, Nodes> mean, force;
  S slope = S(factor / (step * step));
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = S(1 / step) * (nodes.end[i] - nodes.begin[i]);
    force[i] = S(factor / step) * (mean[i] - nodes.velocity[i]);
  }
  system.dissipated = S(0);
  if (element.has_mass_damping) {
    slope += element.mass_damping * S(1 / step);
    for (int i = 0; i < Nodes; ++i) {
      force[i] += element.mass_damping * mean[i];
      for (int j = 0; j < Nodes; ++j)
        system.dissipated += element.mass_damping * S(step) * element.mass(i, j) * so3::dot(mean[i], mean[j]);
    }
  }
  for (int i = 0; i < Nodes; ++i) {
    Vector3T<S> sum = element.mass(i, 0) * force[0];
    for (int j = 1; j < Nodes; ++j) sum += element.mass(i, j) * force[j];
    system.residual[i].template head<3>() = sum;
    system.residual[i].template tail<3>().setConstant(S(0));
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      Matrix6T<S>& block = system.tangent[i][j];
      block.setConstant(S(0));
      block.diagonal().template head<3>().setConstant(slope * element.mass(i, j));
    }
  }
}

/// All stiffness points of an element over a step, at the trial configuration.
template <int Nodes, typename S>
struct StepPoints {
  std::array<Point<Nodes, S>, Nodes - 1> points;
  ElementFunctions<Nodes, S> averages;    // where the mid functions are symmetric
  const ElementFunctions<Nodes, S>* mid;  // of about the middle of the step

  /// `end` receives the points at t_{n+1}. The generalised shape functions of the points are set `with_variation`, or
  /// where the mid functions ask for them. `functions` must outlive this.
  StepPoints(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
             const ElementFunctions<Nodes, S>& functions, const PointKinematicsT<S>* begin,
             const CarriedStrains<Nodes, S>* carried, bool with_variation, PointKinematicsT<S>* end)
      : mid(&functions) {
    constexpr int kPoints = Nodes - 1;
    const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
    const LocalRotations<Nodes, S> rotations(nodes.orientation);
    std::array<InterpolatedRotation<S>, kPoints> rotation;
    if (with_variation || is_symmetric) {
      const LocalRotationVariation<Nodes, S> variation(rotations);
      for (int k = 0; k < kPoints; ++k)
        rotation[k] = variation.evaluate(element.points[k].shape, element.points[k].derivative, points[k].generalised);
    } else {
      for (int k = 0; k < kPoints; ++k)
        rotation[k] = rotations.evaluate(element.points[k].shape, element.points[k].derivative);
    }
    if (is_symmetric) {
      for (int k = 0; k < kPoints; ++k)
        for (int i = 0; i < Nodes; ++i) {
          averages[k].values[i] = S(0.5) * (functions[k].values[i] + points[k].generalised.values[i]);
          averages[k].derivatives[i] = S(0.5) * (functions[k].derivatives[i] + points[k].generalised.derivatives[i]);
        }
      mid = &averages;
    }
    for (int k = 0; k < kPoints; ++k) {
      const auto& constants = element.points[k];
      end[k] = point_kinematics(rotation[k], interpolate<Nodes>(constants.derivative, nodes.end),
                                constants.reference_strain);
      Point<Nodes, S>& p = points[k];
      set_strains<Nodes, S>((*mid)[k], element.section(k), nodes, begin[k], end[k], p);
      p.seen = p.own;
      if (carried)
        p.seen = PointStress<S>(element.section(k), begin[k].strain, carried->end[k],
                                carried->has_conjugate ? carried->conjugate[k] : p.own.conjugate_strain);
    }
  }
  StepPoints(const StepPoints&) = delete;  // `mid` may point to its own
};

}  // namespace conserving

/// Internal forces, damping and translational inertia of one element over a step of length `step`, EM family. `begin`
/// holds the element's stiffness points at t_n, `end` receives those at t_{n+1}; `memory`, `end_memory` serve
/// numerical dissipation and damped elements; without either they may be null. Rotary inertia is added elsewhere.
///
/// The moment rows are tested with, and the increments interpolated by, generalised shape functions of about the middle
/// of the step: `functions` are those of mid_functions() (MidFunctions::Explicit) or of the beginning (Symmetric),
/// averaged with those of the end; then the tangent, which leaves their variation out, makes Newton converge linearly,
/// by a factor that falls with the step. Any of them conserve momenta (sum I_g = 1) and, with the multiplier, energy;
/// those of the middle make Delta(strain) - s third order in the step. With the Lagrange functions (beyond.md 1.1) it
/// is first order wherever an element is deformed.
///
/// With a tangent, strains may be carried along: `carried`, per point, are what its geometric part sees instead of
/// those of the trial configuration. Null: these. The residual does not depend on them (docs/notes/newton.md).
template <int Nodes, typename S>
void conserving_beam(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                     const ElementFunctions<Nodes, S>& functions, const PointKinematicsT<S>* begin,
                     const StrainMemoryT<S>* memory, double step, bool with_tangent,
                     const CarriedStrains<Nodes, S>* carried, PointKinematicsT<S>* end, StrainMemoryT<S>* end_memory,
                     BlockSystem<Nodes, S>& system) {
  constexpr int kPoints = Nodes - 1;
  using conserving::Point;
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool has_memory = rule.dissipation.any() || element.has_stiffness_damping;
  assert(step != 0 && begin && end);
  assert(!has_memory || (memory && end_memory));
  conserving::set_translation<Nodes, S>(element, nodes, rule.velocity_factor(), step, with_tangent, system);

  conserving::StepPoints<Nodes, S> at(element, nodes, rule, functions, begin, carried, with_tangent, end);
  const ElementFunctions<Nodes, S>& mid = *at.mid;
  conserving::EnergyMultiplier<Nodes, S> multiplier;
  if (is_corrected) multiplier.set_relative(nodes.increment);
  for (int k = 0; k < kPoints && is_corrected; ++k)
    multiplier.add(element.points[k].weight, element.section(k), begin[k], end[k], at.points[k]);

  const conserving::DamperParts<S> damper_parts(element.stiffness_damping, rule.damping_relaxation);
  std::array<Matrix3T<S>, Nodes> inverse_tangent;  // S(w)^{-1}: dw = S^{-1} spin
  std::array<Vector6T<S>, Nodes> work_row;
  for (int i = 0; i < Nodes && with_tangent; ++i) {
    inverse_tangent[i] = cayley::inverse_tangent(nodes.increment[i]);
    work_row[i].setConstant(S(0));
  }
  for (int i = 0; i < Nodes && carried; ++i) system.carried[i].setConstant(S(0));
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    const SectionStiffness<S>& section = element.section(k);
    const Point<Nodes, S>& p = at.points[k];
    S factor = S(0);
    Vector6T<S> stress = p.own.stress, seen = p.seen.stress;
    if (rule.dissipation.any()) {
      const conserving::NumericalDamper<S> damper(rule.dissipation, memory[k], p.own.conjugate_strain, section, step);
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
      const conserving::StructuralDamper<S> damper(damper_parts, rule.damping_relaxation, memory[k],
                                                   p.own.conjugate_strain, damped_stress, is_uneven ? damped : section,
                                                   step);
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
    if (has_memory) end_memory[k].rate = conserving::end_rate(memory[k], p.own.conjugate_strain, step);
    stress += factor * p.own.conjugate_stress;
    const Vector6T<S> weighted = constants.weight * stress;
    conserving::add_residual<Nodes, S>(constants.derivative, mid[k], p.average_rotation * weighted.template head<3>(),
                                       p.average_rotation * weighted.template tail<3>(), p.arm, system.residual);
    if (!with_tangent) continue;
    seen = constants.weight * Vector6T<S>(seen + factor * p.seen.conjugate_stress);
    if (carried) {
      const Vector6T<S> more = seen - weighted;
      conserving::add_residual<Nodes, S>(constants.derivative, mid[k], p.average_rotation * more.template head<3>(),
                                         p.average_rotation * more.template tail<3>(), p.arm, system.carried);
    }

    const bool is_coupled = section.is_coupled;
    const conserving::SlopeBuilder<Nodes, S> slope(p, constants.weight, factor);
    conserving::ResultantSlopes<S> dn, dm;
    slope.set_strain_part(section.forces, false, dn);
    slope.set_curvature_part(section.moments, false, dm);
    if (is_coupled) {
      slope.set_curvature_part(section.coupling, true, dn);
      slope.set_strain_part(section.coupling.transpose(), true, dm);
    } else {  // not used, but compilers warn
      dn.spin_derivative.setConstant(S(0));
      dn.increment_derivative.setConstant(S(0));
      dm.position.setConstant(S(0));
      dm.increment.setConstant(S(0));
    }
    if (is_uneven) {
      const conserving::SlopeBuilder<Nodes, S> damping(p, constants.weight, damped_factor);
      damping.add_conjugate_strain_part(damped.forces, dn);
      damping.add_conjugate_curvature_part(damped.moments, dm);
      if (is_coupled) {
        damping.add_conjugate_curvature_part(damped.coupling, dn);
        damping.add_conjugate_strain_part(damped.coupling.transpose(), dm);
      }
    }
    const Vector3T<S> force = seen.template head<3>();
    slope.add_turn(force, dn);
    slope.add_turn(seen.template tail<3>(), dm);
    conserving::add_tangent<Nodes, S>(constants.derivative, mid[k], p, inverse_tangent, is_coupled,
                                      p.average_rotation * force, dn, dm, system.tangent);
    if (!is_corrected) continue;
    conserving::add_form<Nodes, S>(multiplier.form(constants.weight, p), constants.derivative, p.generalised, mid[k],
                                   inverse_tangent, work_row);
  }
  if (!is_corrected) return;
  multiplier.add_moments(system, carried != nullptr);
  if (with_tangent) multiplier.add_tangent(work_row, inverse_tangent, system.tangent);
}

/// What the strains become along a Newton update {dr, spin} of the nodes, to first order. `end` is scratch.
template <int Nodes, typename S>
void carry_strains(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                   const ElementFunctions<Nodes, S>& functions, const PointKinematicsT<S>* begin,
                   const std::array<Vector6T<S>, Nodes>& update, PointKinematicsT<S>* end,
                   CarriedStrains<Nodes, S>& carried) {
  const conserving::StepPoints<Nodes, S> at(element, nodes, rule, functions, begin, nullptr, true, end);
  std::array<Vector3T<S>, Nodes> displacement, spin, increment;
  for (int i = 0; i < Nodes; ++i) {
    displacement[i] = update[i].template head<3>();
    spin[i] = update[i].template tail<3>();
    increment[i] = cayley::inverse_tangent(nodes.increment[i]) * spin[i];
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const conserving::Point<Nodes, S>& p = at.points[k];
    conserving::PointVariation<S> variation;
    variation.position = interpolate<Nodes>(element.points[k].derivative, displacement);
    variation.spin = conserving::sum_of<Nodes, S>(p.generalised.values, spin);
    variation.spin_derivative = conserving::sum_of<Nodes, S>(p.generalised.derivatives, spin);
    variation.increment = conserving::sum_of<Nodes, S>((*at.mid)[k].values, increment);
    variation.increment_derivative = conserving::sum_of<Nodes, S>((*at.mid)[k].derivatives, increment);
    const conserving::StrainSlopes<S> slopes = conserving::strain_slopes<Nodes, S>(p, variation);
    carried.end[k] = end[k].strain + slopes.end;
    carried.conjugate[k] = p.own.conjugate_strain + slopes.conjugate;
  }
  carried.has_conjugate = true;
}

}  // namespace flexarm
