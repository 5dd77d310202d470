#pragma once
/// The cross-section of a <beam>.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads the section of a <beam>; nothing if there is an error, which is recorded.
std::optional<Section> read_section(const XmlElement& beam);

}  // namespace flexarm::scene
