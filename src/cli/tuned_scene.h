#pragma once
/// Changes settings in the text of a scene file.

#include <string>

#include "accuracy/run_settings.h"

namespace flexarm::cli {

/// Changes settings in `text`, from which `scene` was read. Changes those attributes `elements` and `order` of beams,
/// and `scheme`, `step` and `tolerance` of <integrator>, that differ. Missing elements (<simulation>, <integrator>) are
/// added on a line of their own. Removes the integrator's `accuracy`, and options that the new scheme does not have.
/// @throws std::runtime_error if the text cannot be changed accordingly, for example since xacro generates parts of it
std::string tuned_text(const std::string& text, const scene::SceneDescription& scene, const RunSettings& settings);

}  // namespace flexarm::cli
