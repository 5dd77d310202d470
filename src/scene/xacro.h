#pragma once
/// Files that are not URDF yet.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Records the first place in <robot> that only xacro understands, with the way to expand it; false if there is none.
/// What flexarm does not read (<visual>, <gazebo>...) may keep its substitutions.
bool refuse_xacro(const XmlElement& robot);

}  // namespace flexarm::scene
