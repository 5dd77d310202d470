#pragma once
/// Frequencies, and how far responses of linear models are apart over them.

#include <algorithm>
#include <cmath>
#include <vector>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::test {

/// Numbers at equal ratios.
inline std::vector<double> logarithmic(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from * std::pow(to / from, double(i) / (count - 1)));
  return values;
}

/// The largest singular value of the difference of two models' gains at these frequencies [Hz].
inline double largest_error(const LinearModel& whole, const LinearModel& small,
                            const std::vector<double>& frequencies) {
  const FrequencyResponse expected = frequency_response(whole, frequencies),
                          got = frequency_response(small, frequencies);
  double largest = 0;
  for (std::size_t n = 0; n < frequencies.size(); ++n) {
    // Largest singular value of the error, by power iteration with error^H error.
    const Eigen::MatrixXcd error = got.gains[n] - expected.gains[n], square = error.adjoint() * error;
    Eigen::VectorXcd direction = Eigen::VectorXcd::Ones(square.cols());
    double value = 0;
    for (int k = 0; k < 50; ++k) {
      direction = square * direction;
      value = direction.norm();
      if (value == 0) break;
      direction /= value;
    }
    largest = std::max(largest, std::sqrt(value));
  }
  return largest;
}

}  // namespace flexarm::test
