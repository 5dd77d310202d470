#pragma once
/// Inertia residuals of rigid bodies (and of beams' rotary inertia where a scheme lumps it) at their nodes.

#include "elements/endpoint_beam.h"
#include "model/joint.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// A node over a step.
struct NodeStep {
  const NodePose& begin;
  const NodePose& end;
  const NodeState& state;                   ///< at the beginning
  const Vector3& increment;                 ///< tangent-scaled
  const Matrix3& inverse_tangent;           ///< S(increment)^{-1}
  double step;                              ///< [s]
  Vector3 momentum_rate = Vector3::Zero();  ///< d(Lambda J W)/dt at the beginning; Hilber-Hughes-Taylor family [N m]
};

/// The rotation of a step as the scheme's rule for the angular velocities of nodes counts it, from the tangent-scaled
/// one [rad].
Vector3 counted_rotation(const TimeRule& rule, const Vector3& tangent_scaled);

/// Residual {f, phi} and its translational (scalar) and rotational tangent.
struct NodalAction {
  Vector6 residual = Vector6::Zero();
  double translational = 0;
  Matrix3 rotational = Matrix3::Zero();
  double dissipated = 0;
};

/// (1/h) m (v_1 - v_0), (1/h) (Lambda J W)_1 - (Lambda J W)_0 for conserving schemes; m a, Lambda (W x J W + J A) for
/// Newmark, and for the Hilber-Hughes-Taylor family the momentum-rate form of it. (beam.md 3.4, beyond.md 1.1)
NodalAction nodal_inertia_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node,
                                 bool with_tangent = true);

/// Damping of the beams' rotation that is lumped at the node.
NodalAction nodal_damping_action(const NodalInertia& inertia, const TimeRule& rule, const NodeStep& node);

/// d(Lambda J W)/dt [N m].
inline Vector3 momentum_rate(const Matrix3& rotation, const Matrix3& inertia, const MassPointState& motion) {
  const Vector3 &W = motion.angular_velocity, &A = motion.angular_acceleration;
  return rotation * (W.cross(inertia * W) + inertia * A);
}

/// The node's motion at the end of the step.
NodeState advanced(const TimeRule& rule, const NodeStep& node);

/// Newmark's rule over a step; with alpha for the scheme that interpolates the configuration.
NewmarkRule newmark_rule(const TimeRule& rule, double step);

}  // namespace flexarm
