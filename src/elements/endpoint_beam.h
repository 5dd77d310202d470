#pragma once
/// Residual and tangent of beams at one configuration, for statics, natural modes and the Newmark family (beam.md 2.2,
/// 2.5, 3.1).

#include "elements/beam_point.h"
#include "elements/newmark_rule.h"
#include "math/so3.h"

namespace flexarm {

namespace endpoint {

/// Derivatives of {n, m} (`resultants`) and of r' x n (`couple`) at a point; columns {dr', spin, spin'} (Muñoz 2004,
/// eq. F.9, F.27).
struct PointTangent {
  Eigen::Matrix<double, 6, 9> resultants;
  Eigen::Matrix<double, 3, 9> couple;
};

/// Computes these derivatives. `stress_slope`: d(stress)/d(strain) = stress_slope * stiffness (1; more with damping).
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
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// The weak form whose residual is the derivative of the strain energy with respect to displacements and spins of the
/// nodes. These are the moment rows of the EM family at rest. The tangent leaves out the variation of the generalised
/// shape functions.
struct VariationForm {
  static constexpr bool needs_variation(bool) { return true; }

  template <int Nodes>
  static void add_point(const typename BeamElement<Nodes>::StiffnessPoint& constants, const ElementNodes<Nodes>& nodes,
                        const GeneralisedShapeFunctions<Nodes>& generalised, const endpoint::PointForces& point,
                        bool with_tangent, ElementSystem<Nodes>& system);
};

/// Adds the internal forces of one element at the end configuration. `end`: output, its stiffness points. `rule`: null
/// in statics. With a rule, adds stiffness-proportional damping; for this `begin` and `strain_rates` are the points and
/// strain rates at the beginning, and the strain rates at the end are written to `new_strain_rates`. `Form`: SpinForm,
/// VariationForm or AdditiveForm. `carried`: strains for the geometric part of the tangent of the first two forms;
/// null: those of the configuration (docs/notes/newton.md).
template <int Nodes, class Form = SpinForm>
void endpoint_internal(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule* rule,
                       const PointKinematics* begin, const Vector6* strain_rates, bool with_tangent,
                       PointKinematics* end, Vector6* new_strain_rates, ElementSystem<Nodes>& system,
                       const Vector6* carried = nullptr);

/// Adds the translational inertia by Newmark's rule.
template <int Nodes>
void newmark_translation(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                         bool with_tangent, ElementSystem<Nodes>& system);

/// Adds mass-proportional damping by the velocity at t_{n+1+alpha}.
template <int Nodes>
void newmark_mass_damping(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const NewmarkRule& rule,
                          bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
