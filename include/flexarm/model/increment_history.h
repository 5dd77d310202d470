#pragma once
/// What the predictor knows: the increments of the unknowns over the last steps.

#include <array>
#include <vector>

namespace flexarm {

/// Extrapolates increments by the polynomial through the mean velocities of the last steps, at the middles of their
/// intervals; steps may differ in length, and run backwards.
struct IncrementHistory {
  static constexpr int kLength = 4;
  /// The highest order wants kHighestOrder + 1 increments, and one more to be judged by.
  static constexpr int kHighestOrder = kLength - 2;
  using Weights = std::array<double, kLength>;

  std::array<std::vector<double>, kLength> increments;  ///< per equation, newest first [m or rad]
  std::array<double, kLength> steps{};                  ///< over which they were made [s]
  int count = 0;                                        ///< of increments that hold
  int order = 0;                                        ///< of the polynomial that foresaw the newest one best

  void clear() { count = order = 0; }
  /// Makes room for the increments of a step, to be written into the vector that is returned.
  std::vector<double>& push(double step, std::size_t unknowns);
  /// Of `increments[first], ...` in the extrapolation of that order to the step that follows them. All zero where the
  /// history is too short, or the extrapolation would blow up what is rough in it.
  Weights weights(int order, int first, double step) const;
};

}  // namespace flexarm
