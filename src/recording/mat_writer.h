#pragma once
/// Writes linear models as MATLAB files.

#include <string>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::recording {

/// Writes a MAT-file of version 5. It contains
/// - A, B, C, D, drift, mass, damping, stiffness, residual;
/// - states, inputs, outputs, coordinates, left_out as cell arrays of strings;
/// - if there are frequency responses: frequencies (F x 1) and gains (complex, outputs x inputs x F);
/// - if there are step responses: times (T x 1) and step_response (T x outputs x inputs);
/// - if there are derivatives: parameters, states_by_parameters, outputs_by_parameters, initial_states, transition,
///   event_times, event_joints, event_kinds, event_doubts.
///
/// An older file at the same path stays until the new one is complete.
/// @throws std::runtime_error naming the file if it cannot be written
void write_mat(const std::string& path, const std::string& scene, const LinearModel& model,
               const LinearResponses& responses);

}  // namespace flexarm::recording
