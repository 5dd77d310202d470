#pragma once
/// Linear models as tables for other programs.

#include <string>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::cli {

/// One object: scene, states, inputs, outputs, left_out (names), A, B, C, D (rows of numbers), drift, poles ([real,
/// imaginary] of those with an imaginary part >= 0), and of the equations of second order coordinates, mass, damping,
/// stiffness, residual. Of responses that were asked for frequencies and gains ([frequency][output][input][real,
/// imaginary]), times and step_response ([time][output][input]); of derivatives parameters, states_by_parameters,
/// outputs_by_parameters, initial_states, transition. Numbers have 17 significant digits.
/// @throws std::runtime_error if the poles are not found.
std::string linear_model_as_json(const std::string& scene, const LinearModel& model, const LinearResponses& responses);
/// The block matrix [A B; C D], with a header of states and inputs, and states and outputs in the first column; the
/// derivatives by parameters behind it.
std::string linear_model_as_csv(const LinearModel& model, const RunDerivatives& run);
/// A row for each frequency [Hz], with the gain and the phase [deg] of each pair of an output and an input.
std::string frequency_response_as_csv(const LinearModel& model, const FrequencyResponse& response);
/// A row for each time [s].
std::string step_response_as_csv(const LinearModel& model, const StepResponse& response);

}  // namespace flexarm::cli
