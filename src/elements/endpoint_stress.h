#pragma once
/// Stress at a point of a beam in statics and in Newmark's family, in space and in the plane.

#include "elements/newmark_rule.h"

namespace flexarm {

/// `Stiffness`: of the section, symmetric, 6 x 6; in the plane 3 x 3, of doubles or of packs.
template <class Stiffness>
struct EndpointStress {
  using S = typename Stiffness::Scalar;
  using Vector = Eigen::Matrix<S, Stiffness::RowsAtCompileTime, 1>;

  Vector stress, strain_rate;
  S slope = S(1);       ///< d(stress)/d(strain) = stiffness + (slope - 1) damped
  S dissipated = S(0);  ///< over the step [J/m]

  /// Without damping.
  EndpointStress(const Stiffness& stiffness, const Vector& strain)
      : stress(stiffness * strain), strain_rate(Vector::Constant(S(0))) {}

  /// Adds stiffness-proportional damping by the strain rate at t_{n+1+alpha}. `damping`: eta of
  /// BeamElement::stiffness_damping; `damped`: D C D of the same. `begin`, `begin_rate`: at the beginning of the step.
  void add_damping(const S& damping, const Stiffness& damped, const Vector& strain, const Vector& begin,
                   const Vector& begin_rate, const NewmarkRule& rule) {
    const Vector increment = (strain - begin) / S(1 + rule.alpha);
    strain_rate = (increment / S(rule.step) - S(1 - rule.gamma) * begin_rate) / S(rule.gamma);
    const Vector rate = S(1 + rule.alpha) * strain_rate - S(rule.alpha) * begin_rate;
    const Vector damping_stress = damping * (damped * rate);
    stress += damping_stress;
    slope += damping / S(rule.gamma * rule.step);
    dissipated = damping_stress.dot(increment);
  }
};

}  // namespace flexarm
