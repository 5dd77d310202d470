#pragma once
/// Writes linear models as JSON and CSV.

#include <string>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::cli {

/// The model as one JSON object. Its members are:
/// - scene; states, inputs, outputs, left_out (names); A, B, C, D (arrays of rows); drift; poles ([real, imaginary] of
///   those with an imaginary part >= 0)
/// - of the second-order equations: coordinates, mass, damping, stiffness, residual
/// - of requested responses: frequencies and gains ([frequency][output][input][real, imaginary]); times and
///   step_response ([time][output][input])
/// - of requested derivatives: parameters, states_by_parameters, outputs_by_parameters, initial_states, transition
///
/// Numbers have 17 significant digits.
/// @throws std::runtime_error if the computation of the poles fails
std::string linear_model_as_json(const std::string& scene, const LinearModel& model, const LinearResponses& responses);
/// The block matrix [A B; C D]. The header names states and inputs, the first column states and outputs. Derivatives
/// with respect to parameters follow as further columns.
std::string linear_model_as_csv(const LinearModel& model, const RunDerivatives& run);
/// A row for each frequency [Hz]: gain and phase [deg] of each pair of output and input.
std::string frequency_response_as_csv(const LinearModel& model, const FrequencyResponse& response);
/// A row for each time [s], with a column for each pair of output and input.
std::string step_response_as_csv(const LinearModel& model, const StepResponse& response);

}  // namespace flexarm::cli
