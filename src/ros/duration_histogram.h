#pragma once
/// A histogram of durations, for quantiles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace flexarm::node {

/// Counts durations in classes from 0.1 us to 7 min. The upper bound of a class is 2^(1/8) (9 %) above its lower bound.
class DurationHistogram {
 public:
  void add(double seconds) {
    ++counts_[class_of(seconds)];
    ++total_;
    largest_ = std::max(largest_, seconds);
  }
  void clear() { *this = {}; }

  std::uint64_t count() const { return total_; }
  double largest() const { return largest_; }  ///< [s]
  /// The duration that a fraction `part` (0 to 1) of all durations does not exceed, rounded up to the bound of a class
  /// [s]. 0 if there are no durations.
  double quantile(double part) const {
    const double wanted = part * static_cast<double>(total_);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      sum += counts_[i];
      if (sum > 0 && static_cast<double>(sum) >= wanted)
        return std::min(kLeast * std::exp2(static_cast<double>(i + 1) / kPerOctave), largest_);
    }
    return largest_;
  }

 private:
  static constexpr double kLeast = 1e-7;  // s
  static constexpr int kPerOctave = 8, kClasses = 32 * kPerOctave;

  static std::size_t class_of(double seconds) {
    const double octaves = seconds > kLeast ? std::log2(seconds / kLeast) : 0;
    return static_cast<std::size_t>(std::min(octaves * kPerOctave, kClasses - 1.0));
  }

  std::array<std::uint64_t, kClasses> counts_{};
  std::uint64_t total_ = 0;
  double largest_ = 0;
};

}  // namespace flexarm::node
