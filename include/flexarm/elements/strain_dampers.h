#pragma once
/// Dampers with a memory at a stiffness point of the energy-momentum family. Over a step in which the strain grows by
/// s, each adds factor C s - remembered to the stress. (docs/schemes.md, "Numerical dissipation", "Structural damping")

#include "flexarm/elements/conserving_element.h"
#include "flexarm/elements/time_rule.h"

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

/// The stress eta C (strain rate), by three passive parts side by side with a relaxation time h_0: three quarters of it
/// a dashpot, one a dashpot behind a spring, which feels the delayed rate q, and an inertance h_0/4,
///   eta C [3/4 s/h + 1/4 q_mean + h_0/(4 h) (w_1 - w_0)],   q_mean + (h_0/h) (q_1 - q_0) = s/h.
/// A dashpot alone would leave the strain of a mode that it damps strongly nearly as it is and make its velocity change
/// the sign in every step. This one brings both to rest in a few. eta h_0/8 (w.Cw + q.Cq) is stored.
template <typename S>
struct StructuralDamper {
  S factor, dissipated;  // [-], [J/m]
  Vector6T<S> remembered, delayed_rate;

  /// `viscosity` eta, `relaxation` h_0 [s]; `stress` C s.
  StructuralDamper(const S& viscosity, double relaxation, const StrainMemoryT<S>& begin, const Vector6T<S>& s,
                   const Vector6T<S>& stress, const SectionStiffness<S>& stiffness, double step) {
    const double follows = 1 / (step + 2 * relaxation);
    const Vector6T<S> delayed = S(follows) * (s + S(2 * relaxation) * begin.delayed_rate);
    factor = viscosity * S(0.75 / step + 0.25 * follows + 0.5 * relaxation / (step * step));
    remembered = viscosity * stiffness.stress(S(0.5 * relaxation / step) * begin.rate -
                                              S(0.5 * relaxation * follows) * begin.delayed_rate);
    dissipated =
        viscosity * (S(0.75 / step) * dot6(s, stress) + S(0.25 * step) * dot6(delayed, stiffness.stress(delayed)));
    delayed_rate = S(2) * delayed - begin.delayed_rate;
  }
};

}  // namespace flexarm::conserving
