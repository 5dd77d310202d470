#pragma once
/// Vectors of four numbers, for the loops over the rows of fronts, and memory in whole ones.

#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

// Vectors are passed between functions that are always inlined only: that their passing differs between processors does
// not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace flexarm {

/// Four numbers; two instructions where the processor has vectors of two.
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

/// Of pivots: numbers that have a reciprocal.
constexpr double kSmallestPivot = std::numeric_limits<double>::min(),
                 kLargestPivot = std::numeric_limits<double>::max();

constexpr int lanes_for(int count) {
  return (count + 3) / 4;
}

struct alignas(32) FourNumbers {
  double lane[4];
};
using FrontMemory = std::vector<FourNumbers>;

/// All of them, one behind the other.
inline double* numbers(FrontMemory& memory) {
  return reinterpret_cast<double*>(memory.data());
}
inline const double* numbers(const FrontMemory& memory) {
  return reinterpret_cast<const double*>(memory.data());
}

}  // namespace flexarm
