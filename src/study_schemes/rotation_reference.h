#pragma once
/// The reference rotations of nodes and integration points, for all interpolations except Interpolation::Local.

#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"
#include "study_schemes/element_nodes.h"

namespace flexarm {

/// The reference configuration of a step's interpolation, and the nodes' rotation vectors relative to it. Unused with
/// the local interpolation.
class RotationReference {
 public:
  RotationReference(const Model& model, const TimeRule& rule);

  bool is_used() const { return interpolation_ != Interpolation::Local; }
  /// Adds to a state the rotations that this interpolation keeps there, for the configuration of its nodes. Total
  /// rotation vectors that the state has already are continued.
  void initialise(State& state) const;
  /// Replaces the rotations of points by those that follow from the nodes of the state, independent of the path to it.
  void forget_path(State& state) const;
  /// Starts a step from the configuration of `state`.
  void begin(const State& state);
  /// Computes rotation vectors of the trial configuration. The iterative interpolation then makes it the new reference.
  void set_trial(const std::vector<NodePose>& nodes);
  /// Writes the rotations of points in the trial configuration, and its total rotation vectors, into the new state.
  void accept(State& state);

  template <int Nodes>
  void gather(const BeamElement<Nodes>& element, ElementNodes<Nodes>& nodes) const {
    if (!is_used()) return;
    nodes.parameters = parameters_;
    nodes.stiffness_reference = stiffness_.data() + element.first_stiffness_point;
    nodes.mass_reference = mass_.data() + element.first_mass_point;
    for (int i = 0; i < Nodes; ++i) nodes.rotation_vector[i] = vectors_[element.nodes[i]];
  }
  /// Rotation vectors from the undeformed state, continuous up to 2 pi. Only if `keeps_total_` is set.
  const std::vector<Vector3>& total_rotations() const { return total_; }

 private:
  /// Rotation vector of a node from the undeformed state, with the smallest angle.
  Vector3 total_rotation(std::size_t node, const Quaternion& orientation) const;
  /// Computes the rotations of points from those of nodes.
  void set_points(const std::vector<NodePose>& nodes, State& state) const;
  void compute_points(std::vector<PointRotation>& stiffness, std::vector<PointRotation>& mass) const;

  const Model& model_;
  Interpolation interpolation_;
  RotationParameters parameters_;
  bool keeps_total_;
  std::vector<Quaternion> nodes_;  // reference orientations; not used if the reference is the undeformed state
  std::vector<PointRotation> stiffness_, mass_, end_stiffness_, end_mass_;
  std::vector<Vector3> vectors_, begin_total_, total_;
};

}  // namespace flexarm
