#pragma once
/// What acts between points of links (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// The scene's force elements on the nodes of a model that is complete but for them.
/// @throws ModelError for one whose points are all on one rigid body.
ForceElementList place_force_elements(const ScenePlan& plan, const Model& model);

}  // namespace flexarm
