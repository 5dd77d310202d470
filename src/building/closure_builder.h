#pragma once
/// Loops that no free node of a beam can close: constraints with multipliers (internal to building/; joints.md 3).

#include "building/mechanism.h"

namespace flexarm {

/// All constraints of a joint between frames of `parent` and `child`, at `frame` (world).
/// @throws ModelError where this joint cannot close a loop of rigid links.
LoopClosure loop_closure(const ScenePlan& plan, const Mechanism& mechanism, const scene::JointDescription& joint,
                         Attachment parent, Attachment child, const Pose& frame);

/// Keeps of the closures' constraints those that are independent, by pivoting at the start; the others are implied.
/// @throws ModelError where nothing is left to move, or where friction would hold more than there is freedom.
SolvableMechanism choose_constraints(const ScenePlan& plan, DrivenMechanism mechanism);

}  // namespace flexarm
