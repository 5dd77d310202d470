#pragma once
/// Internal forces of beams at one configuration and their tangent, for equilibria and natural modes
/// (beam.md 2.2, 3.1).

#include <optional>

#include "elements/beam_point.h"
#include "math/so3.h"

namespace flexarm {

namespace endpoint {

/// Derivatives of {n, m} (`resultants`) and of r' x n (`couple`) at a point; columns {dr', spin, spin'} (Muñoz 2004,
/// eq. F.9, F.27).
struct PointTangent {
  Eigen::Matrix<double, 6, 9> resultants;
  Eigen::Matrix<double, 3, 9> couple;
};

/// Computes these derivatives. `stress_slope`: d(stress)/d(strain) = stress_slope * stiffness (1; more with a damper).
PointTangent point_tangent(const PointKinematics& point, const Matrix6& stiffness, double stress_slope,
                           const Vector3& n, const Vector3& m);

/// What the weak form needs from a stiffness point. Forces n and moments m are in world axes.
struct PointForces {
  const PointKinematics& kinematics;
  const Matrix6& stiffness;
  double stress_slope;  ///< d(stress)/d(strain) = stress_slope * stiffness
  Vector3 n, m;
  Vector3 seen_n, seen_m;  ///< n and m for the geometric part of the tangent
};

}  // namespace endpoint

/// The spin weak form: rows are conjugate to the spins of the nodes, tested with Lagrange functions (beam.md 2.2).
struct SpinForm {
  /// The tangent's columns need the generalised shape functions.
  static constexpr bool needs_variation(bool with_tangent) { return with_tangent; }

  /// Adds the virtual work of a stiffness point and its tangent.
  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PlacedNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// The weak form whose residual is the derivative of the strain energy with respect to displacements and spins of the
/// nodes. These are the moment rows of the EM family at rest. The tangent leaves out the variation of the generalised
/// shape functions.
struct VariationForm {
  static constexpr bool needs_variation(bool) { return true; }

  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PlacedNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// Stress that follows from the strain alone: C strain.
template <int Nodes>
struct ElasticLaw {
  const BeamElement<Nodes>& element;

  /// The stress of point k at its strain.
  Vector6 stress(int k, const Vector6& strain) const { return stiffness(k) * strain; }
  /// The stress of point k if it had another strain, for the geometric part of the tangent.
  Vector6 seen_stress(int k, const Vector6& strain) const { return stiffness(k) * strain; }
  /// d(stress)/d(strain) = slope() * stiffness(k), at the strain of the last stress().
  const Matrix6& stiffness(int k) const { return element.stiffness_points[k].stiffness; }
  double slope() const { return 1; }
};

/// Adds the internal forces of one element. `Form`: the weak form, SpinForm or VariationForm. `law`: see ElasticLaw.
/// `rotation_at(k, generalised)` returns the interpolated rotation at stiffness point k, and sets the generalised shape
/// functions if the form needs them. `end`: output, the stiffness points. `carried`: strains for the geometric part of
/// the tangent; null: those of the configuration (docs/notes/newton.md).
template <int Nodes, class Form, class AnyNodes, class RotationAt, class Law>
void add_internal_forces(const BeamElement<Nodes>& element, const AnyNodes& nodes, const RotationAt& rotation_at,
                         Law& law, bool with_tangent, PointKinematics* end, ElementSystem<Nodes>& system,
                         const Vector6* carried) {
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    const InterpolatedRotation<double> rotation = rotation_at(k, generalised);
    end[k] = end_kinematics<Nodes>(constants, nodes, rotation);
    const auto in_space = [&](const Vector3& material) -> Vector3 { return end[k].rotation * material; };
    const Vector6 stress = law.stress(k, end[k].strain);
    const Vector3 n = in_space(stress.template head<3>()), m = in_space(stress.template tail<3>());
    endpoint::PointForces forces{end[k], law.stiffness(k), law.slope(), n, m, n, m};
    if (carried) {
      const Vector6 seen = law.seen_stress(k, carried[k]);
      forces.seen_n = in_space(seen.template head<3>());
      forces.seen_m = in_space(seen.template tail<3>());
    }
    Form::template add_point<Nodes>(constants, nodes, generalised, forces, with_tangent, system);
  }
}

/// The local interpolation of an element's rotations.
template <int Nodes>
class LocalRotationAt {
 public:
  LocalRotationAt(const BeamElement<Nodes>& element, const PlacedNodes<Nodes>& nodes, bool with_variation)
      : element_(element), local_(nodes.orientation) {
    if (with_variation) variation_.emplace(local_);
  }
  /// At stiffness point k; sets the generalised shape functions only with variation.
  InterpolatedRotation<double> operator()(int k, GeneralisedShapeFunctions<Nodes>& generalised) const {
    const auto& point = element_.stiffness_points[k];
    return variation_ ? variation_->evaluate(point.shape, point.derivative, generalised)
                      : local_.evaluate(point.shape, point.derivative);
  }

 private:
  const BeamElement<Nodes>& element_;
  LocalRotations<Nodes> local_;
  std::optional<LocalRotationVariation<Nodes>> variation_;
};

/// Adds the elastic forces of one element with the local interpolation, see add_internal_forces().
template <int Nodes, class Form>
void static_beam(const BeamElement<Nodes>& element, const PlacedNodes<Nodes>& nodes, bool with_tangent,
                 PointKinematics* end, ElementSystem<Nodes>& system, const Vector6* carried = nullptr);

}  // namespace flexarm
