#pragma once
/// Reads <spring from="" to="">.

#include "flexarm/scene/force_element.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

std::shared_ptr<const ForceElementDescription> read_point_spring(const XmlElement& spring);

}  // namespace flexarm::scene
