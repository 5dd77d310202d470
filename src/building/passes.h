#pragma once
/// The passes by which build_model() makes a model of a scene, in their order, and functions that they share (internal
/// to building/). Headings name the file.

#include <string>
#include <unordered_map>
#include <vector>

#include "building/mechanism.h"

namespace flexarm {

// ---------------------------------------------------------------- held_joints.cpp, with the plan

/// Positions of the joints of the tree that can be held, by name [m or rad]: hinges and sliders with a constant motion
/// and no more to say, outside of loops, which no coordinate follows, and of whose effort the rigid links that they
/// carry tell all: no spring between points, loop joint or rotor with an axis acts upon these, nor a load where they
/// stand in the world, and no sensor asks what carries them.
std::unordered_map<std::string, double> joints_to_hold(const scene::SceneDescription& scene, const LinkNames& links,
                                                       const JointTree& tree);

// ---------------------------------------------------------------- tree_builder.cpp

/// The tree's nodes, elementary joints and coordinates, from the root to the leaves, where the scene lets the joints'
/// coordinates start.
/// @throws ModelError for a slide that cannot be.
PlacedTree place_tree(const ScenePlan& plan);

// ---------------------------------------------------------------- inertia_builder.cpp: beams and bodies

/// Lumps rigid bodies on nodes; each gets one in its centre of mass.
MassiveTree add_inertia(const ScenePlan& plan, PlacedTree tree);

/// int I^i ds of the nodes of a flexible link, over its elements between two arc lengths, which are borders [m].
std::vector<double> length_weights(const ScenePlan& plan, const Model& model, int link, double from, double to);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Lets mimicking coordinates follow, and puts all nodes where they are at the start.
/// @throws ModelError
TreeAtStart follow_mimics(const ScenePlan& plan, MassiveTree tree);

// ---------------------------------------------------------------- loop_builder.cpp

/// Adds the joints that close loops of the tree, which stands as it starts. Where it can be, the slave is a beam's node
/// that was free before (joints.md 3), else the loop gets constraints with multipliers.
/// @throws ModelError
ClosedMechanism close_loops(const ScenePlan& plan, TreeAtStart tree);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Gives coordinates, those of joints that close loops included, the scene's motions and efforts.
/// @throws ModelError
DrivenMechanism connect_drives(const ScenePlan& plan, ClosedMechanism mechanism);

// ---------------------------------------------------------------- closure_builder.cpp: loops of rigid links

/// Keeps of the closures' constraints those that are independent, by pivoting at the start; the others are implied.
/// @throws ModelError where nothing is left to move, or where friction would hold more than there is freedom.
SolvableMechanism choose_constraints(const ScenePlan& plan, DrivenMechanism mechanism);

/// Constraints with multipliers (joints.md 3): all of a joint between frames of `parent` and `child`, at `frame`
/// (world).
/// @throws ModelError where this joint cannot close a loop of rigid links.
LoopClosure loop_closure(const ScenePlan& plan, const Mechanism& mechanism, const scene::JointDescription& joint,
                         Attachment parent, Attachment child, const Pose& frame);

// ---------------------------------------------------------------- initial_velocity.cpp

/// Per node {v, w}, spatial, from joint rates and links' rigid velocity fields [m/s, rad/s]. Root to leaf: every link
/// moves rigidly with its joint, unless the scene gives it a field of its own. Then the joints that close loops take
/// the nodes that they hold along; what that changes is a rate of deformation of their beams.
/// @throws ModelError where a rigid link's joints do not allow its field, or a loop of rigid links the joints' rates.
std::vector<Vector6> initial_velocity(const ScenePlan& plan, const SolvableMechanism& mechanism);

// ---------------------------------------------------------------- loads_and_sensors.cpp: what is placed on links

struct PlacedLoads {
  std::vector<NodalLoad> loads;
  std::vector<TimeFunction> histories;  ///< those of the model, then those of the loads
};
/// @throws ModelError for a load on what cannot move, and for a distributed one on a rigid link.
PlacedLoads place_loads(const ScenePlan& plan, const Model& model);

std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model);

/// Sets the model's sensors and reactions; the mechanism is that of the model.
/// @throws ModelError for a sensor that does not go with its link.
void place_sensors(const ScenePlan& plan, const Mechanism& mechanism, Model& model);
/// Tells those of contacts which ones they measure, once these are in the model.
/// @throws ModelError where nothing can touch what a sensor is for.
void connect_contact_sensors(const scene::SceneDescription& scene, Model& model);

/// True if a sensor of the scene measures what carries this link.
bool measures_reaction(const scene::SceneDescription& scene, const std::string& link);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Sets how far the stops of all limited coordinates give way at most: a tenth of the range, of a slider a tenth of the
/// last element.
void set_stop_depths(Model& model);

// ---------------------------------------------------------------- mass_properties.cpp

/// Gives the stops of limited coordinates the inertia that they feel. `node_parents`: see Mechanism.
/// @return coordinates that are free to move, and move nothing that has inertia, directly or through what follows them.
std::vector<int> finish_mass_properties(const std::vector<int>& node_parents, Model& model);

// ---------------------------------------------------------------- held_joints.cpp

/// Sets what Model::held says of the joints that are held. `mechanism`: with all its joints.
void describe_held_joints(const ScenePlan& plan, const Mechanism& mechanism, Model& model);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Gives springs and elastic gears with a damping ratio the damper 2 ratio sqrt(k J), J: see articulated_inertias().
/// After mass properties and actuators. @throws ModelError where J is not known.
void set_damping_ratios(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model);

// ---------------------------------------------------------------- articulated_inertia.cpp: what resists joints

/// Coordinates that are free to move, but at the start only as others outboard of them move anyway: two axes in line
/// with nothing that has inertia between them, a gimbal in its lock, a massless chain of more joints than the body at
/// its end has freedoms. The accelerations of all of these would be undetermined. Of mechanisms without loops; beams
/// count as rigid, as they have inertia everywhere. `node_parents`: see Mechanism.
std::vector<int> coordinates_without_own_inertia(const std::vector<int>& node_parents, const Model& model);

/// Per coordinate what it moves at the start while those outboard of it are free to move, a rotor that turns with it
/// included [kg m^2 or kg]; 0 where that is not known: in mechanisms with loops, on slides, of coordinates that are
/// prescribed, follow others or are followed. Of a joint with several, those before it are free, too.
std::vector<double> articulated_inertias(const std::vector<int>& node_parents, const Model& model);

// ---------------------------------------------------------------- force_element_builder.cpp

/// The scene's force elements on the nodes of a model that is complete but for them.
/// @throws ModelError for one whose points are all on one rigid body.
ForceElementList place_force_elements(const ScenePlan& plan, const Model& model);

// ---------------------------------------------------------------- clearance_builder.cpp

/// What holds joints with play at its end, on the nodes of that model.
/// @throws ModelError where both links belong to one rigid body, or a joint starts far beyond its play.
ForceElementList place_clearances(const ScenePlan& plan, const Model& model);

// ---------------------------------------------------------------- contact_builder.cpp

/// Contacts of all pairs of links and grounds for which the scene has one, on the nodes of that model.
/// @throws ModelError where a side of a named pair has nothing to touch with, or both never move against each other.
ForceElementList place_contacts(const ScenePlan& plan, const Model& model);
/// Of force elements those that are contacts, by what they are between.
std::vector<TouchingPair> touching_pairs(const ForceElementList& elements);

}  // namespace flexarm
