#pragma once
/// Puts a failed step into words.

#include <string>

#include "flexarm/model/results.h"
#include "integrators/step_settings.h"
#include "model/model.h"

namespace flexarm {

/// What failed, where and when, what was tried, and what usually helps; one line. Empty if nothing failed.
/// @throws std::invalid_argument if its place is none of this model: it is the result of another simulation
std::string failure_text(const Model& model, const StepSettings& settings, const StepResult& result);

/// "element 3 of 8 of link 'arm'", "joint coordinate 'elbow'"; empty if it is not known.
std::string place_name(const Model& model, const StepResult::Place& place);

}  // namespace flexarm
