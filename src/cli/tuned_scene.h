#pragma once
/// The text of a scene file with other settings.

#include <string>

#include "accuracy/run_settings.h"

namespace flexarm::cli {

/// `text` is what `scene` was read from. Attributes elements and order of beams, and scheme, step and tolerance of
/// <integrator> are changed where they differ; what is missing for that (<simulation>, <integrator>) is added on a line
/// of its own. Its accuracy, and options that another scheme does not take, are taken away.
/// @throws std::runtime_error if the text cannot be brought to say so: it comes out of xacro, for example.
std::string tuned_text(const std::string& text, const scene::SceneDescription& scene, const RunSettings& settings);

}  // namespace flexarm::cli
