#pragma once
/// Inertia and damping that are lumped at a node, by the rules of any scheme, for one node at a time.

#include "elements/node_motion.h"
#include "model/model.h"
#include "study_schemes/newmark_rule.h"

namespace flexarm {

/// A node over a step.
struct NodeStep {
  const NodePose& begin;
  const NodePose& end;
  const NodeState& state;                   ///< at the beginning
  const Vector3& increment;                 ///< of rotation, tangent-scaled
  const Matrix3& inverse_tangent;           ///< S(increment)^{-1}
  double step;                              ///< [s]
  Vector3 momentum_rate = Vector3::Zero();  ///< d(Lambda J W)/dt at the beginning; Hilber-Hughes-Taylor family [N m]
};

/// Residual {f, phi}, and its tangent: d(f)/d(r) = translational I, d(phi)/d(spin) = rotational.
struct NodalAction {
  Vector6 residual = Vector6::Zero();
  double translational = 0;
  Matrix3 rotational = Matrix3::Zero();
  double dissipated = 0;  ///< over the step [J]
};

/// Returns the inertia residual (beam.md 3.4, beyond.md 1.1). With l = Lambda J W:
///   conserving schemes:            f = m (v_1 - v_0) / h,   phi = (l_1 - l_0) / h
///   Newmark scheme:                f = m a,                 phi = Lambda (W x J W + J A)
///   Hilber-Hughes-Taylor family:   f = m a,                 phi: see momentum_rotary_rate()
NodalAction nodal_inertia_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node,
                                 bool with_tangent = true);

/// Returns the mass-proportional damping of the beams' rotation, which is lumped at the node.
NodalAction nodal_damping_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node,
                                 bool with_tangent = true);

/// Returns the node's motion at the end of the step.
NodeState advanced(const TimeRule& rule, const NodeStep& node);

/// Returns Newmark's rule for a step, with alpha only for HhtForm::Kinematics.
NewmarkRule newmark_rule(const TimeRule& rule, double step);

}  // namespace flexarm
