#pragma once
/// The passes by which build_model() makes a model from a scene, in their order, and functions that they share
/// (internal to building/). Headings name the source file.

#include <string>
#include <unordered_map>
#include <vector>

#include "building/mechanism.h"

namespace flexarm {

// ---------------------------------------------------------------- held_joints.cpp, with the plan

/// Positions of the joints of the tree that can be held (see HeldJoint), by name [m or rad]. These are hinges and
/// sliders outside of loops, with a constant motion. They have no spring, no effort, neither Coulomb friction nor
/// friction by the joint's force, and no coordinate that follows them. Their effort must follow from the rigid links
/// that they carry. So no contact, drag, spring between points, loop joint or rotor with an axis may act on these
/// links, nor a load if they are part of the world, and no sensor may measure what carries them.
std::unordered_map<std::string, double> joints_to_hold(const scene::SceneDescription& scene, const LinkNames& links,
                                                       const JointTree& tree);

// ---------------------------------------------------------------- tree_builder.cpp

/// Makes nodes, elementary joints and coordinates of the tree, from the root to the leaves, at the initial positions of
/// the joints' coordinates.
/// @throws ModelError for an impossible slide.
PlacedTree place_tree(const ScenePlan& plan);

// ---------------------------------------------------------------- inertia_builder.cpp: beams and bodies

/// Makes the elements of beams, and lumps rigid bodies at nodes. Each body gets a node in its centre of mass.
MassiveTree add_inertia(const ScenePlan& plan, PlacedTree tree);

/// The integrals int I^i ds for the nodes of a flexible link, over its elements between two arc lengths, which are
/// borders [m].
std::vector<double> length_weights(const ScenePlan& plan, const Model& model, int link, double from, double to);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Makes mimic coordinates follow, and places all nodes where they are at the start.
/// @throws ModelError
TreeAtStart follow_mimics(const ScenePlan& plan, MassiveTree tree);

// ---------------------------------------------------------------- loop_builder.cpp

/// Adds the joints that close loops of the tree, which is in its initial configuration. If possible, the slave is a
/// node of a beam that was free before (joints.md 3). Otherwise the loop gets constraints with multipliers.
/// @throws ModelError
ClosedMechanism close_loops(const ScenePlan& plan, TreeAtStart tree);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Gives coordinates the scene's motions, efforts, springs, drives and servos. Joints that close loops may have them,
/// too.
/// @throws ModelError
DrivenMechanism connect_drives(const ScenePlan& plan, ClosedMechanism mechanism);

// ---------------------------------------------------------------- closure_builder.cpp: loops of rigid links

/// Keeps the independent constraints of the closures, by pivoting at the start. The other ones are implied.
/// @throws ModelError if nothing is left that can move, if friction would hold more than there is freedom, or if a loop
/// starts at a dead point.
SolvableMechanism choose_constraints(const ScenePlan& plan, DrivenMechanism mechanism);

/// Constraints with multipliers (joints.md 3): all constraints of a joint between the frames of `parent` and `child`.
/// `frame`: the joint's frame (world).
/// @throws ModelError if this joint cannot close a loop of rigid links.
LoopClosure loop_closure(const ScenePlan& plan, const Mechanism& mechanism, const scene::JointDescription& joint,
                         Attachment parent, Attachment child, const Pose& frame);

// ---------------------------------------------------------------- initial_velocity.cpp

/// Velocities {v, w} per node, spatial, from joint rates and rigid velocity fields of links [m/s, rad/s]. From the root
/// to the leaves, every link moves rigidly with its joint, unless the scene gives it a field of its own. Then the
/// joints that close loops move the nodes that they hold; this change is a rate of deformation of their beams.
/// @throws ModelError if the joints of a rigid link do not allow its field, or if a loop of rigid links does not allow
/// the joints' rates.
std::vector<Vector6> initial_velocity(const ScenePlan& plan, const SolvableMechanism& mechanism);

// ---------------------------------------------------------------- loads_and_sensors.cpp: what is placed on links

struct PlacedLoads {
  std::vector<NodalLoad> loads;
  std::vector<TimeFunction> histories;  ///< those of the model, then those of the loads
};
/// @throws ModelError for a load on a link that cannot move, and for a distributed load on a rigid link.
PlacedLoads place_loads(const ScenePlan& plan, const Model& model);

std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model);

/// Sets the model's sensors and reactions. `mechanism`: from which the model was made.
/// @throws ModelError for a sensor that does not suit its link.
void place_sensors(const ScenePlan& plan, const Mechanism& mechanism, Model& model);
/// Tells contact sensors which contacts they measure. Call it when these are in the model.
/// @throws ModelError if nothing can touch the links of a sensor.
void connect_contact_sensors(const scene::SceneDescription& scene, Model& model);

/// Whether a sensor of the scene measures the reaction of the joint that carries this link.
bool measures_reaction(const scene::SceneDescription& scene, const std::string& link);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Sets how far the stops of all limited coordinates give way at most: a tenth of the range; for a slider, a tenth of
/// the last element.
void set_stop_depths(Model& model);

// ---------------------------------------------------------------- mass_properties.cpp

/// Sets the inertia that the stops of limited coordinates feel. `node_parents`: see Mechanism.
/// @return coordinates that are free to move, but move nothing that has inertia, directly or through coordinates that
/// follow them or loops that they close.
std::vector<int> finish_mass_properties(const std::vector<int>& node_parents, Model& model);

// ---------------------------------------------------------------- held_joints.cpp

/// Sets the data of all joints in Model::held. `mechanism`: with all its joints.
void describe_held_joints(const ScenePlan& plan, const Mechanism& mechanism, Model& model);

// ---------------------------------------------------------------- coordinate_builder.cpp

/// Gives springs and elastic gears with a damping ratio the damper 2 ratio sqrt(k J); J: see articulated_inertias().
/// Call it after mass properties and actuators are set.
/// @throws ModelError if J is not known.
void set_damping_ratios(const scene::SceneDescription& scene, const std::vector<int>& node_parents, Model& model);

// ---------------------------------------------------------------- articulated_inertia.cpp: what resists joints

/// Coordinates that are free to move, but at the start only in motions that coordinates outboard of them can make as
/// well. Examples are two axes in line with nothing that has inertia between them, a gimbal lock, and a massless chain
/// with more joints than the body at its end has degrees of freedom. The accelerations of these coordinates would be
/// undetermined. Empty for mechanisms with loops. Beams count as rigid, since they have inertia everywhere.
/// `node_parents`: see Mechanism.
std::vector<int> coordinates_without_own_inertia(const std::vector<int>& node_parents, const Model& model);

/// Per coordinate, the inertia that it moves at the start while the coordinates outboard of it are free, including a
/// rotor that turns with it [kg m^2 or kg]. It is 0 if it is not known: in mechanisms with loops, on slides, and for
/// coordinates that are prescribed, follow others or are followed. In a joint with several coordinates, those before it
/// are free, too.
std::vector<double> articulated_inertias(const std::vector<int>& node_parents, const Model& model);

// ---------------------------------------------------------------- loop_inertia.cpp: what resists joints in loops

/// A coordinate of loops that are closed by constraints.
struct InLoops {
  double inertia = 0;          ///< see loop_inertias() [kg m^2 or kg]; 0: it is in no loop, or cannot move
  bool is_determined = false;  ///< it moves only in motions of its loops that have inertia
};
/// Per coordinate: how the loops determine its motion at the start. The inertia is that which an effort on the
/// coordinate accelerates while its loops stay closed: their other joints are free, joints outside the loops are
/// locked, and beams are rigid. Only groups of connected loops that have a coordinate `is_asked` are computed.
/// `node_parents`: see Mechanism.
std::vector<InLoops> loop_inertias(const std::vector<int>& node_parents, const Model& model,
                                   const std::vector<bool>& is_asked);

// ---------------------------------------------------------------- force_element_builder.cpp

/// The scene's force elements, on the nodes of a model that is complete except for these. Adds their functions of time
/// to the model's.
/// @throws ModelError for an element whose points are all on one rigid body.
ForceElementList place_force_elements(const ScenePlan& plan, Model& model);

// ---------------------------------------------------------------- drag_builder.cpp

/// The drag on links, on the nodes of the model.
/// @throws ModelError for a link that cannot move.
ForceElementList place_drags(const ScenePlan& plan, const Model& model);

// ---------------------------------------------------------------- clearance_builder.cpp

/// The contacts that limit the play of joints, on the nodes of the model.
/// @throws ModelError if both links belong to one rigid body, or if a joint starts far beyond its play.
ForceElementList place_clearances(const ScenePlan& plan, const Model& model);

// ---------------------------------------------------------------- contact_builder.cpp

/// Contacts of all pairs of links and grounds for which the scene has a <contact>, on the nodes of the model.
/// @throws ModelError if a side of a named pair has nothing to touch with, or if the two never move against each other.
ForceElementList place_contacts(const ScenePlan& plan, const Model& model);
/// The force elements that are contacts, grouped by pairs of bodies.
std::vector<TouchingPair> touching_pairs(const ForceElementList& elements);

}  // namespace flexarm
