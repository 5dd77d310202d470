#pragma once
/// Measures the drift of the invariants of a free flight.

#include "bench/run.h"

namespace flexarm::bench {

/// Largest changes since the start: of the energy relative to the largest energy, of the linear momentum relative to
/// sqrt(2 m T), and of the angular momentum relative to itself.
struct InvariantDrift {
  double energy = 0;  ///< kinetic and strain
  double growth = 0;  ///< largest rise of the energy above an earlier value
  double linear_momentum = 0, angular_momentum = 0;
};

/// free_tree, 2000 steps of 10 ms.
Measured<InvariantDrift> invariant_drift(const Variant& variant, bool quick);

}  // namespace flexarm::bench
