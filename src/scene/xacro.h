#pragma once
/// Recognises xacro that has not been expanded to URDF, and refuses it.

#include <string_view>

#include "scene/xml_element.h"

namespace flexarm::scene {

bool is_of_xacro(std::string_view tag);

/// Records an error for the first place in <robot> that only xacro understands; the message says how to expand the
/// file. Returns false if there is no such place. Elements that flexarm does not read (<visual>, <gazebo>...) may keep
/// their substitutions. Some calls of macros are only warnings, since no expansion can give them a meaning: those in a
/// file that xacro has expanded (its comment says so), or in a file without directives of xacro.
bool refuse_xacro(const XmlElement& robot);

/// Records an error for an attribute at `line` whose expression has an unknown name. That name may be a property of
/// xacro, or a <parameter> that the scene should declare: `parameter`.
void refuse_property(const XmlElement& element, int line, const std::string& parameter, std::string_view got);

}  // namespace flexarm::scene
