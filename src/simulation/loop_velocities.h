#pragma once
/// Finds velocities with which loops of rigid links stay closed.

#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// How fast closed loops open [1/s]. `rate`: the largest rate of a gap over the model's length scale, or of a
/// direction. `fastest`: for comparison, the largest velocity of a node over that length, or angular velocity.
struct LoopOpening {
  double rate = 0, fastest = 0;
  int closure = -1;  ///< the closure that opens with this rate

  static constexpr double kRoundOff = 1e-13;  ///< relative to the fastest motion
  bool is_round_off() const { return rate <= kRoundOff * fastest; }
};
/// `velocities`: {v, w} per node, world axes.
LoopOpening opening_of(const Model& model, const std::vector<NodePose>& poses, const std::vector<Vector6>& velocities);

/// A change of velocities.
struct VelocityChange {
  std::vector<Vector6> nodes;         ///< per node {v, w}, world axes; slaves follow their joints
  std::vector<ReleasedVector> rates;  ///< per joint
  bool is_nothing() const { return nodes.empty(); }
};

/// The change dv of velocities with the least kinetic energy that keeps loops closed: M dv + B^T i = 0, B (v + dv) = 0,
/// with the mass matrix M of the tree and the constraint matrix B (joints.md 3.2). It is the effect of impulses i of
/// the joints that close loops, so that momenta are conserved. Prescribed motions do not change. The result is empty if
/// loops open by no more than round-off, or if the equations have no solution. `velocities`: {v, w} per node, world
/// axes; used instead of the state's.
VelocityChange closing_change(const Model& model, const DegreesOfFreedom& dof, const State& state,
                              const std::vector<Vector6>& velocities);

/// Adds to a state the closing_change() of its own velocities: to nodes, to the angular velocities at mass points, and
/// to rotors that turn with their coordinates.
State with_closed_loops(const Model& model, const DegreesOfFreedom& dof, State state);

}  // namespace flexarm
