#pragma once
/// Leaves out round-off in tables that people read. Files keep all digits.

#include <cmath>

namespace flexarm::cli {

/// `value`, or 0 if it is at most the part `error` of the size that such values have. By default this is the round-off
/// of a few thousand operations.
inline double without_round_off(double value, double size, double error = 1e-12) {
  return std::abs(value) <= error * size ? 0.0 : value;
}

}  // namespace flexarm::cli
