#pragma once
/// Joints whose motions are constant: what they carry is built as behind a fixed joint (internal to building/).

#include <string>
#include <unordered_map>

#include "building/mechanism.h"

namespace flexarm {

/// Positions of the joints of the tree that can be held, by name [m or rad]: hinges and sliders with a constant motion
/// and no more to say, outside of loops, which no coordinate follows, and of whose effort the rigid links that they
/// carry tell all: no spring between points, loop joint or rotor with an axis acts upon these, nor a load where they
/// stand in the world, and no sensor asks what carries them.
std::unordered_map<std::string, double> joints_to_hold(const scene::SceneDescription& scene, const LinkNames& links,
                                                       const JointTree& tree);

/// Sets what Model::held says of them. `mechanism`: with all its joints.
void describe_held_joints(const ScenePlan& plan, const Mechanism& mechanism, Model& model);

}  // namespace flexarm
