#pragma once
/// Beam residual and tangent over a step of Newmark's family in the plane: endpoint_beam.h term by term, where they are
/// not zero. (docs/notes/planar.md)

#include "elements/endpoint_stress.h"
#include "elements/planar_beam.h"

namespace flexarm::planar {

/// What the family needs to know of an element beside planar::Element: rotary inertia at the mass points.
template <int Nodes, typename S = double>
struct RotaryElement {
  std::array<NodalValues<Nodes, S>, Nodes> shape;  ///< per mass point
  std::array<S, Nodes> weight, inertia;            ///< of the integral [m], about the normal per length [kg m]
};

/// Makes an element a lane. `normal`: that of the plane, in the frames of its sections.
template <int Nodes, typename S>
void set_lane(RotaryElement<Nodes, S>& pack, int lane, const BeamElement<Nodes>& element, const Vector3& normal) {
  using flexarm::set_lane;
  for (int k = 0; k < Nodes; ++k) {
    const auto& point = element.mass_points[k];
    set_lane(pack.shape[k], lane, point.shape);
    set_lane(pack.weight[k], lane, point.weight);
    set_lane(pack.inertia[k], lane, normal.dot(point.inertia * normal));
  }
}

/// Nodal motion over a step.
template <int Nodes, typename S = double>
struct EndpointNodal {
  std::array<Vector2T<S>, Nodes> position;      ///< where strains count: at t_{n+1}, or t_{n+1+alpha} (HHT3) [m]
  std::array<S, Nodes> cosine, sine;            ///< of half the angle there, see PlanarPose
  std::array<Vector2T<S>, Nodes> acceleration;  ///< at t_{n+1} [m/s^2]
  std::array<S, Nodes> turn;                    ///< over the step [rad]
  std::array<Vector2T<S>, Nodes> displacement, damped_velocity;  ///< of mass-proportional damping [m, m/s]
};

/// What an element's points remember from the beginning of a step.
template <int Nodes, typename S = double>
struct EndpointMemory {
  std::array<PointKinematics<S>, Nodes - 1> points;
  std::array<Vector3T<S>, Nodes - 1> strain_rates;
  std::array<S, Nodes> rotary;  ///< per mass point: the angular acceleration at t_{n+1} if nothing turns [rad/s^2]
};

/// The same at the trial configuration; angular accelerations are those of t_{n+1}.
template <int Nodes, typename S = double>
using EndpointResult = EndpointMemory<Nodes, S>;

/// How forces go into the balance.
struct EndpointBalance {
  NewmarkRule rule;
  double internal_slope = 1;         ///< of the tangents of internal forces: they are interpolated in time
  bool interpolates_damping = true;  ///< mass-proportional damping is one of them
};

/// Translational inertia and mass-proportional damping, see newmark_translation() and newmark_mass_damping(). Sets the
/// system.
template <int Nodes, typename S>
void set_newmark_translation(const Element<Nodes, S>& element, const EndpointNodal<Nodes, S>& nodes,
                             const EndpointBalance& balance, bool with_tangent, BlockSystem<Nodes, S>& system,
                             std::array<Eigen::Matrix<S, 4, 1>, Nodes>& inertia) {
  const NewmarkRule& rule = balance.rule;
  const S zero(0);
  S slope(rule.acceleration_slope());
  system.dissipated = zero;
  for (int i = 0; i < Nodes; ++i) {
    const Vector2T<S> force = sum_of<Nodes, S>(element.mass.row(i).transpose(), nodes.acceleration);
    inertia[i] << force[0], force[1], zero, zero;
    system.residual[i].setConstant(zero);
  }
  if (element.has_mass_damping) {
    const double of_balance = balance.interpolates_damping ? balance.internal_slope : 1.0;
    slope += element.mass_damping * S(of_balance * (1 + rule.alpha) * rule.velocity_slope());
    for (int i = 0; i < Nodes; ++i) {
      const Vector2T<S> force =
          element.mass_damping * sum_of<Nodes, S>(element.mass.row(i).transpose(), nodes.damped_velocity);
      system.dissipated += dot<S>(force, nodes.displacement[i]);
      auto& to = balance.interpolates_damping ? system.residual[i] : inertia[i];
      to[0] += force[0];
      to[1] += force[1];
    }
  }
  for (int i = 0; i < Nodes && with_tangent; ++i)
    for (int j = 0; j < Nodes; ++j) {
      system.tangent[i][j].setConstant(zero);
      system.tangent[i][j](0, 0) = system.tangent[i][j](1, 1) = slope * element.mass(i, j);
    }
}

/// Rotary inertia at the mass points: there are no gyroscopic terms, so that both forms of it, newmark_rotary_rate()
/// and momentum_rotary_rate(), are the angular acceleration times it.
template <int Nodes, typename S>
void add_newmark_rotation(const RotaryElement<Nodes, S>& element, const EndpointNodal<Nodes, S>& nodes,
                          const std::array<S, Nodes>& begin, const NewmarkRule& rule, bool with_tangent,
                          std::array<S, Nodes>& acceleration, BlockSystem<Nodes, S>& system,
                          std::array<Eigen::Matrix<S, 4, 1>, Nodes>& inertia) {
  const S slope(rule.acceleration_slope());
  for (int k = 0; k < Nodes; ++k) {
    const NodalValues<Nodes, S>& shape = element.shape[k];
    acceleration[k] = begin[k] + slope * sum_of<Nodes, S>(shape, nodes.turn);
    const S mass = element.weight[k] * element.inertia[k], moment = mass * acceleration[k], derivative = slope * mass;
    for (int i = 0; i < Nodes; ++i) {
      inertia[i][2] += shape[i] * moment;
      for (int j = 0; j < Nodes && with_tangent; ++j) system.tangent[i][j](2, 2) += shape[i] * shape[j] * derivative;
    }
  }
}

/// The stress of a point at some strain.
template <int Nodes, typename S>
EndpointStress<Matrix3T<S>> endpoint_stress(const Element<Nodes, S>& element, int k, const NewmarkRule& rule,
                                            const EndpointMemory<Nodes, S>& begin, const Vector3T<S>& strain) {
  const auto& constants = element.points[k];
  EndpointStress<Matrix3T<S>> out(constants.section.matrix, strain);
  if (element.has_stiffness_damping)
    out.add_damping(element.stiffness_damping, constants.damped.matrix, strain, begin.points[k].strain,
                    begin.strain_rates[k], rule);
  return out;
}

/// {dn_1, dn_2, dm} of a variation {dr', spin, spin'} of a point, of a section with the stiffness C + extra DCD; n is
/// not turned.
template <typename S, class Constants>
Vector3T<S> endpoint_slope(const Constants& constants, const S& weight, const S* extra, const Turn<S>& turn,
                           const Vector2T<S>& tangent, const PointVariation<S>& v) {
  const Vector3T<S> change = strain_slope<S>(turn, tangent, v.position, v.spin, v.spin_derivative);
  Vector3T<S> stress = constants.section.stress(change);
  if (extra) stress += *extra * constants.damped.stress(change);
  stress *= weight;
  const Vector2T<S> force = turn.to_plane(force_of<S>(stress));
  return {force[0], force[1], stress[2]};
}

/// Tangent of a point's forces. `seen`: {N, M} of its geometric part, times the point's weight as `weight` is.
template <int Nodes, typename S>
void add_endpoint_tangent(const typename Element<Nodes, S>::Point& constants, const S& weight, const S* extra,
                          const Point<S>& p, const Vector3T<S>& seen, BlockSystem<Nodes, S>& system) {
  const S zero(0), one(1);
  const auto slope_of = [&](const PointVariation<S>& variation) {
    return endpoint_slope<S>(constants, weight, extra, p.average, p.arm, variation);
  };
  const Vector2T<S> none(zero, zero), n = p.average.to_plane(force_of<S>(seen)), turned = quarter_turn<S>(n);
  const std::array<Vector3T<S>, 2> position = {slope_of({{one, zero}, zero, zero, zero, zero}),
                                               slope_of({{zero, one}, zero, zero, zero, zero})};
  Vector3T<S> spin = slope_of({none, one, zero, zero, zero});
  const Vector3T<S> spin_derivative = slope_of({none, zero, one, zero, zero});
  spin[0] += turned[0];
  spin[1] += turned[1];
  const std::array<S, 2> couple = {cross<S>(p.arm, force_of<S>(position[0])) + n[1],
                                   cross<S>(p.arm, force_of<S>(position[1])) - n[0]};
  std::array<Vector3T<S>, Nodes> turns;
  for (int j = 0; j < Nodes; ++j) turns[j] = constants.shape[j] * spin + constants.derivative[j] * spin_derivative;
  add_point_tangent<Nodes, S>(constants, one, p.arm, position, couple, turns, system);
}

/// Forces of an element over a step, with the tangent where it is asked for: internal ones in the system's residual,
/// those of inertia apart. `carried`: the strains that the geometric part of the tangent sees, or null.
template <int Nodes, typename S>
void endpoint_beam(const Element<Nodes, S>& element, const RotaryElement<Nodes, S>& rotary,
                   const EndpointNodal<Nodes, S>& nodes, const EndpointBalance& balance,
                   const EndpointMemory<Nodes, S>& begin, bool with_tangent,
                   const std::array<Vector3T<S>, Nodes - 1>* carried, EndpointResult<Nodes, S>& end,
                   BlockSystem<Nodes, S>& system, std::array<Eigen::Matrix<S, 4, 1>, Nodes>& inertia) {
  const NewmarkRule& rule = balance.rule;
  set_points<Nodes, S>(element, nodes.position, nodes.cosine, nodes.sine, end.points.data());
  set_newmark_translation<Nodes, S>(element, nodes, balance, with_tangent, system, inertia);
  add_newmark_rotation<Nodes, S>(rotary, nodes, begin.rotary, rule, with_tangent, end.rotary, system, inertia);
  for (int i = 0; i < Nodes && carried; ++i) system.carried[i].setConstant(S(0));
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const PointKinematics<S>& at = end.points[k];
    Point<S> p;
    p.average = {at.cosine, at.sine};
    p.arm = at.tangent;
    const auto own = endpoint_stress<Nodes, S>(element, k, rule, begin, at.strain);
    system.dissipated += constants.weight * own.dissipated;
    end.strain_rates[k] = own.strain_rate;
    const Vector3T<S> resultants = constants.weight * own.stress;
    add_residual<Nodes, S>(constants, S(1), p, resultants, system.residual);
    if (!with_tangent) continue;
    const S weight = constants.weight * S(balance.internal_slope), extra = own.slope - S(1);
    Vector3T<S> seen = S(balance.internal_slope) * resultants;
    if (carried) {
      const Vector3T<S> own_resultants = seen;
      seen = weight * endpoint_stress<Nodes, S>(element, k, rule, begin, (*carried)[k]).stress;
      add_residual<Nodes, S>(constants, S(1), p, Vector3T<S>(seen - own_resultants), system.carried);
    }
    add_endpoint_tangent<Nodes, S>(constants, weight, element.has_stiffness_damping ? &extra : nullptr, p, seen,
                                   system);
  }
}

/// See flexarm::carry_strains. `update`: {dx, dy, spin} of the nodes, `points`: before it.
template <int Nodes, typename S>
void carry_endpoint_strains(const Element<Nodes, S>& element, const std::array<PointKinematics<S>, Nodes - 1>& points,
                            const std::array<Vector3T<S>, Nodes>& update, std::array<Vector3T<S>, Nodes - 1>& carried) {
  std::array<Vector2T<S>, Nodes> displacement;
  std::array<S, Nodes> spin;
  for (int i = 0; i < Nodes; ++i) {
    displacement[i] = {update[i][0], update[i][1]};
    spin[i] = update[i][2];
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    const PointKinematics<S>& at = points[k];
    carried[k] = at.strain +
                 strain_slope<S>({at.cosine, at.sine}, at.tangent, sum_of<Nodes, S>(constants.derivative, displacement),
                                 sum_of<Nodes, S>(constants.shape, spin), sum_of<Nodes, S>(constants.derivative, spin));
  }
}

}  // namespace flexarm::planar
