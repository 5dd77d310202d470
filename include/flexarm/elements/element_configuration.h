#pragma once
/// The nodal motion of one element in a state.

#include "flexarm/elements/beam_point.h"
#include "flexarm/model/state.h"

namespace flexarm {

/// Positions [m], velocities [m/s] and spatial angular velocities [rad/s] of an element's nodes, world axes.
template <int Nodes>
struct ElementConfiguration {
  std::array<Vector3, Nodes> position, velocity, spin;
  std::array<Quaternion, Nodes> orientation;

  ElementConfiguration(const BeamElement<Nodes>& element, const State& state) {
    for (int i = 0; i < Nodes; ++i) {
      const NodeState& node = state.nodes[element.nodes[i]];
      position[i] = node.position;
      velocity[i] = node.velocity;
      spin[i] = node.orientation * node.angular_velocity;
      orientation[i] = node.orientation;
    }
  }
};

}  // namespace flexarm
