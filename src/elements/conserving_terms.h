#pragma once
/// What spatial and planar beams of the energy-momentum family share: translational inertia, strains and stresses at a
/// stiffness point, dampers with memory, the energy multiplier, and the assembly of the element's forces from these.
/// Over a step in which the strain changes by s, each damper adds factor C s - remembered to the stress.
/// (docs/schemes.md, "Numerical dissipation", "Structural damping")
///
/// In the plane, vectors have two components, rotations are scalars, and there are three strains. Functions with other
/// differences are in conserving_beam.h and planar_beam.h: set_point_strains(), add_resultants() and strain_form().

#include <array>
#include <cassert>
#include <type_traits>

#include <Eigen/Core>

#include "elements/conserving_element.h"
#include "elements/maxwell.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// Translational inertia and mass-proportional damping of an element over a step. `forces`: per node [N]. `slope`
/// [1/s^2]: the derivative of node i's force by node j's displacement is slope * mass(i, j), in every direction.
/// `dissipated`: by damping over the step [J].
template <int Nodes, class Vector>
struct TranslationalForces {
  using S = typename Vector::Scalar;
  std::array<Vector, Nodes> forces;
  S slope, dissipated;
};

/// Returns (1/h) int I^i I^j mass ds (v_{n+1} - v_n), with v_{n+1} = factor Delta r / h - (factor - 1) v_n, plus
/// mass-proportional damping by the mean velocity Delta r / h.
template <class Vector, int Nodes, class Element, class NodeMotion>
inline TranslationalForces<Nodes, Vector> translational_forces(const Element& element, const NodeMotion& nodes,
                                                               double factor, double step) {
  using S = typename Vector::Scalar;
  TranslationalForces<Nodes, Vector> out;
  std::array<Vector, Nodes> mean, force;
  // Without complex conjugation, and with the order of operations of so3::dot().
  const auto product = [](const Vector& a, const Vector& b) {
    S sum = a[0] * b[0];
    for (int k = 1; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  };
  out.slope = S(factor / (step * step));
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = S(1 / step) * (nodes.end[i] - nodes.begin[i]);
    force[i] = S(factor / step) * (mean[i] - nodes.velocity[i]);
  }
  out.dissipated = S(0);
  if (element.has_mass_damping) {
    out.slope += element.mass_damping * S(1 / step);
    for (int i = 0; i < Nodes; ++i) {
      force[i] += element.mass_damping * mean[i];
      for (int j = 0; j < Nodes; ++j)
        out.dissipated += element.mass_damping * S(step) * element.mass(i, j) * product(mean[i], mean[j]);
    }
  }
  for (int i = 0; i < Nodes; ++i) {
    out.forces[i] = element.mass(i, 0) * force[0];
    for (int j = 1; j < Nodes; ++j) out.forces[i] += element.mass(i, j) * force[j];
  }
  return out;
}

}  // namespace flexarm

namespace flexarm::conserving {

/// Returns the scalar product of two vectors of strains or stresses, six in space, three in the plane.
template <typename S, int Size>
S strain_product(const Eigen::Matrix<S, Size, 1>& a, const Eigen::Matrix<S, Size, 1>& b) {
  if constexpr (Size == 6)
    return dot6(a, b);
  else
    return so3::dot(a, b);
}

/// Strains and elastic stresses of a stiffness point over a step.
template <typename S, int Size = 6>
struct PointStress {
  using Strain = Eigen::Matrix<S, Size, 1>;
  Strain strain, stress;                      // means of the beginning and the end
  Strain conjugate_strain, conjugate_stress;  // s and C s

  PointStress() = default;
  template <class Stiffness>
  PointStress(const Stiffness& stiffness, const Strain& begin, const Strain& end, const Strain& conjugate)
      : strain(S(0.5) * (begin + end)),
        stress(stiffness.stress(strain)),
        conjugate_strain(conjugate),
        conjugate_stress(stiffness.stress(conjugate)) {}
};

/// Returns the strain rate w_1 at the end, from (w_0 + w_1)/2 = s/h.
template <class Memory, typename S, int Size>
Eigen::Matrix<S, Size, 1> end_rate(const Memory& begin, const Eigen::Matrix<S, Size, 1>& s, double step) {
  return S(2 / step) * s - begin.rate;
}

/// The damper of numerical dissipation at a stiffness point, see NumericalDissipation.
template <typename S, int Size = 6>
struct NumericalDamper {
  using Strain = Eigen::Matrix<S, Size, 1>;
  S factor, dissipated;  // [-], [J/m]
  Strain remembered, average;

  template <class Memory, class Stiffness>
  NumericalDamper(const NumericalDissipation& d, const Memory& begin, const Strain& s, const Stiffness& stiffness,
                  double step)
      : factor(d.stiffness + 2 * d.inertance / (step * step)) {
    const Strain deviation = s - begin.average;
    remembered = stiffness.stress(S(d.stiffness) * begin.average + S(2 * d.inertance / step) * begin.rate);
    dissipated =
        S(d.stiffness * (1 - 0.5 * d.forgetting)) * strain_product<S, Size>(deviation, stiffness.stress(deviation));
    average = begin.average + S(d.forgetting) * deviation;
  }
};

/// Splits a viscosity eta into three passive parts in parallel: a dashpot, a dashpot in series with a spring (a Maxwell
/// element with the relaxation time h_0), and an inertance. The shares of the last two in eta grow until eta = h_0.
template <typename S>
struct DamperParts {
  S dashpot, delayed, inertance;  // [s], [s], [s^2]

  DamperParts(const S& viscosity, double relaxation) {
    using std::abs;
    const S least = S(0.5) * (viscosity + S(relaxation) - abs(viscosity - S(relaxation)));  // minimum of eta and h_0
    delayed = relaxation > 0 ? S(0.25 / relaxation) * viscosity * least : S(0);
    inertance = S(relaxation) * delayed;
    dashpot = viscosity - delayed;
  }
};

/// The damper of structural damping at a stiffness point: the stress eta C (strain rate), by the parts of DamperParts.
/// With the delayed rate q, it is
///   C [dashpot s/h + inertance (w_1 - w_0)/h + delayed q_mean],   q_mean + (h_0/h) (q_1 - q_0) = s/h.
/// With a dashpot alone, the strain of a strongly damped mode would hardly decrease, and its velocity would change sign
/// in every step. With these parts both come to rest. The energy inertance (w.Cw + q.Cq)/2 is stored.
template <typename S, int Size = 6>
struct StructuralDamper {
  using Strain = Eigen::Matrix<S, Size, 1>;
  S factor, dissipated;  // [-], [J/m]
  Strain remembered, delayed_rate;

  /// `stress`: C s; `relaxation`: h_0 [s].
  template <class Memory, class Stiffness>
  StructuralDamper(const DamperParts<S>& parts, double relaxation, const Memory& begin, const Strain& s,
                   const Strain& stress, const Stiffness& stiffness, double step) {
    const double follows = 1 / (step + 2 * relaxation);
    const Strain delayed = S(follows) * (s + S(2 * relaxation) * begin.delayed_rate);
    factor = parts.dashpot * S(1 / step) + parts.inertance * S(2 / (step * step)) + parts.delayed * S(follows);
    remembered = stiffness.stress((parts.inertance * S(2 / step)) * begin.rate -
                                  (parts.delayed * S(2 * relaxation * follows)) * begin.delayed_rate);
    dissipated = parts.dashpot * S(1 / step) * strain_product<S, Size>(s, stress) +
                 parts.delayed * S(step) * strain_product<S, Size>(delayed, stiffness.stress(delayed));
    delayed_rate = S(2) * delayed - begin.delayed_rate;
  }
};

/// A Maxwell branch of the material at a stiffness point: the stress g C e_mean of its spring, see MaxwellCoefficients.
template <typename S, int Size = 6>
struct MaxwellDamper {
  using Strain = Eigen::Matrix<S, Size, 1>;
  S factor, dissipated;  // [-], [J/m]
  Strain remembered, end;

  /// `begin`: e_0; `stress`: C s.
  template <class Stiffness>
  MaxwellDamper(const MaxwellCoefficients<S>& c, const Strain& begin, const Strain& s, const Strain& stress,
                const Stiffness& stiffness)
      : factor(c.modulus_ratio * c.yields), end(c.keeps * begin + c.gains * s) {
    const Strain begin_stress = stiffness.stress(begin);
    remembered = -(c.modulus_ratio * c.gains) * begin_stress;
    const Strain mean = c.gains * begin + c.yields * s, mean_stress = c.gains * begin_stress + c.yields * stress;
    const S loss = S(1) - c.keeps;
    const Strain change = c.gains * s - loss * begin, change_stress = c.gains * stress - loss * begin_stress;
    dissipated = c.modulus_ratio * (c.flow * strain_product<S, Size>(mean, mean_stress) +
                                    c.excess * strain_product<S, Size>(change, change_stress));
  }
};

/// The energy multiplier mu of an element. The conjugate strain s differs from the change of strain Delta Sigma by a
/// defect, which is due to relative rotations of the nodes. The work of the stresses on Delta Sigma - s is missing in
/// the energy balance. Moments mu (w_i - mean w) on the nodes, which sum to zero, do exactly this work (beyond.md 1.3).
template <int Nodes, class Turn, class Strain>
struct MultiplierWork {
  using S = typename Strain::Scalar;
  static constexpr bool kIsPlanar = std::is_same_v<Turn, S>;
  /// Relative increments below this count as rest: there is no rotation on which a correction could do work [rad].
  static constexpr double kRest = 1e-7;

  std::array<Turn, Nodes> relative;  ///< w_i - mean w
  S square = S(0);                   ///< sum of the squares of `relative`
  S work = S(0), seen_work = S(0);   ///< missing work, with the trial configuration's stresses; with Point::seen

  void set_relative(const std::array<Turn, Nodes>& increments) {
    Turn mean = increments[0];
    for (int i = 1; i < Nodes; ++i) mean += increments[i];
    mean *= S(1.0 / Nodes);
    for (int i = 0; i < Nodes; ++i) {
      relative[i] = increments[i] - mean;
      if constexpr (kIsPlanar)
        square += relative[i] * relative[i];
      else
        square += so3::dot(relative[i], relative[i]);
    }
  }

  /// Returns d(mu) / d(work).
  S slope() const { return square / guarded(); }
  /// Returns the contribution of a point to d(seen_work), as a linear form.
  template <class Point>
  auto form(const S& weight, const Point& p) const {
    return strain_form(p, Strain(-weight * p.seen.stress),
                       Strain(weight * Strain(p.half_defect_stress + p.seen.stress)));
  }

  /// Adds the moments to the residual, and to `carried` their difference with Point::seen.
  template <class System>
  void add_moments(System& system, bool has_carried) const {
    const S mu = work * slope(), rest = seen_work * slope() - mu;
    for (int i = 0; i < Nodes; ++i) add_moment(mu * relative[i], system.residual[i]);
    for (int i = 0; i < Nodes && has_carried; ++i) add_moment(rest * relative[i], system.carried[i]);
  }

 protected:
  /// Adds the work of a point. `defect`: Delta Sigma - s.
  template <class Stiffness, class Point>
  void add_defect(const S& weight, const Stiffness& stiffness, const Strain& defect, Point& p) {
    work += weight * strain_product(p.own.stress, defect);
    seen_work += weight * strain_product(p.seen.stress, defect);
    p.half_defect_stress = S(0.5) * stiffness.stress(defect);
  }
  S guarded() const { return square * square + S(kRest * kRest * kRest * kRest); }

 private:
  template <class Row>
  static void add_moment(const Turn& moment, Row& row) {
    if constexpr (kIsPlanar)
      row[2] += moment;
    else
      row.template tail<3>() += moment;
  }
};

/// Sets (does not add to) the system to the translational inertia and mass damping of translational_forces().
template <int Nodes, class Element, class Motion, class System>
void set_translation(const Element& element, const Motion& nodes, double factor, double step, bool with_tangent,
                     System& system) {
  using Vector = std::decay_t<decltype(nodes.end[0])>;
  using S = typename Vector::Scalar;
  const auto translation = translational_forces<Vector, Nodes>(element, nodes, factor, step);
  system.dissipated = translation.dissipated;
  for (int i = 0; i < Nodes; ++i) {
    system.residual[i].setConstant(S(0));
    system.residual[i].template head<Vector::SizeAtCompileTime>() = translation.forces[i];
    for (int j = 0; j < Nodes && with_tangent; ++j) {
      system.tangent[i][j].setConstant(S(0));
      for (int c = 0; c < Vector::SizeAtCompileTime; ++c)
        system.tangent[i][j](c, c) = translation.slope * element.mass(i, j);
    }
  }
}

/// Computes strains and elastic stresses at the points of a step. `begin`, `end`: the points at t_n and t_{n+1}.
/// `carried`: strains that the geometric part of the tangent uses in place of those of `end`; may be null.
template <int Nodes, class Element, class Motion, class Kinematics, class Carried, class Points>
void set_strains(const Element& element, const Motion& nodes, const Kinematics* begin, const Kinematics* end,
                 const Carried* carried, Points& at) {
  for (int k = 0; k < Nodes - 1; ++k) {
    auto& p = at.points[k];
    set_point_strains(element, k, nodes, begin[k], end[k], at);
    p.seen = p.own;
    if (carried)
      p.seen = {element.section(k), begin[k].strain, carried->end[k],
                carried->has_conjugate ? carried->conjugate[k] : p.own.conjugate_strain};
  }
}

/// Computes internal forces, damping and translational inertia of one element of the EM family over a step of length
/// `step` [s], at the points of set_points(). `begin` holds the points at t_n, `end` those at t_{n+1}. `memory` and
/// `end_memory` are for numerical dissipation and damped elements; else they may be null. `branches`: Maxwell branches
/// of the material. Rotary inertia is added elsewhere. Sets only the tangent of the linear terms; add_tangent()
/// (conserving_tangent.h) adds the rest.
///
/// Generalised shape functions of an instant in the middle of the step test the moment rows and interpolate the
/// increments. With MidFunctions::Explicit they are those of mid_functions(). With Symmetric they are the average of
/// those at both ends; the tangent leaves out how this average varies, so Newton's method converges linearly, by a
/// factor that decreases with the step. Any such functions conserve momenta (sum I_g = 1) and, with the
/// multiplier, energy. With functions of the middle, Delta(strain) - s is of third order in the step. With Lagrange
/// functions (beyond.md 1.1) it would be of first order in all deformed elements.
///
/// With `has_carried`, the geometric part of the tangent uses carried strains in place of those of the trial
/// configuration. The residual does not depend on them (docs/notes/newton.md).
template <int Nodes, class Element, class Motion, class Kinematics, class Memory, class Branches, class Points,
          class Multiplier, class System>
void set_forces(const Element& element, const Motion& nodes, const TimeRule& rule, const Kinematics* begin,
                const Kinematics* end, const Memory* memory, double step, bool with_tangent, bool has_carried,
                Memory* end_memory, const Branches& branches, Points& at, Multiplier& multiplier, System& system) {
  using S = std::decay_t<decltype(system.dissipated)>;
  using Strain = std::decay_t<decltype(begin->strain)>;
  constexpr int kStrains = Strain::SizeAtCompileTime;
  const bool is_corrected = rule.correction == EnergyCorrection::Multiplier;
  const bool has_memory = rule.dissipation.any() || element.has_stiffness_damping;
  const bool is_uneven = element.has_stiffness_damping && !element.is_damped_evenly;
  assert(step != 0 && begin && end);
  assert(!has_memory || (memory && end_memory));
  set_translation<Nodes>(element, nodes, rule.velocity_factor(), step, with_tangent, system);
  if (is_corrected) multiplier.set_relative(nodes.increment);
  for (int k = 0; k < Nodes - 1 && is_corrected; ++k)
    multiplier.add(element.points[k].weight, element.section(k), begin[k], end[k], at.points[k]);

  const DamperParts<S> damper_parts(element.stiffness_damping, rule.damping_relaxation);
  for (int i = 0; i < Nodes && has_carried; ++i) system.carried[i].setConstant(S(0));
  for (int k = 0; k < Nodes - 1; ++k) {
    const S& weight = element.points[k].weight;
    const auto& section = element.section(k);
    auto& p = at.points[k];
    p.factor = p.damped_factor = S(0);
    Strain stress = p.own.stress, seen = p.seen.stress;
    const auto add = [&](const auto& damper) {
      stress -= damper.remembered;
      seen -= damper.remembered;
      system.dissipated += weight * damper.dissipated;
    };
    if (rule.dissipation.any()) {
      const NumericalDamper<S, kStrains> damper(rule.dissipation, memory[k], p.own.conjugate_strain, section, step);
      p.factor += damper.factor;
      add(damper);
      end_memory[k].average = damper.average;
    }
    if (is_uneven) {  // D C D, with a factor of its own
      const auto& damped = element.damped_section(k);
      const Strain damped_stress = damped.stress(p.own.conjugate_strain);
      const StructuralDamper<S, kStrains> damper(damper_parts, rule.damping_relaxation, memory[k],
                                                 p.own.conjugate_strain, damped_stress, damped, step);
      p.damped_factor = damper.factor;
      stress += p.damped_factor * damped_stress;
      seen += p.damped_factor * damped.stress(p.seen.conjugate_strain);
      add(damper);
      end_memory[k].delayed_rate = damper.delayed_rate;
    } else if (element.has_stiffness_damping) {
      const StructuralDamper<S, kStrains> damper(damper_parts, rule.damping_relaxation, memory[k],
                                                 p.own.conjugate_strain, p.own.conjugate_stress, section, step);
      p.factor += damper.factor;
      add(damper);
      end_memory[k].delayed_rate = damper.delayed_rate;
    }
    for (int b = k * branches.count; b < (k + 1) * branches.count; ++b) {
      const MaxwellDamper<S, kStrains> damper(branches.coefficients[b - k * branches.count], branches.begin[b],
                                              p.own.conjugate_strain, p.own.conjugate_stress, section);
      p.factor += damper.factor;
      add(damper);
      branches.end[b] = damper.end;
    }
    if (has_memory) end_memory[k].rate = end_rate(memory[k], p.own.conjugate_strain, step);
    const Strain weighted = weight * Strain(stress + p.factor * p.own.conjugate_stress);
    add_resultants(element, k, at, weighted, system.residual);
    if (!with_tangent) continue;
    p.seen_resultants = weight * Strain(seen + p.factor * p.seen.conjugate_stress);
    if (has_carried) add_resultants(element, k, at, Strain(p.seen_resultants - weighted), system.carried);
  }
  if (is_corrected) multiplier.add_moments(system, has_carried);
}

}  // namespace flexarm::conserving
