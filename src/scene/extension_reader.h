#pragma once
/// flexarm's own elements of a scene: <beam> and <simulation>.

#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <beam>; nothing if there is an error, which is recorded.
std::optional<BeamDescription> read_beam(const XmlElement& beam, const std::string& link);

/// Reads <simulation> into `scene`. Names are checked later, see check_scene().
void read_simulation(const XmlElement& simulation, SceneDescription& scene);

}  // namespace flexarm::scene
