#include "flexarm/simulation/linear_response.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "math/hessenberg.h"
#include "math/matrix_exponential.h"
#include "math/pi.h"
#include "simulation/linear_scaling.h"

namespace flexarm {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

FrequencyResponse frequency_response(const LinearModel& model, const std::vector<double>& frequencies) {
  const ScaledStates scaled = scaled_states(model);
  const Hessenberg form = hessenberg(scaled.a);
  const MatrixXcd inputs = (form.basis.transpose() * scaled.b).cast<Complex>();
  const MatrixXcd outputs = (scaled.c * form.basis).cast<Complex>(), direct = model.d.cast<Complex>();
  FrequencyResponse response{frequencies, {}};
  for (const double frequency : frequencies) {
    if (!std::isfinite(frequency))
      throw std::invalid_argument(fmt::format("frequencies: expected finite numbers [Hz], got {}", frequency));
    const MatrixXcd states = shifted_solution(form.reduced, {0, 2 * kPi * frequency}, inputs);
    if (!states.allFinite()) throw std::runtime_error(fmt::format("there is an undamped pole at {} Hz", frequency));
    response.gains.push_back(outputs * states + direct);
  }
  return response;
}

StepResponse step_response(const LinearModel& model, double until, int intervals) {
  if (!(until > 0 && std::isfinite(until)))
    throw std::invalid_argument(fmt::format("until: expected a time > 0, got {}", until));
  if (intervals < 1) throw std::invalid_argument(fmt::format("intervals: expected a number >= 1, got {}", intervals));
  // Add the constant inputs as states with zero rate: then exp([a b; 0 0] t) contains their effect on the other states.
  const ScaledStates scaled = scaled_states(model);
  const Eigen::Index count = scaled.a.rows(), inputs = scaled.b.cols();
  const double interval = until / intervals;
  MatrixXd rates = MatrixXd::Zero(count + inputs, count + inputs);
  rates.topRows(count) << scaled.a * interval, scaled.b * interval;
  const MatrixXd change = matrix_exponential_less_identity(rates).topRows(count);
  StepResponse response;
  MatrixXd states = MatrixXd::Zero(count, inputs);
  for (int n = 0; n <= intervals; ++n) {
    if (n > 0) states += (change.leftCols(count) * states + change.rightCols(inputs)).eval();
    if (!states.allFinite()) throw std::runtime_error(fmt::format("the response overflows within {} s", until));
    response.times.push_back(n == intervals ? until : n * interval);
    response.outputs.push_back(scaled.c * states + model.d);
  }
  return response;
}

}  // namespace flexarm
