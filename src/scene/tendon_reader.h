#pragma once
/// Reads <tendon>.

#include "flexarm/scene/force_element.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

std::shared_ptr<const ForceElementDescription> read_tendon(const XmlElement& tendon);

}  // namespace flexarm::scene
