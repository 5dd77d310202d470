#pragma once

#include <cmath>

namespace flexarm::test {

/// Order of convergence seen between two meshes or steps, the second twice as fine.
inline double observed_order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

}  // namespace flexarm::test
