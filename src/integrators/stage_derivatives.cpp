#include "integrators/stage_derivatives.h"

#include <cmath>

#include "math/pi.h"

namespace flexarm {
namespace {

constexpr int kSamples = StageDerivatives::kSamples;

/// Places of samples within a step: Chebyshev's points, in (-1, 1).
double sample_place(int sample) {
  return -std::cos((2 * sample + 1) * kPi / (2 * kSamples));
}

/// Sets the weights of samples in the derivatives of their polynomial at x, by Chebyshev's polynomials T_n: of the
/// first and of the second derivative.
void set_weights(double x, StageDerivatives::Samples& first, StageDerivatives::Samples& second) {
  // T and its derivatives at x by their recursion.
  double value[kSamples] = {1, x}, slope[kSamples] = {0, 1}, bend[kSamples] = {};
  for (int n = 2; n < kSamples; ++n) {
    value[n] = 2 * x * value[n - 1] - value[n - 2];
    slope[n] = 2 * value[n - 1] + 2 * x * slope[n - 1] - slope[n - 2];
    bend[n] = 4 * slope[n - 1] + 2 * x * bend[n - 1] - bend[n - 2];
  }
  first.fill(0), second.fill(0);
  for (int i = 0; i < kSamples; ++i)
    for (int n = 1; n < kSamples; ++n) {
      const double share = 2.0 / kSamples * std::cos(n * std::acos(sample_place(i)));
      first[i] += share * slope[n], second[i] += share * bend[n];
    }
}

}  // namespace

StageDerivatives::StageDerivatives(const ExplicitTableau& tableau) {
  std::vector<double> times = tableau.times;
  times.push_back(1);
  first_weights_.resize(times.size()), second_weights_.resize(times.size());
  for (std::size_t s = 0; s < times.size(); ++s) set_weights(2 * times[s] - 1, first_weights_[s], second_weights_[s]);
}

void StageDerivatives::sample(const TimeFunction& function, double begin, double step, Samples& samples) {
  for (int i = 0; i < kSamples; ++i) samples[i] = function(begin + 0.5 * (1 + sample_place(i)) * step);
}

double StageDerivatives::operator()(int order, std::size_t stage, const Samples& samples, double step) const {
  const Samples& weights = order == 1 ? first_weights_[stage] : second_weights_[stage];
  // The weights sum to 0 only up to round-off, which 4/h^2 magnifies. So a constant is taken out first.
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) sum += weights[i] * (samples[i] - samples[0]);
  return sum * std::pow(2 / step, order);
}

}  // namespace flexarm
