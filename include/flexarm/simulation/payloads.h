#pragma once
/// Payloads that come and go while a simulation moves: links are attached and detached, models spawned and deleted.
///
/// Each makes the simulation one of another scene, Simulation::scene(), in which everything else goes on: state, time,
/// commands, memories of servos, friction and contacts. Indices of links, coordinates, probes and sensors are others
/// afterwards, snapshots and checkpoints of before cannot be restored, and reset() starts the new scene: what is
/// attached then stays attached. They allocate memory. (docs/payloads.md)
///
/// All throw std::invalid_argument that says what is wrong, or ModelError where the new scene cannot be built; the
/// simulation is as before then.

#include <string>

#include "flexarm/math/pose.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Fixes a link that floats, with all that it carries, to a link of another mechanism, where it is: to the same rigid
/// body, or to the nearest border between elements of a flexible link. Velocities become those that the joint allows by
/// the impulses that it transmits: momenta stay, lost energy counts as dissipated.
void attach(Simulation& simulation, const std::string& link, const std::string& to);

/// Frees a link that hangs on a fixed joint, which becomes a floating one: it flies on as it moves.
void detach(Simulation& simulation, const std::string& link);

/// Where a spawned model appears, and how it moves there.
struct Spawn {
  Pose pose;                                                    ///< of its root link, in the world
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();  ///< of the root link's origin, world axes [m/s, rad/s]
  std::string prefix;  ///< put before the names of its links, joints, sensors and probes
};

/// Adds a model: all of a scene but its <integrator>, gravity and parameters. Its root link floats, by a joint of the
/// root link's name; but a root link `world` is this scene's, and its joints hang there, at the pose. Contacts of the
/// scene with `*` include it.
void spawn(Simulation& simulation, const scene::SceneDescription& model, const Spawn& where);

/// Takes a link away, with all that it carries and all that names it.
void remove(Simulation& simulation, const std::string& link);

}  // namespace flexarm
