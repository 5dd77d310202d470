#pragma once
/// Frequency responses and step responses of linear models.

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/model/run_event.h"
#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// Complex gains from inputs to outputs in the steady state: if input j is Re(exp(2 pi i f t)), output k is
/// Re(gains(k, j) exp(2 pi i f t)).
struct FrequencyResponse {
  std::vector<double> frequencies;      ///< f [Hz]
  std::vector<Eigen::MatrixXcd> gains;  ///< c (2 pi i f - a)^-1 b + d for each f, outputs x inputs
};
/// @throws std::invalid_argument if a frequency is not finite, or if the sizes of the model's matrices do not match;
/// std::runtime_error at the frequency of an undamped pole, where no steady state exists.
FrequencyResponse frequency_response(const LinearModel& model, const std::vector<double>& frequencies);

/// Responses, from rest, to an input that jumps from 0 to 1 at time 0.
struct StepResponse {
  std::vector<double> times;             ///< [s]
  std::vector<Eigen::MatrixXd> outputs;  ///< for each time, outputs x inputs; column j: only input j jumps
};
/// Computes the response at time 0 and at the ends of `intervals` equal parts of the time to `until` [s]. It is exact
/// apart from round-off.
/// @throws std::invalid_argument if `until` is not > 0 and finite, `intervals` < 1, or the sizes of the model's
/// matrices do not match; std::runtime_error if the response overflows.
StepResponse step_response(const LinearModel& model, double until, int intervals);

/// Derivatives of the run that led to the state about which a model is linearised (simulation/sensitivities.h).
struct RunDerivatives {
  std::vector<std::string> parameters;
  Eigen::MatrixXd states, outputs;          ///< derivatives of the model's states and outputs: rows x parameters
  std::vector<std::string> initial_states;  ///< states of a linear model about the start of the run
  Eigen::MatrixXd transition;               ///< derivatives of the states by the initial states
  std::vector<RunEvent> events;             ///< events of the run
};

/// Results that are written together with a linear model. Parts that were not requested are empty.
struct LinearResponses {
  FrequencyResponse frequency;
  StepResponse step;
  RunDerivatives derivatives = {};
};

}  // namespace flexarm
