#pragma once
/// Measures the numerical dissipation of a linear oscillator.

#include <vector>

#include "bench/run.h"

namespace flexarm::bench {

struct DissipationPoint {
  double frequency;        ///< omega h: angular frequency times step [rad]
  double spectral_radius;  ///< factor by which the amplitude changes per step
  /// Fraction of the energy that is lost in a period of the exact motion, 2 pi / omega.
  double loss_per_period() const;
};

/// Measures the free decay of a bar of one element that vibrates axially. The result is half the least-squares slope of
/// the logarithm of the energy over up to 400 steps. The energy is the sum of two motions, of which one starts with a
/// displacement and the other with a velocity.
Measured<DissipationPoint> dissipation(const Variant& variant, double frequency, bool quick);

/// Values of omega h for the picture, from 0.05 to 100, equally spaced in the logarithm.
std::vector<double> dissipation_frequencies(bool quick);

}  // namespace flexarm::bench
