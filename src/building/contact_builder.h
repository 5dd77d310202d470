#pragma once
/// What touches what (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// Contacts of all pairs of links and grounds for which the scene has one, on the nodes of a model that is complete but
/// for them.
/// @throws ModelError where a side of a named pair has nothing to touch with, or both never move against each other.
ForceElementList place_contacts(const ScenePlan& plan, const Model& model);

}  // namespace flexarm
