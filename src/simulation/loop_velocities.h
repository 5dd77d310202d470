#pragma once
/// Finds velocities with which loops of rigid links stay closed.

#include "joints/joint_map.h"
#include "model/degrees_of_freedom.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// How fast the constraints of closed loops open [1/s]: the largest rate of a gap over the model's length scale, or of
/// a direction; and, to compare it with, the fastest node over that length.
struct LoopOpening {
  double rate = 0, fastest = 0;
  int closure = -1;  ///< that opens with this rate

  static constexpr double kRoundOff = 1e-13;  ///< of the fastest motion
  bool is_round_off() const { return rate <= kRoundOff * fastest; }
};
/// `velocities`: {v, w} per node, world axes.
LoopOpening opening_of(const Model& model, const std::vector<NodePose>& poses, const std::vector<Vector6>& velocities);

/// What velocities change by.
struct VelocityChange {
  std::vector<Vector6> nodes;         ///< per node {v, w}, world axes; slaves as their joints have them
  std::vector<ReleasedVector> rates;  ///< per joint
  bool is_nothing() const { return nodes.empty(); }
};

/// The change of velocities of least kinetic energy with which no loop opens: M dv + B^T i = 0, B (v + dv) = 0 with the
/// mass matrix M of the tree and the rates B of the constraints (joints.md 3.2). It is what impulses i of the joints
/// that close loops would do, so that momenta stay. Nothing where loops open by no more than round-off, or where the
/// equations have no solution. Motions that are prescribed stay as they are. `velocities`: {v, w} per node, world axes,
/// in the place of the state's.
VelocityChange closing_change(const Model& model, const DegreesOfFreedom& dof, const State& state,
                              const std::vector<Vector6>& velocities);

/// The state with that of its own velocities: nodes, the spins of beams at their mass points, rotors that turn with
/// their coordinates.
State with_closed_loops(const Model& model, const DegreesOfFreedom& dof, State state);

}  // namespace flexarm
