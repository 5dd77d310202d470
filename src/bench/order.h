#pragma once
/// Measures the order of convergence in time.

#include "bench/run.h"

namespace flexarm::bench {

struct OrderInTime {
  double slope = 0;  ///< of log(error) over log(step), between the two finer of three steps
  double error = 0;  ///< at the coarsest step, relative to the largest displacement
};

/// Compares the positions of probes on a loaded 3D tree with joints (loaded_tree), with steps of 20, 10 and 5 ms, with
/// their limit. Richardson extrapolation gives this limit from 2.5 and 1.25 ms, with the order that the scheme claims.
Measured<OrderInTime> order_in_time(const Variant& variant, bool quick);

}  // namespace flexarm::bench
