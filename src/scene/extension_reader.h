#pragma once
/// flexarm's own elements of a scene: <beam> and <simulation>.

#include "scene/start.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

/// Reads <beam>; nothing if there is an error, which is recorded.
std::optional<BeamDescription> read_beam(const XmlElement& beam, const std::string& link);

/// Reads <simulation> into `scene`, and what it says about the start into `start`, which is settled later. So are
/// names.
void read_simulation(const XmlElement& simulation, SceneDescription& scene, StartRequest& start);

}  // namespace flexarm::scene
