#pragma once
/// Kinematics of the energy-momentum family's elements: generalised shape functions of the middle of a step, and the
/// stiffness points at its end.

#include "elements/conserving_point.h"
#include "math/cayley.h"

namespace flexarm {

/// Rotations at the stiffness points; an element of two nodes has its only one half-way between them.
template <int Nodes, typename S>
std::array<InterpolatedRotation<S>, Nodes - 1> point_rotations(const ConservingElement<Nodes, S>& element,
                                                               const LocalRotations<Nodes, S>& local) {
  std::array<InterpolatedRotation<S>, Nodes - 1> rotations;
  if constexpr (Nodes == 2) {
    rotations[0] = evaluate_half_way(local, element.points[0].derivative[1]);
  } else {
    for (int k = 0; k < Nodes - 1; ++k)
      rotations[k] = local.evaluate(element.points[k].shape, element.points[k].derivative);
  }
  return rotations;
}
/// The same with `functions(k)`, the generalised shape functions at the point k.
template <int Nodes, typename S, class Functions>
std::array<InterpolatedRotation<S>, Nodes - 1> point_rotations(const ConservingElement<Nodes, S>& element,
                                                               const LocalRotations<Nodes, S>& local,
                                                               const Functions& functions) {
  std::array<InterpolatedRotation<S>, Nodes - 1> rotations;
  if constexpr (Nodes == 2) {
    rotations[0] = evaluate_half_way(local, element.points[0].derivative[1], functions(0));
  } else {
    const LocalRotationVariation<Nodes, S> variation(local);
    for (int k = 0; k < Nodes - 1; ++k)
      rotations[k] = variation.evaluate(element.points[k].shape, element.points[k].derivative, functions(k));
  }
  return rotations;
}

/// Generalised shape functions for the middle of a step from `orientation` by the `foreseen` tangent-scaled increments:
/// those of the configuration half-way.
template <int Nodes, typename S>
void mid_functions(const ConservingElement<Nodes, S>& element, const std::array<QuaternionT<S>, Nodes>& orientation,
                   const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  std::array<QuaternionT<S>, Nodes> half_way;
  for (int i = 0; i < Nodes; ++i) half_way[i] = cayley::half_quaternion(foreseen[i]) * orientation[i];
  point_rotations(
      element, LocalRotations<Nodes, S>(half_way), [&](int k) -> auto& { return functions[k]; });
}

/// The stretch P = I + (cos(theta/2) - 1) e e^T, angle theta about e, of the mean of the `foreseen` increments: values
/// P^-1 I_g P and derivatives P I_g' P. With it the conjugate strain of a step that turns the element by any angle is
/// exact to first order in what else it does, and the energy multiplier has little to make up for (beyond.md 1.3).
template <int Nodes, typename S>
void stretch_mid_functions(const std::array<Vector3T<S>, Nodes>& foreseen, ElementFunctions<Nodes, S>& functions) {
  const Vector3T<S> mean = mean_of<Nodes, S>(foreseen);
  const Matrix3T<S> stretch = cayley::axial_stretch(mean), inverse = cayley::inverse_axial_stretch(mean);
  for (int k = 0; k < Nodes - 1; ++k) {
    for (int i = 0; i < Nodes; ++i) {
      const Matrix3T<S> value = functions[k].values[i].lazyProduct(stretch),
                        derivative = functions[k].derivatives[i].lazyProduct(stretch);
      functions[k].values[i] = inverse.lazyProduct(value);
      functions[k].derivatives[i] = stretch.lazyProduct(derivative);
    }
  }
}

/// The stiffness points for given nodal positions and rotations.
template <int Nodes, typename S>
void element_points(const ConservingElement<Nodes, S>& element, const std::array<Vector3T<S>, Nodes>& position,
                    const std::array<QuaternionT<S>, Nodes>& orientation, PointKinematicsT<S>* points) {
  const auto rotations = point_rotations(element, LocalRotations<Nodes, S>(orientation));
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& constants = element.points[k];
    points[k] =
        point_kinematics(rotations[k], interpolate<Nodes>(constants.derivative, position), constants.reference_strain);
  }
}

namespace conserving {

/// The stiffness points of a step: `end` receives them at t_{n+1}. Their generalised shape functions are set
/// `with_variation`, or where the mid functions ask for them. `functions` must outlive `at`.
template <int Nodes, typename S>
void set_points(const ConservingElement<Nodes, S>& element, const BeamNodes<Nodes, S>& nodes, const TimeRule& rule,
                const ElementFunctions<Nodes, S>& functions, bool with_variation, PointKinematicsT<S>* end,
                StepPoints<Nodes, S>& at) {
  constexpr int kPoints = Nodes - 1;
  at.mid = &functions;
  const bool is_symmetric = rule.mid_functions == MidFunctions::Symmetric;
  const LocalRotations<Nodes, S> local(nodes.orientation);
  const std::array<InterpolatedRotation<S>, kPoints> rotation =
      with_variation || is_symmetric ? point_rotations(
                                           element, local, [&](int k) -> auto& { return at.points[k].generalised; })
                                     : point_rotations(element, local);
  if (is_symmetric) {
    for (int k = 0; k < kPoints; ++k)
      for (int i = 0; i < Nodes; ++i) {
        at.averages[k].values[i] = S(0.5) * (functions[k].values[i] + at.points[k].generalised.values[i]);
        at.averages[k].derivatives[i] =
            S(0.5) * (functions[k].derivatives[i] + at.points[k].generalised.derivatives[i]);
      }
    at.mid = &at.averages;
  }
  for (int k = 0; k < kPoints; ++k) {
    const auto& constants = element.points[k];
    end[k] =
        point_kinematics(rotation[k], interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
  }
}

}  // namespace conserving
}  // namespace flexarm
