#pragma once
/// Linear models as tables for other programs.

#include <string>

#include "flexarm/simulation/linear_model.h"

namespace flexarm::cli {

/// One object: scene, states, inputs, outputs, left_out (names), A, B, C, D (rows of numbers), drift, and of the
/// equations of second order coordinates, mass, damping, stiffness, residual. Numbers have 17 significant digits.
std::string linear_model_as_json(const std::string& scene, const LinearModel& model);
/// The block matrix [A B; C D], with a header of states and inputs, and states and outputs in the first column.
std::string linear_model_as_csv(const LinearModel& model);

}  // namespace flexarm::cli
