#pragma once
/// Tells which links of a scene are flexible.

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// Whether the link is a beam with elements. A beam without elements is a rigid body with the beam's mass and shape.
inline bool is_flexible(const LinkDescription& link) {
  return link.beam && link.beam->elements != 0;
}

}  // namespace flexarm::scene
