#pragma once
/// Do strains change when a rigid rotation is superposed on a deformation?

#include "bench/variants.h"

namespace flexarm::bench {

/// Largest change of the curvature at the stiffness points of a bent and twisted three-node element, relative to the
/// largest curvature, when its nodes are led in two steps of two iterates each to the same rotations, once as they are
/// and once with a rigid rotation that grows to 1.2 rad (Muñoz 2004, sec. 5.2-5.3). By the interpolation of the scheme.
double strain_change(const Variant& variant);

}  // namespace flexarm::bench
