#pragma once
/// Which options of <integrator> go with which scheme.

#include <string>
#include <string_view>
#include <vector>

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// Names of the schemes that a scene may ask for, "auto" first.
const std::vector<std::string_view>& scheme_names();

/// An option that the scheme does not have, or with a value that it does not take.
struct OptionConflict {
  std::string attribute, message;
};
/// Empty if all options that are set suit the scheme.
std::vector<OptionConflict> option_conflicts(const IntegratorDescription& integrator);

/// newmark, hht1 to hht3: joints by their exact variation at the end of the step, not by its increments.
bool is_newmark_family(std::string_view scheme);

/// Why <slide scheme="`slide`"> does not go with an integration scheme; empty if it does. The Newmark family folds
/// sliders by their exact variation, whatever this says.
std::string slide_scheme_conflict(const std::string& slide, const std::string& scheme);

/// The same description with another scheme; options that this one does not take are forgotten.
IntegratorDescription with_scheme(IntegratorDescription integrator, const std::string& scheme);

}  // namespace flexarm::scene
