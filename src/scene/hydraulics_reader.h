#pragma once
/// Reads <hydraulics> of a <cylinder>.

#include <memory>
#include <optional>

#include "flexarm/scene/hydraulics.h"
#include "scene/xml_element.h"

namespace flexarm::scene {

/// The oil of a cylinder, without its links, and the coordinate of its pump.
struct ReadHydraulics {
  std::shared_ptr<HydraulicsDescription> oil;
  std::optional<JointDescription> pump;  ///< without its links
};
/// Reads <hydraulics> without the children <spring>, <drive> and <servo> of its <pump>. `travel`: the cylinder's joint,
/// whose limits are the stroke.
ReadHydraulics read_hydraulics(const XmlElement& hydraulics, const JointDescription& travel);

/// The link without inertia that travels along the world's x axis by the coordinate of a winch or a pump.
std::string reel_of(const std::string& coordinate);

}  // namespace flexarm::scene
