#pragma once
/// Linear models as files of MATLAB.

#include <string>

#include "flexarm/simulation/linear_model.h"

namespace flexarm::recording {

/// A file of version 5 with A, B, C, D, drift, mass, damping, stiffness, residual, and states, inputs, outputs,
/// coordinates, left_out as cell arrays of names. What was at its place before stays there until it is whole.
/// @throws std::runtime_error naming the file if it cannot be written
void write_mat(const std::string& path, const std::string& scene, const LinearModel& model);

}  // namespace flexarm::recording
