#include "elements/maxwell.h"

#include <algorithm>
#include <cmath>

namespace flexarm {
namespace {

/// Returns (1 - (1 - exp(-r)) / r) / r, the sum of (-r)^k / (k + 2)!.
double mean_of_ramp(double r, double gains) {
  if (std::abs(r) > 0.5) return (1 - gains) / r;
  double term = 0.5, sum = 0;
  for (int k = 0; std::abs(term) > 1e-18; ++k) {
    sum += term;
    term *= -r / (k + 3);
  }
  return sum;
}

}  // namespace

MaxwellCoefficients<double> maxwell_coefficients(const MaxwellBranch& branch, double step) {
  MaxwellCoefficients<double> out;
  out.modulus_ratio = branch.modulus_ratio;
  constexpr double kLargest = 1e100;  // so that its products with the other coefficients are finite
  const double r = out.flow = std::min(step / branch.relaxation_time, kLargest);
  out.keeps = std::exp(-r);
  out.gains = r == 0 ? 1 : -std::expm1(-r) / r;
  out.yields = mean_of_ramp(r, out.gains);
  out.excess = std::abs(r) < 1e-4 ? r / 12 : out.yields / out.gains - 0.5;  // the rest of the series is round-off
  return out;
}

}  // namespace flexarm
