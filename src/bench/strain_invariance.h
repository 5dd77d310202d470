#pragma once
/// Measures whether strains change when a rigid rotation is superposed on a deformation.

#include "bench/variants.h"

namespace flexarm::bench {

/// Largest change of the curvature at the stiffness points of a bent and twisted three-node element, relative to the
/// largest curvature. The nodes reach the same rotations in two steps of two iterates each, once as they are and once
/// with a superposed rigid rotation that grows to 1.2 rad (Muñoz 2004, sec. 5.2-5.3). Uses the scheme's interpolation.
double strain_change(const Variant& variant);

}  // namespace flexarm::bench
