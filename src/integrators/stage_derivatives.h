#pragma once
/// Derivatives of functions of time at the stages of a step of an explicit scheme. (docs/notes/explicit.md 4)

#include <array>
#include <vector>

#include "flexarm/math/time_function.h"
#include "schemes/explicit_tableau.h"

namespace flexarm {

/// The derivatives are those of a polynomial through ten values within the step, with errors of the powers 9 (first)
/// and 8 (second derivative) of the step. So they never look across its ends, where functions may jump.
class StageDerivatives {
 public:
  static constexpr int kSamples = 10;
  using Samples = std::array<double, kSamples>;

  explicit StageDerivatives(const ExplicitTableau& tableau);

  /// Values of a function at the places of the samples in a step.
  static void sample(const TimeFunction& function, double begin, double step, Samples& samples);
  /// The derivative of order 1 or 2. `stage`: of the tableau, or their number for the end of the step.
  double operator()(int order, std::size_t stage, const Samples& samples, double step) const;

 private:
  std::vector<Samples> first_weights_, second_weights_;  // per stage and at the end
};

}  // namespace flexarm
