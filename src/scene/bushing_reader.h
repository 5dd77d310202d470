#pragma once
/// Reads <bushing from="" to="">.

#include "flexarm/scene/force_element.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

std::shared_ptr<const ForceElementDescription> read_bushing(const XmlElement& bushing);

}  // namespace flexarm::scene
