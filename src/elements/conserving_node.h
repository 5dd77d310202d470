#pragma once
/// Inertia lumped at a node over a step of a conserving scheme, for one node (S = double) or a pack of nodes.

#include <cassert>

#include "elements/beam_point.h"
#include "elements/rotary_inertia.h"

namespace flexarm {

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

}  // namespace flexarm
