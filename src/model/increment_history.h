#pragma once
/// The increments of the unknowns over the last steps, from which the predictor extrapolates the next one, and from
/// which published velocities follow.

#include <array>
#include <vector>

namespace flexarm {

/// Extrapolates with the polynomial through the ends of the last steps. Steps may have different lengths and run
/// backwards.
struct IncrementHistory {
  static constexpr int kLength = 5;  ///< as many as published velocities need
  /// Orders of extrapolation. Order 0 repeats the last velocity. kNoMotion predicts no motion at all, which is best if
  /// the step is longer than the periods of the motion. The highest order needs kHighestOrder + 1 increments, and one
  /// more to be judged by.
  static constexpr int kNoMotion = -1, kHighestOrder = 2;
  using Weights = std::array<double, kHighestOrder + 2>;

  std::array<std::vector<double>, kLength> increments;  ///< per equation, newest first [m or rad]
  std::array<double, kLength> steps{};                  ///< length of each step [s]
  int count = 0;                                        ///< number of valid increments
  int order = 0;                                        ///< order that would have predicted the newest increment best

  void clear() { count = order = 0; }
  /// False if the history is empty or has another number of unknowns.
  bool holds_for(std::size_t unknowns) const;
  /// Adds a step, dropping the oldest one. Returns the vector into which the caller must write the step's increments.
  std::vector<double>& push(double step, std::size_t unknowns);
  /// Returns the weights of `increments[first], ...` in the extrapolation of that order over the next step of length
  /// `step`. All are zero if the history is too short, or if the extrapolation would amplify noise too much.
  Weights weights(int order, int first, double step) const;
};

}  // namespace flexarm
