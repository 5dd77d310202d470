#pragma once
/// Reads <couple>: joints whose travel depends on their angle.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Kind and data of the joint; its axis, and that it is a slide, must have been read. Findings are recorded.
void read_couple(const XmlElement& joint, const XmlElement& couple, JointDescription& description);

}  // namespace flexarm::scene
