#pragma once
/// The nodes and integration points of all beams at both ends of a step, for families that evaluate elements one by
/// one.

#include <vector>

#include "integrators/balance.h"
#include "integrators/step_prestrains.h"
#include "study_schemes/rotation_reference.h"

namespace flexarm {

/// Order of calls in a step: begin(); elements gather nodes and write the points of the trial configuration; accept().
class IntegrationPoints {
 public:
  IntegrationPoints(const StepConfiguration& configuration, const StepPrestrains& prestrains);

  /// Starts a step. Computes the points at its beginning, unless those at the end of the last step are still valid.
  /// `carries`: whether strains are carried for the tangents of this step (docs/notes/newton.md).
  void begin(bool carries);
  /// To be called after the state was changed by something other than a step.
  void invalidate() { hold_ = false; }
  /// Updates the carried strains, which the geometric part of the next tangent uses: linearised strains after an update
  /// of the nodes, 6 numbers each, from the poses `end`.
  void carry_strains(const std::vector<NodePose>& end, const double* update);
  /// The carried strains of the stiffness points from `first` on; null unless the balance's tangent uses carried
  /// strains.
  const Vector6* carried(int first, const Balance& balance) const {
    return balance.carried ? &carried_strains_[first] : nullptr;
  }
  bool carries_strains() const { return carries_ && holds_carried_; }
  /// To be called after a tangent has used the carried strains.
  void drop_carried() { holds_carried_ = false; }
  /// See SchemeFamily::work_of_prestrains().
  double work_of_prestrains() const;
  /// Makes the present points those at the beginning of the next step, and writes them into the state.
  void accept(State& state);

  /// Gathers an element's nodes, with the poses `end` at the end of the step.
  template <int Nodes>
  void gather(const BeamElement<Nodes>& element, const std::vector<NodePose>& end, ElementNodes<Nodes>& nodes) const {
    const StepConfiguration& c = configuration_;
    for (int i = 0; i < Nodes; ++i) {
      const int node = element.nodes[i];
      nodes.begin[i] = c.begin()[node].position;
      nodes.end[i] = end[node].position;
      nodes.orientation[i] = end[node].orientation;
      nodes.increment[i] = c.increments()[node];
      nodes.increment_inverse_tangent[i] = inverse_tangents[node];
      nodes.velocity[i] = c.state().nodes[node].velocity;
      nodes.acceleration[i] = c.state().nodes[node].acceleration;
    }
    nodes.prestrain = prestrains_.of_step(element.prestrain);
    reference.gather(element, nodes);
  }

  /// Computes inverse_tangents of the trial configuration.
  void set_inverse_tangents();

  RotationReference reference;
  std::vector<Matrix3> inverse_tangents;  ///< per node: S(increment)^{-1}
  std::vector<PointKinematics> begin_stiffness, end_stiffness;
  std::vector<Matrix3> begin_rotations, end_rotations;  ///< per mass point
  std::vector<MassPointState> end_motion;               ///< per mass point

 private:
  void set_begin_points();

  const StepConfiguration& configuration_;
  const StepPrestrains& prestrains_;
  bool hold_ = false;
  bool carries_ = false, holds_carried_ = false;
  std::vector<Vector6> carried_strains_;  // per stiffness point
};

}  // namespace flexarm
