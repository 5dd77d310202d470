#pragma once
/// The observed order of convergence, for tests.

#include <cmath>

namespace flexarm::test {

/// Order of convergence between two meshes or steps, the second of which is twice as fine.
inline double observed_order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

}  // namespace flexarm::test
