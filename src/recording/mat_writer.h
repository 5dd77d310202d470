#pragma once
/// Linear models as files of MATLAB.

#include <string>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::recording {

/// A file of version 5 with A, B, C, D, drift, mass, damping, stiffness, residual, and states, inputs, outputs,
/// coordinates, left_out as cell arrays of names; of responses that were asked for frequencies (F x 1) and gains
/// (complex, outputs x inputs x F), times (T x 1) and step_response (T x outputs x inputs); of derivatives parameters,
/// states_by_parameters, outputs_by_parameters, initial_states, transition. What was at its place
/// before stays there until it is whole.
/// @throws std::runtime_error naming the file if it cannot be written
void write_mat(const std::string& path, const std::string& scene, const LinearModel& model,
               const LinearResponses& responses);

}  // namespace flexarm::recording
