#pragma once
/// What moves coordinates: those that they follow, motions and efforts (internal to building/).

#include "building/mechanism.h"

namespace flexarm {

/// Lets mimicking coordinates follow, and puts all nodes where they are at the start.
/// @throws ModelError
TreeAtStart follow_mimics(const ScenePlan& plan, MassiveTree tree);

/// Gives coordinates, those of joints that close loops included, the scene's motions and efforts.
/// @throws ModelError
DrivenMechanism connect_drives(const ScenePlan& plan, ClosedMechanism mechanism);

}  // namespace flexarm
