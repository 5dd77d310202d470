#pragma once
/// Residual and tangent of a spring between points of two nodes.

#include "joints/closure_maps.h"
#include "joints/coordinate_step.h"
#include "model/point_spring.h"
#include "model/state.h"

namespace flexarm {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

struct SpringAction {
  Vector6 child, parent;  ///< what it adds to the nodes' residuals
  Matrix12 tangent;       ///< derivative with respect to {displacement, spin} of {child, parent} at the end
  double dissipated = 0;  ///< over the step [J]
};

/// Of a state.
inline ClosurePoses closure_poses(const LoopClosure& closure, const State& state) {
  return {closure.parent < 0 ? NodePose() : node_pose(state.nodes[closure.parent]),
          node_pose(state.nodes[closure.child])};
}

/// How long the spring of a closure is, between the points of its nodes.
double spring_length(const LoopClosure& ends, const ClosurePoses& poses);
/// The force acts along the mean of both ends of the step, or along the end where `change` has it there. In means, with
/// l the mean of both lengths and d that of both distances, it is
///   ((stiffness (l - rest length) + damping dl/dt) / l) d:
/// its work is exactly the change of the energy, stiffness (length - rest length)^2 / 2, and what the damper takes; and
/// it adds to no momentum. `change`: of the length.
SpringAction spring_action(const PointSpring& spring, const LoopClosure& ends, const ClosurePoses& begin,
                           const ClosurePoses& end, const CoordinateStep& change);

/// Derivative of its length with respect to {displacement, spin} of {child, parent}.
Vector12 spring_gradient(const LoopClosure& ends, const ClosurePoses& poses);

}  // namespace flexarm
