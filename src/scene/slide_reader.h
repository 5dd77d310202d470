#pragma once
/// Reads <slide>: a joint that rides on its parent's flexible centreline.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Kind and data of the joint, all but its axes. Findings are recorded.
void read_slide(const XmlElement& joint, const XmlElement& slide, JointDescription& description);

}  // namespace flexarm::scene
