#pragma once
/// Normally distributed numbers that are the same with every compiler and library.

#include <cmath>
#include <cstdint>
#include <random>

#include "math/pi.h"

namespace flexarm {

/// A sequence of independent numbers with mean 0 and standard deviation 1, by the Box-Muller transform. It replaces
/// std::normal_distribution, which differs between standard libraries. Does not allocate.
class NormalNoise {
 public:
  explicit NormalNoise(std::uint64_t seed) : engine_(mixed(seed)) {}

  double next() {
    const double radius = std::sqrt(-2 * std::log(uniform())), angle = 2 * kPi * uniform();
    return radius * std::cos(angle);
  }

  /// Returns a seed for the engine. Consecutive seeds give unrelated ones (the finaliser of SplitMix64).
  static std::uint64_t mixed(std::uint64_t seed) {
    seed += 0x9e3779b97f4a7c15u;
    seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9u;
    seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebu;
    return seed ^ (seed >> 31);
  }

 private:
  /// Returns a uniformly distributed number in (0, 1): the middle of one of 2^53 intervals.
  double uniform() { return std::ldexp(static_cast<double>(engine_() >> 11) + 0.5, -53); }

  std::mt19937_64 engine_;
};

}  // namespace flexarm
