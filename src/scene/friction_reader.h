#pragma once
/// <friction> of a joint.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <friction> into `description`, whose kind is known.
void read_friction(const XmlElement& friction, JointDescription& description);

}  // namespace flexarm::scene
