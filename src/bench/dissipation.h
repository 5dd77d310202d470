#pragma once
/// Numerical dissipation of a linear oscillator.

#include <vector>

#include "bench/run.h"

namespace flexarm::bench {

struct DissipationPoint {
  double frequency;        ///< omega h, angular frequency times step [rad]
  double spectral_radius;  ///< factor of the amplitude per step
  /// Part of the energy that is lost in a true period, 2 pi / omega.
  double loss_per_period() const;
};

/// Free decay of a bar of one element that vibrates along its axis: half the least-squares slope of the logarithm of
/// the energy over up to 400 steps, summed over a motion that starts with a displacement and one that starts with a
/// velocity.
Measured<DissipationPoint> dissipation(const Variant& variant, double frequency, bool quick);

/// Values of omega h for the picture, from 0.05 to 100, equally spaced in the logarithm.
std::vector<double> dissipation_frequencies(bool quick);

}  // namespace flexarm::bench
