#pragma once
/// Inertia lumped at a node over a step of a conserving scheme, for one node (S = double) or a pack of nodes.

#include <cassert>

#include "flexarm/math/pose.h"
#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm {

/// The average rule for a rotary inertia: the rate of its angular momentum is (Lambda_1 J W_1 - Lambda_0 J W_0) / h,
/// with (W_0 + W_1) / 2 = Omega / h and the material increment Omega. `increment` is the spatial rotation increment
/// (unscaled or tangent-scaled). `inverse_tangent` (T^{-1} or S^{-1}) maps a spin to the variation of `increment`; only
/// the derivative needs it. S: a scalar or a pack.
template <typename S>
struct AverageRate {
  Vector3T<S> angular_velocity;  ///< at the end, in the section's frame
  Vector3T<S> moment;            ///< world axes
  Matrix3T<S> derivative;        ///< d(moment)/d(spin)
  Matrix3T<S> to_momentum;       ///< J d(Omega)/d(spin)

  AverageRate(const Matrix3T<S>& inertia, const Matrix3T<S>& begin, const Matrix3T<S>& end,
              const Vector3T<S>& increment, const Matrix3T<S>& inverse_tangent,
              const Vector3T<S>& begin_angular_velocity, double step, bool with_derivative) {
    angular_velocity = S(2 / step) * (begin.transpose() * increment) - begin_angular_velocity;
    const Vector3T<S> begin_momentum = inertia * begin_angular_velocity, end_momentum = inertia * angular_velocity;
    const Vector3T<S> momentum = end * end_momentum;
    moment = S(1 / step) * (momentum - begin * begin_momentum);
    if (!with_derivative) return;
    to_momentum.noalias() = inertia.lazyProduct(Matrix3T<S>(begin.transpose().lazyProduct(inverse_tangent)));
    derivative = S(2 / (step * step)) * end.lazyProduct(to_momentum);
    derivative -= so3::hat(Vector3T<S>(S(1 / step) * momentum));
  }
};

/// Mass [kg] and rotary inertia in the node's frame [kg m^2].
template <typename S>
struct LumpedInertia {
  S mass;
  Matrix3T<S> rotary;
};

/// A node's motion over a step.
template <typename S>
struct NodeMotion {
  Matrix3T<S> begin, end;                  ///< rotations
  Vector3T<S> displacement;                ///< [m]
  Vector3T<S> increment;                   ///< of rotation, tangent-scaled or not
  Matrix3T<S> inverse_tangent;             ///< maps a spin to the increment's variation; needed only for the tangent
  Vector3T<S> velocity, angular_velocity;  ///< at the beginning; angular velocity in the node's frame
};

/// Residual and tangent: f = m (v_1 - v_0) / h, phi = ((Lambda J W)_1 - (Lambda J W)_0) / h, with
/// v_1 = factor Delta r / h - (factor - 1) v_0 and the rule of AverageRate for W. (beam.md 3.4)
template <typename S>
struct ConservingNode {
  Vector6T<S> residual;    ///< {f, phi}
  S translational;         ///< d(f)/d(r) = translational I
  Matrix3T<S> rotational;  ///< d(phi)/d(spin); set only with the tangent

  ConservingNode(const LumpedInertia<S>& inertia, const NodeMotion<S>& node, double factor, double step,
                 bool with_tangent) {
    assert(step != 0);
    const AverageRate<S> rate(inertia.rotary, node.begin, node.end, node.increment, node.inverse_tangent,
                              node.angular_velocity, step, with_tangent);
    residual.template head<3>() = (inertia.mass * S(factor / step)) * (S(1 / step) * node.displacement - node.velocity);
    residual.template tail<3>() = rate.moment;
    translational = inertia.mass * S(factor / (step * step));
    if (with_tangent) rotational = rate.derivative;
  }
};

/// Mass-proportional damping of the rotation of beams that is lumped at a node. The moment is D Omega / h with the
/// material increment Omega, mapped to world axes by the mean rotation. It dissipates Omega . D Omega / h, which is
/// never negative, because Lambda_0 Omega = Lambda_1 Omega.
template <typename S>
struct NodeDamping {
  Vector3T<S> moment;      ///< world axes [N m]
  Matrix3T<S> derivative;  ///< d(moment)/d(spin); set only with the tangent
  S dissipated;            ///< over the step [J]

  /// `damping`: D, in the node's frame [kg m^2/s].
  NodeDamping(const Matrix3T<S>& damping, const NodeMotion<S>& node, double step, bool with_tangent) {
    const Vector3T<S> turned = node.begin.transpose() * node.increment, rate = S(1 / step) * (damping * turned);
    const Matrix3T<S> mean = S(0.5) * (node.begin + node.end);
    moment = mean * rate;
    dissipated = turned.dot(rate);
    if (!with_tangent) return;
    const Matrix3T<S> to_turned = node.begin.transpose().lazyProduct(node.inverse_tangent);
    derivative = S(1 / step) * mean.lazyProduct(Matrix3T<S>(damping.lazyProduct(to_turned)));
    derivative -= so3::hat(Vector3T<S>(S(0.5) * (node.end * rate)));
  }
};

}  // namespace flexarm
