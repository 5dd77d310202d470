#pragma once
/// Reads <spring from="" to="">.

#include "scene/xml_element.h"

namespace flexarm::scene {

PointSpring read_point_spring(const XmlElement& spring);

}  // namespace flexarm::scene
