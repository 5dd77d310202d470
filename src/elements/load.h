#pragma once
/// Forces of nodal loads over a step, and their derivatives.

#include "model/joint.h"
#include "model/model.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// The rotation of the node with which a load acts in a step.
enum class LoadPoint {
  Mean,  ///< mean rotation (conserving schemes), with exact work over the step
  End    ///< rotation at the end (statics, Newmark)
};

/// Returns the LoadPoint of a scheme.
inline LoadPoint load_point(const TimeRule& rule) {
  return rule.is_incremental() ? LoadPoint::Mean : LoadPoint::End;
}

/// Spatial force and moment about the node, and their derivative with respect to the node's spin at the end (6 x 3).
struct LoadAction {
  Vector6 wrench;
  Eigen::Matrix<double, 6, 3> derivative;
};

/// Returns the action of a load. `scale`: value of the load's history. (beam.md 3.4)
LoadAction load_action(const NodalLoad& load, double scale, const Matrix3& begin, const Matrix3& end, LoadPoint point);

/// Spatial force and moment about the node, their derivative with respect to the node's {displacement, spin} at the
/// end, and the work over the step [J].
struct PullAction {
  Vector6 wrench;
  Matrix6 derivative;
  double work = 0;
};

/// Returns the action of a load's Pull on its point: stiffness times the vector to the target (mean over the step, or
/// at the end), minus damping times the mean velocity over the step. (beam.md 3.4)
/// @param target  relative to the origin of the nodes' positions [m]
/// @param step    [s]; 0: statics, without damping
PullAction pull_action(const NodalLoad& load, const Vector3& target, const NodePose& begin, const NodePose& end,
                       double step, LoadPoint point);

}  // namespace flexarm
