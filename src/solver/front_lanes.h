#pragma once
/// Vectors of four numbers for the loops over rows of fronts, and memory in multiples of four numbers.

#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

// The warning concerns vectors as function arguments, which are passed in different ways by different processors. Here
// all such functions are always inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace flexarm {

/// Four numbers; on processors with vectors of two numbers, the compiler uses two instructions.
using Lanes = double __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
[[gnu::always_inline]] inline void store(const Lanes& lanes, double* to) {
  std::memcpy(to, &lanes, sizeof(lanes));
}
[[gnu::always_inline]] inline Lanes broadcast(double value) {
  return Lanes{value, value, value, value};
}

/// Limits of pivots: numbers that have a reciprocal.
constexpr double kSmallestPivot = std::numeric_limits<double>::min(),
                 kLargestPivot = std::numeric_limits<double>::max();

constexpr int lanes_for(int count) {
  return (count + 3) / 4;
}

struct alignas(32) FourNumbers {
  double lane[4];
};
using FrontMemory = std::vector<FourNumbers>;

/// The memory as a contiguous array of numbers.
inline double* numbers(FrontMemory& memory) {
  return reinterpret_cast<double*>(memory.data());
}
inline const double* numbers(const FrontMemory& memory) {
  return reinterpret_cast<const double*>(memory.data());
}

}  // namespace flexarm
