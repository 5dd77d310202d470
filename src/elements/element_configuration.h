#pragma once
/// Reads the nodal motion, and the strains, of one element from a state.

#include "elements/beam_point.h"
#include "model/model.h"
#include "model/state.h"

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

/// Returns rotation and curvature of an integration point by the scheme's own interpolation. If that depends on the
/// past, the state stores them (`kept`, at `index`); else `kept` is empty, and the local interpolation is evaluated.
template <int Nodes, class Point>
PointRotation point_rotation(const LocalRotations<Nodes>& local, const Point& point,
                             const std::vector<PointRotation>& kept, int index) {
  return kept.empty() ? local.evaluate(point.shape, point.derivative) : kept[index];
}

/// Returns the strains of the springs of a stiffness point's Maxwell branches, of which there are
/// Model::maxwell_branches. `point`: index among all stiffness points.
inline const Vector6* branch_strains(const Model& model, const State& state, int point) {
  return state.branch_strains.data() + static_cast<std::size_t>(point) * model.maxwell_branches;
}

/// Returns {Gamma, K} [-, 1/m] about the mass centroid at stiffness point k, by the scheme's own interpolation.
template <int Nodes>
Vector6 centroid_strain(const BeamElement<Nodes>& element, const ElementConfiguration<Nodes>& nodes,
                        const LocalRotations<Nodes>& local, const State& state, int k) {
  const auto& point = element.stiffness_points[k];
  return point_kinematics(
             point_rotation(local, point, state.study.stiffness_rotations, element.first_stiffness_point + k),
             interpolate<Nodes>(point.derivative, nodes.position), point.reference_strain)
      .strain;
}

}  // namespace flexarm
