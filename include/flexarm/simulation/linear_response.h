#pragma once
/// Responses of linear models over frequency and over time.

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/model/run_event.h"
#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// Amplitudes and phases of the outputs in the steady state: if the input j is Re(exp(2 pi i f t)), the output k is
/// Re(gains(k, j) exp(2 pi i f t)).
struct FrequencyResponse {
  std::vector<double> frequencies;      ///< f [Hz]
  std::vector<Eigen::MatrixXcd> gains;  ///< c (2 pi i f - a)^-1 b + d of each, outputs x inputs
};
/// @throws std::invalid_argument if a frequency is not finite, or the matrices of the model are not of one size;
/// std::runtime_error at a frequency of an undamped pole, where there is no such response.
FrequencyResponse frequency_response(const LinearModel& model, const std::vector<double>& frequencies);

/// Outputs after one input went from 0 to 1 at time 0, from rest.
struct StepResponse {
  std::vector<double> times;             ///< [s]
  std::vector<Eigen::MatrixXd> outputs;  ///< at each of them, outputs x inputs: by each input alone
};
/// At time 0 and at the ends of `intervals` equal parts of the time to `until` [s], exact but for round-off.
/// @throws std::invalid_argument if `until` is not > 0 and finite, `intervals` < 1, or the matrices of the model are
/// not of one size; std::runtime_error if it grows beyond all numbers.
StepResponse step_response(const LinearModel& model, double until, int intervals);

/// Derivatives of the run that led to the instant of a model (simulation/sensitivities.h).
struct RunDerivatives {
  std::vector<std::string> parameters;
  Eigen::MatrixXd states, outputs;          ///< of the model's, by the parameters
  std::vector<std::string> initial_states;  ///< of a model about the start
  Eigen::MatrixXd transition;               ///< states by them
  std::vector<RunEvent> events;             ///< that the run came over
};

/// What is written beside a model; empty if it was not asked for.
struct LinearResponses {
  FrequencyResponse frequency;
  StepResponse step;
  RunDerivatives derivatives = {};
};

}  // namespace flexarm
