#pragma once
/// The nodes of an element over a step, and the interpolation of their rotations, for kernels that evaluate elements
/// one by one.

#include <optional>

#include "elements/beam_point.h"
#include "study_schemes/referenced_rotation.h"

namespace flexarm {

/// Nodal motion of an element over a step [t_n, t_{n+1}].
template <int Nodes>
struct ElementNodes : PlacedNodes<Nodes> {
  std::array<Vector3, Nodes> begin;      ///< positions [m]
  std::array<Vector3, Nodes> increment;  ///< tangent-scaled rotation increments, Lambda_{n+1} = cay(w) Lambda_n
  std::array<Matrix3, Nodes> increment_inverse_tangent;  ///< S(w)^{-1}: dw = S^{-1} spin
  std::array<Vector3, Nodes> velocity, acceleration;     ///< at the beginning [m/s, m/s^2]
  // For interpolations that measure rotations from a reference (all but the local one):
  std::array<Vector3, Nodes> rotation_vector;
  RotationParameters parameters = RotationParameters::Unscaled;
  const InterpolatedRotation<double>* stiffness_reference = nullptr;  ///< per stiffness point of the element
  const InterpolatedRotation<double>* mass_reference = nullptr;       ///< per mass point
};

/// Interpolates rotations of an element, and their variation on request. `Nodes`: 2 to 5.
template <int Nodes>
class ElementRotations {
 public:
  ElementRotations(const ElementNodes<Nodes>& nodes, bool with_variation);
  /// `reference`: only for interpolations that have one. `generalised`: output, set only with variation.
  InterpolatedRotation<double> evaluate(const NodalValues<Nodes>& shape, const NodalValues<Nodes>& derivative,
                                        const InterpolatedRotation<double>* reference,
                                        GeneralisedShapeFunctions<Nodes>& generalised) const;

 private:
  std::optional<LocalRotations<Nodes>> local_;
  std::optional<LocalRotationVariation<Nodes>> variation_;
  std::optional<ReferencedRotations<Nodes>> referenced_;
};

/// Returns the function rotation_at(k, generalised) of add_internal_forces().
template <int Nodes>
auto stiffness_rotations(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                         const ElementRotations<Nodes>& rotations) {
  return [&](int k, GeneralisedShapeFunctions<Nodes>& generalised) {
    const auto& point = element.stiffness_points[k];
    const auto* reference = nodes.stiffness_reference ? nodes.stiffness_reference + k : nullptr;
    return rotations.evaluate(point.shape, point.derivative, reference, generalised);
  };
}

/// Computes carried strains, see carried_strains(), with the nodes' interpolation.
template <int Nodes>
void carry_strains(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes,
                   const std::array<Vector6, Nodes>& update, Vector6* strains);

}  // namespace flexarm
