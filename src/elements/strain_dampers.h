#pragma once
/// Dampers with a memory at a stiffness point of the energy-momentum family. Over a step in which the strain grows by
/// s, each adds factor C s - remembered to the stress. (docs/schemes.md, "Numerical dissipation", "Structural damping")

#include "elements/conserving_element.h"
#include "schemes/time_rule.h"

namespace flexarm::conserving {

/// The strain rate at the end: (w_0 + w_1)/2 = s/h.
template <typename S>
Vector6T<S> end_rate(const StrainMemoryT<S>& begin, const Vector6T<S>& s, double step) {
  return S(2 / step) * s - begin.rate;
}

/// See NumericalDissipation.
template <typename S>
struct NumericalDamper {
  S factor, dissipated;  // [-], [J/m]
  Vector6T<S> remembered, average;

  NumericalDamper(const NumericalDissipation& d, const StrainMemoryT<S>& begin, const Vector6T<S>& s,
                  const SectionStiffness<S>& stiffness, double step)
      : factor(d.stiffness + 2 * d.inertance / (step * step)) {
    const Vector6T<S> deviation = s - begin.average;
    remembered = stiffness.stress(S(d.stiffness) * begin.average + S(2 * d.inertance / step) * begin.rate);
    dissipated = S(d.stiffness * (1 - 0.5 * d.forgetting)) * dot6(deviation, stiffness.stress(deviation));
    average = begin.average + S(d.forgetting) * deviation;
  }
};

/// What takes the place of the viscosity eta, three passive parts side by side: a dashpot, a dashpot behind a spring
/// that relaxes with the time h_0, and an inertance. The last two grow with eta until it is h_0.
template <typename S>
struct DamperParts {
  S dashpot, delayed, inertance;  // [s], [s], [s^2]

  DamperParts(const S& viscosity, double relaxation) {
    using std::abs;
    const S least = S(0.5) * (viscosity + S(relaxation) - abs(viscosity - S(relaxation)));  // of eta and h_0
    delayed = relaxation > 0 ? S(0.25 / relaxation) * viscosity * least : S(0);
    inertance = S(relaxation) * delayed;
    dashpot = viscosity - delayed;
  }
};

/// The stress eta C (strain rate) by these parts: with the delayed rate q,
///   C [dashpot s/h + inertance (w_1 - w_0)/h + delayed q_mean],   q_mean + (h_0/h) (q_1 - q_0) = s/h.
/// A dashpot alone would leave the strain of a mode that it damps strongly nearly as it is and make its velocity change
/// the sign in every step. These bring both to rest. inertance (w.Cw + q.Cq)/2 is stored.
template <typename S>
struct StructuralDamper {
  S factor, dissipated;  // [-], [J/m]
  Vector6T<S> remembered, delayed_rate;

  /// `stress` C s; `relaxation` h_0 [s].
  StructuralDamper(const DamperParts<S>& parts, double relaxation, const StrainMemoryT<S>& begin, const Vector6T<S>& s,
                   const Vector6T<S>& stress, const SectionStiffness<S>& stiffness, double step) {
    const double follows = 1 / (step + 2 * relaxation);
    const Vector6T<S> delayed = S(follows) * (s + S(2 * relaxation) * begin.delayed_rate);
    factor = parts.dashpot * S(1 / step) + parts.inertance * S(2 / (step * step)) + parts.delayed * S(follows);
    remembered = stiffness.stress((parts.inertance * S(2 / step)) * begin.rate -
                                  (parts.delayed * S(2 * relaxation * follows)) * begin.delayed_rate);
    dissipated = parts.dashpot * S(1 / step) * dot6(s, stress) +
                 parts.delayed * S(step) * dot6(delayed, stiffness.stress(delayed));
    delayed_rate = S(2) * delayed - begin.delayed_rate;
  }
};

}  // namespace flexarm::conserving
