#pragma once
/// Residual and tangent of a nodal load.

#include "model/joint.h"
#include "model/model.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// With which rotation a load acts in a step.
enum class LoadPoint {
  Mean,  ///< average rotation (conserving schemes): the work over the step is exact
  End    ///< rotation at the end (statics, Newmark)
};

/// Where a scheme has them.
inline LoadPoint load_point(const TimeRule& rule) {
  return rule.is_incremental() ? LoadPoint::Mean : LoadPoint::End;
}

/// Spatial force and moment about the node, and their derivative with respect to the node's spin at the end (6 x 3).
struct LoadAction {
  Vector6 wrench;
  Eigen::Matrix<double, 6, 3> derivative;
};

/// `scale`: value of the load's history. (beam.md 3.4)
LoadAction load_action(const NodalLoad& load, double scale, const Matrix3& begin, const Matrix3& end, LoadPoint point);

/// Spatial force and moment about the node, their derivative with respect to the node's {displacement, spin} at the
/// end, and the work over the step [J].
struct PullAction {
  Vector6 wrench;
  Matrix6 derivative;
  double work = 0;
};

/// Of the pull on a load's point: stiffness times the way to the target (its mean over the step, or that at the end),
/// damping times the mean velocity over the step. (beam.md 3.4)
/// @param target  about the origin of the nodes' positions [m]
/// @param step    [s]; 0: statics, in which nothing is damped
PullAction pull_action(const NodalLoad& load, const Vector3& target, const NodePose& begin, const NodePose& end,
                       double step, LoadPoint point);

}  // namespace flexarm
