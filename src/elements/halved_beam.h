#pragma once
/// An element of three nodes that is divided into two halves. (docs/notes/refinement.md)

#include <array>
#include <vector>

#include "elements/element_configuration.h"

namespace flexarm {

/// Nodes of an element of three nodes, in order.
using ElementNodeStates = std::array<NodeState, 3>;

/// Returns the motion of the section at xi in [-1, 1] of an element, interpolated as the scheme does: position,
/// orientation, velocities and mean spin. Accelerations are zero.
NodeState interpolated_node(const ElementNodeStates& nodes, double xi);

/// Consecutive elements of three nodes. Neighbours share a node.
using ElementChain = std::vector<const BeamElement<3>*>;

/// Moves all nodes between the first and the last one to where the strain energy of the chain is least. Their
/// velocities and spatial angular velocities stay. `nodes`: along the chain, one more than twice the number of
/// elements. `prestrain`: subtracted from the strains.
void settle_between(const ElementChain& chain, const Vector6& prestrain, std::vector<NodeState>& nodes);

/// Strain energy of a chain [J].
double strain_energy(const ElementChain& chain, const Vector6& prestrain, const std::vector<NodeState>& nodes);

/// Orientations of three consecutive nodes of a beam.
using ThreeOrientations = std::array<Quaternion, 3>;

/// How far three nodes are bent from their undeformed orientations [rad], up to two turns: twice the larger one of the
/// rotations from the middle to the ends. For an even bending of a straight beam, this is the rotation from the first
/// to the last node.
double bending(const ThreeOrientations& nodes, const ThreeOrientations& undeformed);

}  // namespace flexarm
