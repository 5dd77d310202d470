#pragma once
/// Recognises xacro that has not been expanded to URDF, and refuses it.

#include <string_view>

#include "scene/xml_element.h"

namespace flexarm::scene {

bool is_of_xacro(std::string_view tag);
/// Whether only other programs read an element, so that it may have expressions of theirs.
bool is_for_others(std::string_view tag);

/// Records an error for the first place in <robot> that only xacro understands; the message says how to expand the
/// file. Returns false if there is no such place. Elements that flexarm does not read (<visual>, <gazebo>...) may keep
/// their substitutions. Some traces of xacro are only warnings, since no expansion can give them a meaning: properties,
/// macros and arguments that nothing in the file uses, and calls of macros that the file does not define; and all of
/// them in a file that xacro has expanded (its comment says so).
bool refuse_xacro(const XmlElement& robot);

/// Records an error for an attribute at `line` whose expression has an unknown name. That name may be a property of
/// xacro, or a <parameter> that the scene should declare: `parameter`.
void refuse_property(const XmlElement& element, int line, const std::string& parameter, std::string_view got);

}  // namespace flexarm::scene
