#pragma once
/// Which links bend.

#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// A beam with elements; one without them is a rigid body with the mass and the shape of the beam.
inline bool is_flexible(const LinkDescription& link) {
  return link.beam && link.beam->elements != 0;
}

}  // namespace flexarm::scene
