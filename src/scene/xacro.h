#pragma once
/// Files that are not URDF yet.

#include <string_view>

#include "scene/xml_element.h"

namespace flexarm::scene {

bool is_of_xacro(std::string_view tag);

/// Records the first place in <robot> that only xacro understands, with the way to expand it; false if there is none.
/// What flexarm does not read (<visual>, <gazebo>...) may keep its substitutions. Calls of macros in a file that says
/// that xacro has expanded it, or that has nothing else for xacro to do, are warnings: no expansion gives them a
/// meaning.
bool refuse_xacro(const XmlElement& robot);

/// Records the same of an attribute, at `line`, with an expression that only xacro's properties give a value:
/// `parameter` is what would have to be declared otherwise.
void refuse_property(const XmlElement& element, int line, const std::string& parameter, std::string_view got);

}  // namespace flexarm::scene
