#pragma once
/// What the predictor knows: the increments of the unknowns over the last steps.

#include <array>
#include <vector>

namespace flexarm {

/// Extrapolates by the polynomial through the ends of the last steps; these may differ in length, and run backwards.
struct IncrementHistory {
  static constexpr int kLength = 4;
  /// The order counts from repeating the last velocity, 0; below it is no motion at all, the best guess where a step is
  /// longer than what moves. The highest order wants kHighestOrder + 1 increments, and one more to be judged by.
  static constexpr int kNoMotion = -1, kHighestOrder = kLength - 2;
  using Weights = std::array<double, kLength>;

  std::array<std::vector<double>, kLength> increments;  ///< per equation, newest first [m or rad]
  std::array<double, kLength> steps{};                  ///< over which they were made [s]
  int count = 0;                                        ///< of increments that hold
  int order = 0;                                        ///< of the extrapolation that foresaw the newest one best

  void clear() { count = order = 0; }
  /// False if it is empty or belongs to another number of unknowns.
  bool holds_for(std::size_t unknowns) const;
  /// Makes room for the increments of a step, to be written into the vector that is returned.
  std::vector<double>& push(double step, std::size_t unknowns);
  /// Weights of `increments[first], ...` in the extrapolation of that order to the step that follows them. All zero
  /// where the history is too short, or the extrapolation would blow up what is rough in it.
  Weights weights(int order, int first, double step) const;
};

}  // namespace flexarm
