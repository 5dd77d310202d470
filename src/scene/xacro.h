#pragma once
/// Files that are not URDF yet.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Records the first place in <robot> that only xacro understands, with the way to expand it; false if there is none.
/// What flexarm does not read (<visual>, <gazebo>...) may keep its substitutions.
bool refuse_xacro(const XmlElement& robot);

/// Records the same of an attribute, at `line`, with an expression that only xacro's properties give a value:
/// `parameter` is what would have to be declared otherwise.
void refuse_property(const XmlElement& element, int line, const std::string& parameter, std::string_view got);

}  // namespace flexarm::scene
