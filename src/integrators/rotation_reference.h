#pragma once
/// The references of the global interpolations: rotations of nodes and points of one configuration.

#include <vector>

#include "elements/beam_point.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// The reference of a step's interpolation and the nodes' rotation vectors from it. With the local interpolation, none.
class RotationReference {
 public:
  RotationReference(const Model& model, const TimeRule& rule);

  bool is_used() const { return interpolation_ != Interpolation::Local; }
  /// Adds to a state what this interpolation keeps there, for the configuration of its nodes. Total rotations go on
  /// from those that it has.
  void initialise(State& state) const;
  /// The points' rotations become those that follow from the nodes of the state, whatever way has led there.
  void forget_path(State& state) const;
  /// The configuration at the beginning of a step.
  void begin(const State& state);
  /// Rotation vectors of the trial configuration. The iterative interpolation moves its reference there.
  void set_trial(const std::vector<NodePose>& nodes);
  /// Writes the points of the trial configuration, and its total rotations, as those of the new state.
  void accept(State& state);

  template <int Nodes>
  void gather(const BeamElement<Nodes>& element, ElementNodes<Nodes>& nodes) const {
    if (!is_used()) return;
    nodes.parameters = parameters_;
    nodes.stiffness_reference = stiffness_.data() + element.first_stiffness_point;
    nodes.mass_reference = mass_.data() + element.first_mass_point;
    for (int i = 0; i < Nodes; ++i) nodes.rotation_vector[i] = vectors_[element.nodes[i]];
  }
  /// Rotation vectors from the undeformed state, continuous up to 2 pi (only with keeps_total_rotations).
  const std::vector<Vector3>& total_rotations() const { return total_; }

 private:
  /// From the undeformed state, of the shortest angle.
  Vector3 total_rotation(std::size_t node, const Quaternion& orientation) const;
  /// The points' rotations that follow from those of nodes.
  void set_points(const std::vector<NodePose>& nodes, State& state) const;
  void compute_points(std::vector<PointRotation>& stiffness, std::vector<PointRotation>& mass) const;

  const Model& model_;
  Interpolation interpolation_;
  RotationParameters parameters_;
  bool keeps_total_;
  std::vector<Quaternion> nodes_;  // the reference, where it is not the undeformed state
  std::vector<PointRotation> stiffness_, mass_, end_stiffness_, end_mass_;
  std::vector<Vector3> vectors_, begin_total_, total_;
};

}  // namespace flexarm
