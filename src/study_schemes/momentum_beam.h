#pragma once
/// Residual and tangent of beams over a step for the schemes M1, M2, STD and the beta schemes (Muñoz 2004, ch. 6;
/// beam.md 3.2, 3.3). They have Lagrange test functions and rotary inertia at the mass points. Moments are mapped to
/// world axes by A = T(omega) Lambda_n or S(w) Lambda_n.

#include <functional>

#include "schemes/time_rule.h"
#include "study_schemes/element_nodes.h"

namespace flexarm {

/// The change of an element's energy over a step, which the beta schemes make exact, and its derivative with respect to
/// the nodal {dr, spin} at the end.
template <int Nodes>
struct ElementEnergy {
  double change = 0;  ///< over the step [J]
  Eigen::Matrix<double, 6 * Nodes, 1> gradient = Eigen::Matrix<double, 6 * Nodes, 1>::Zero();
};

/// A function rotary(with_tangent, energy, system) that adds the rotary inertia at the mass points to the system, and
/// its energy to `energy` if that is not null.
template <int Nodes>
using RotaryTerm = std::function<void(bool, ElementEnergy<Nodes>*, ElementSystem<Nodes>&)>;

/// Computes internal forces, damping and inertia of one element over a step. `carried`: strains at the end for the
/// geometric part of the tangent; null: those of the trial configuration. (docs/notes/newton.md)
template <int Nodes>
void momentum_beam(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const TimeRule& rule,
                   const PointKinematics* begin, double step, const RotaryTerm<Nodes>& rotary, bool with_tangent,
                   PointKinematics* end, ElementSystem<Nodes>& system, const Vector6* carried = nullptr);

}  // namespace flexarm
