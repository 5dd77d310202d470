#include "flexarm/simulation/linear_response.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "math/hessenberg.h"
#include "math/long_product.h"
#include "math/matrix_exponential.h"
#include "math/pi.h"
#include "simulation/linear_scaling.h"

namespace flexarm {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

namespace {

/// Two refinements give all digits, unless a pole is very near. One that is not below kContraction times the one before
/// is round-off.
constexpr int kMostRefinements = 3;
constexpr double kContraction = 0.5;

/// Solves (i w - a) x = b, outputs c x + d. Elimination in Hessenberg form is fast, but has errors relative to the
/// largest parts of x: outputs lose their digits where the contributions of several modes cancel. So the solution is
/// refined in the states of the model itself, by residuals with 64 bits of mantissa.
class RefinedResponse {
 public:
  explicit RefinedResponse(const LinearModel& model) : model_(model) {
    const ScaledStates scaled = scaled_states(model);
    Hessenberg form = hessenberg(scaled.a);
    reduced_ = std::move(form.reduced);
    basis_ = (scaled.basis * form.basis).cast<Complex>();
    inverse_ = (form.basis.transpose() * scaled.inverse).cast<Complex>();
  }

  /// Not finite at an undamped pole.
  MatrixXcd gains(double rate) const {
    MatrixXcd scaled = solution(rate, model_.b.cast<Complex>()), states = basis_ * scaled;
    double last = scaled.norm();
    for (int n = 0; n < kMostRefinements && states.allFinite(); ++n) {
      scaled = solution(rate, residual(rate, states));
      const double way = scaled.norm();
      if (!(way < kContraction * last)) break;
      states += basis_ * scaled;
      last = way;
    }
    return model_.c.cast<Complex>() * states + model_.d.cast<Complex>();
  }

 private:
  /// In the scaled states, of which basis_ makes those of the model.
  MatrixXcd solution(double rate, const MatrixXcd& rights) const {
    return shifted_solution(reduced_, {0, rate}, inverse_ * rights);
  }
  /// b - (i rate - a) states.
  MatrixXcd residual(double rate, const MatrixXcd& states) const {
    const MatrixXd real = states.real(), imaginary = states.imag();
    const auto w = static_cast<long double>(rate);
    MatrixXcd out(states.rows(), states.cols());
    out.real() = (model_.b.cast<long double>() + w * imaginary.cast<long double>() + long_product(model_.a, real))
                     .cast<double>();
    out.imag() = (long_product(model_.a, imaginary) - w * real.cast<long double>()).cast<double>();
    return out;
  }

  const LinearModel& model_;
  MatrixXd reduced_;           // the Hessenberg form of a, in the states scaled = inverse_ states
  MatrixXcd basis_, inverse_;  // real
};

}  // namespace

FrequencyResponse frequency_response(const LinearModel& model, const std::vector<double>& frequencies) {
  const RefinedResponse refined(model);
  FrequencyResponse response{frequencies, {}};
  response.gains.reserve(frequencies.size());
  for (const double frequency : frequencies) {
    if (!std::isfinite(frequency))
      throw std::invalid_argument(fmt::format("frequencies: expected finite numbers [Hz], got {}", frequency));
    response.gains.push_back(refined.gains(2 * kPi * frequency));
    if (!response.gains.back().allFinite())
      throw std::runtime_error(fmt::format("there is an undamped pole at {} Hz", frequency));
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
    response.times.push_back(until * n / intervals);
    response.outputs.push_back(scaled.c * states + model.d);
  }
  return response;
}

}  // namespace flexarm
