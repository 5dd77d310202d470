#pragma once
/// The integration points of all beams at both ends of a step, of the families whose elements go one by one.

#include <vector>

#include "elements/additive_beam.h"
#include "integrators/balance.h"
#include "integrators/rotation_reference.h"
#include "integrators/step_prestrains.h"

namespace flexarm {

/// Life of a step: begin(); elements are gathered and write the points of the trial configuration; accept().
class IntegrationPoints {
 public:
  IntegrationPoints(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  /// Points of the configuration at the beginning, unless those of the last step's end still hold. `carries`: strains
  /// are carried along for the tangents of the step.
  void begin(bool carries);
  /// The state was changed from outside.
  void invalidate() { hold_ = false; }
  /// The strains that the geometric part of the next tangent sees become those of an update of the nodes from the poses
  /// `end`, 6 numbers each.
  void carry_strains(const std::vector<NodePose>& end, const double* update);
  /// Of the stiffness points from `first` on; null unless the balance's tangent is to see them.
  const Vector6* carried(int first, const Balance& balance) const {
    return balance.carried ? &carried_strains_[first] : nullptr;
  }
  bool carries_strains() const { return carries_ && holds_carried_; }
  /// A tangent has seen them.
  void drop_carried() { holds_carried_ = false; }
  /// See BeamFamily.
  double work_of_prestrains() const;
  /// The points at hand become those at the beginning of the next step, and the state's.
  void accept(State& state);

  /// An element's nodes, moved to the poses `end`.
  template <int Nodes>
  void gather(const BeamElement<Nodes>& element, const std::vector<NodePose>& end, ElementNodes<Nodes>& nodes) const {
    const StepConfiguration& c = configuration_;
    for (int i = 0; i < Nodes; ++i) {
      const int node = element.nodes[i];
      nodes.begin[i] = c.begin()[node].position;
      nodes.end[i] = end[node].position;
      nodes.orientation[i] = end[node].orientation;
      nodes.increment[i] = c.increments()[node];
      nodes.increment_inverse_tangent[i] = c.inverse_tangents()[node];
      nodes.velocity[i] = c.state().nodes[node].velocity;
      nodes.acceleration[i] = c.state().nodes[node].acceleration;
    }
    nodes.prestrain = prestrains_.of_step(element.prestrain);
    reference.gather(element, nodes);
  }

  RotationReference reference;
  std::vector<PointKinematics> begin_stiffness, end_stiffness;
  std::vector<Matrix3> begin_rotations, end_rotations;  ///< of mass points
  std::vector<MassPointState> end_motion;               ///< of mass points

 private:
  void set_begin_points();

  const StepConfiguration& configuration_;
  const StepPrestrains& prestrains_;
  bool hold_ = false;
  bool carries_ = false, holds_carried_ = false;
  std::vector<Vector6> carried_strains_;  // of stiffness points
};

/// Adds an element's system to the balance. `is_first`: nothing else of this element has been added before.
template <int Nodes>
void scatter(const BeamElement<Nodes>& element, const ElementSystem<Nodes>& system, Balance& balance, bool is_first);

}  // namespace flexarm
