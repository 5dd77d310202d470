#include "flexarm/simulation/linear_response.h"

#include <stdexcept>

#include <fmt/format.h>

#include "math/hessenberg.h"
#include "math/matrix_exponential.h"
#include "math/pi.h"

namespace flexarm {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

FrequencyResponse frequency_response(const LinearModel& model, const std::vector<double>& frequencies) {
  const Balanced balanced = flexarm::balanced(model.a);
  const Hessenberg form = hessenberg(balanced.matrix);
  const MatrixXcd inputs =
      (form.basis.transpose() * balanced.scales.cwiseInverse().asDiagonal() * model.b).cast<Complex>();
  const MatrixXcd outputs = (model.c * balanced.scales.asDiagonal() * form.basis).cast<Complex>(),
                  direct = model.d.cast<Complex>();
  FrequencyResponse response{frequencies, {}};
  for (const double frequency : frequencies) {
    const MatrixXcd states = shifted_solution(form.reduced, {0, 2 * kPi * frequency}, inputs);
    if (!states.allFinite()) throw std::runtime_error(fmt::format("there is an undamped pole at {} Hz", frequency));
    response.gains.push_back(outputs * states + direct);
  }
  return response;
}

StepResponse step_response(const LinearModel& model, double until, int intervals) {
  if (!(until > 0)) throw std::invalid_argument(fmt::format("until: expected a time > 0, got {}", until));
  if (intervals < 1) throw std::invalid_argument(fmt::format("intervals: expected a number >= 1, got {}", intervals));
  // Constant inputs are states that stay: exp([a b; 0 0] t) has what they make of the others.
  const Eigen::Index count = model.a.rows(), inputs = model.b.cols();
  const double interval = until / intervals;
  MatrixXd rates = MatrixXd::Zero(count + inputs, count + inputs);
  rates.topRows(count) << model.a * interval, model.b * interval;
  const MatrixXd advance = matrix_exponential(rates).topRows(count);
  StepResponse response;
  MatrixXd states = MatrixXd::Zero(count, inputs);
  for (int n = 0; n <= intervals; ++n) {
    if (n > 0) states = (advance.leftCols(count) * states + advance.rightCols(inputs)).eval();
    if (!states.allFinite())
      throw std::runtime_error(fmt::format("the response grows beyond all numbers in {} s", until));
    response.times.push_back(n == intervals ? until : n * interval);
    response.outputs.push_back(model.c * states + model.d);
  }
  return response;
}

}  // namespace flexarm
