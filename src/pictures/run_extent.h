#pragma once
/// Finds how much room a run takes.

#include <vector>

#include "pictures/picture.h"

namespace flexarm::pictures {

/// The extent of a run: of the shapes, beams, probes and lines of all that can move, at all instants, and of what is
/// fixed near it (extent_around()).
/// @param instants  numbers of Instant. Those that are not finite do not count
SceneExtent run_extent(const Picture& picture, const std::vector<std::vector<double>>& instants);

}  // namespace flexarm::pictures
