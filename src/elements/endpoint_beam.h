#pragma once
/// Beam residual and tangent at one configuration: statics, natural modes and the Newmark family
/// (beam.md 2.2, 2.5, 3.1).

#include "elements/beam_point.h"
#include "elements/newmark_rule.h"
#include "math/so3.h"

namespace flexarm {

namespace endpoint {

/// Linearisation of {n, m} and of r' x n at a point; columns {dr', spin, spin'} (Muñoz 2004, eq. F.9, F.27).
struct PointTangent {
  Eigen::Matrix<double, 6, 9> resultants;
  Eigen::Matrix<double, 3, 9> couple;
};

/// `stress_slope`: d(stress)/d(strain) = stress_slope * stiffness (1, or more with damping).
PointTangent point_tangent(const PointKinematics& point, const Matrix6& stiffness, double stress_slope,
                           const Vector3& n, const Vector3& m);

/// What a stiffness point hands to the weak form, n and m in space.
struct PointForces {
  const PointKinematics& kinematics;
  const Matrix6& stiffness;
  double stress_slope;  ///< d(stress)/d(strain) = stress_slope * stiffness
  Vector3 n, m;
  Vector3 seen_n, seen_m;  ///< by the geometric part of the tangent
};

}  // namespace endpoint

/// Rows conjugate to the spins of the nodes (beam.md 2.2).
struct SpinForm {
  /// Columns need the generalised shape functions.
  static constexpr bool needs_variation(bool with_tangent) { return with_tangent; }

  /// Adds the virtual work of a stiffness point and its tangent.
  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// The derivative of the strain energy by displacements and spins of the nodes: the moment rows of the EM family at
/// rest. The tangent leaves out how the generalised shape functions vary.
struct VariationForm {
  static constexpr bool needs_variation(bool) { return true; }

  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// Internal forces of one element at the end configuration; its stiffness points go to `end`. With a rule (dynamics):
/// stiffness-proportional damping from `begin`, the points at the beginning, and their strain rates; those at the end
/// go to `new_strain_rates`. `Form`: SpinForm, VariationForm or AdditiveForm. With a tangent of the first two,
/// `carried` are the strains that its geometric part sees; null: those of the configuration (docs/notes/newton.md).
template <int Nodes, class Form = SpinForm>
void endpoint_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system,
                       const Vector6* carried = nullptr);

/// Newmark translational inertia.
template <int Nodes>
void newmark_translation(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                         bool with_tangent, ElementSystem<Nodes>& system);

/// Mass-proportional damping by the velocity at t_{n+1+alpha}.
template <int Nodes>
void newmark_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                          bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
