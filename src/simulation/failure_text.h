#pragma once
/// Puts a failed step into words.

#include <string>

#include "flexarm/model/results.h"
#include "integrators/explicit_limit.h"
#include "integrators/step_settings.h"
#include "model/model.h"

namespace flexarm {

/// Says in one line what failed, where and when, what was tried, and what usually helps. Empty if nothing failed.
/// `limit`: of an explicit scheme, which is the cause if it is below the step.
/// @throws std::invalid_argument if the model does not have the place: then the result is that of another simulation
std::string failure_text(const Model& model, const StepSettings& settings, const StepResult& result,
                         const ExplicitLimit& limit = {});

/// "damping of joint coordinate 'elbow' needs steps below 2e-05 s". The limit must be one.
std::string growth_text(const Model& model, const ExplicitLimit& limit);

/// What helps if elements of a beam are bent too far.
std::string bending_advice(const BeamLink& beam);

/// Names a place: "element 3 of 8 of link 'arm'", "joint coordinate 'elbow'". Empty if the place is unknown.
std::string place_name(const Model& model, const StepResult::Place& place);

}  // namespace flexarm
