#pragma once
/// Residual and tangent of beams whose forces act at the end of a step: the Newmark family, and equilibria with its
/// interpolations and weak forms (beam.md 2.2, 2.5, 3.1).

#include "elements/static_beam.h"
#include "study_schemes/element_nodes.h"
#include "study_schemes/newmark_rule.h"

namespace flexarm {

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
