#pragma once
/// Changes a mechanism while it is simulated: attach and detach links, spawn and delete models. (docs/payloads.md)
///
/// Each function changes the scene of the simulation, see Simulation::scene(). State, time, commands, and memories of
/// servos, friction and contacts are kept for everything else. Afterwards:
/// - links, coordinates, probes and sensors may have other indices;
/// - earlier snapshots and checkpoints cannot be restored;
/// - reset() starts the new scene, in which an attached link stays attached.
///
/// The functions allocate memory. They throw std::invalid_argument, which says what is wrong, or ModelError if the new
/// scene cannot be built. The simulation is then unchanged.

#include <string>

#include "flexarm/math/pose.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Fixes a floating link, with everything that it carries, to a link of another mechanism at its present place. It is
/// fixed to the rigid body, or to the nearest border between elements of a flexible link. The joint transmits impulses
/// that make the velocities compatible: momenta are conserved, and the lost energy counts as dissipated.
void attach(Simulation& simulation, const std::string& link, const std::string& to);

/// Frees a link that a fixed joint holds. The joint becomes a floating one, and the link keeps its velocity.
void detach(Simulation& simulation, const std::string& link);

/// Initial pose and velocity of a spawned model.
struct Spawn {
  Pose pose;                                                    ///< of its root link, in the world
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();  ///< of the root link's origin, world axes [m/s, rad/s]
  std::string prefix;  ///< added to the names of its links, joints, sensors and probes
};

/// Adds a model: everything of its scene except <integrator>, gravity and parameters. Its root link floats, by a joint
/// with the root link's name. If the root link is called `world`, it is this scene's world, and the model's joints are
/// attached to it at the given pose. Contacts of this scene with `*` include the model.
void spawn(Simulation& simulation, const scene::SceneDescription& model, const Spawn& where);

/// Removes a link, everything that it carries, and all elements of the scene that refer to these.
void remove(Simulation& simulation, const std::string& link);

}  // namespace flexarm
