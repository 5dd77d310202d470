#pragma once
/// Beam residual and tangent over a step for M1, M2, STD and the beta schemes (Muñoz 2004, ch. 6; beam.md 3.2, 3.3):
/// Lagrange test functions, moments turned into space by A = T(omega) Lambda_n or S(w) Lambda_n, rotary inertia at the
/// mass points.

#include <functional>

#include "elements/beam_point.h"
#include "model/state.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// What the beta schemes keep: an energy of an element and its derivative with respect to the nodal {dr, spin}.
template <int Nodes>
struct ElementEnergy {
  double change = 0;  ///< over the step [J]
  Eigen::Matrix<double, 6 * Nodes, 1> gradient = Eigen::Matrix<double, 6 * Nodes, 1>::Zero();
};

/// rotary(with_tangent, energy, system) adds the rotary inertia at the mass points and, if `energy` is not null, its
/// energy.
template <int Nodes>
using RotaryTerm = std::function<void(bool, ElementEnergy<Nodes>*, ElementSystem<Nodes>&)>;

/// Internal forces, damping and inertia of one element over a step. `carried`: strains at the end that the geometric
/// part of the tangent sees; null: those of the trial configuration. (docs/notes/newton.md)
template <int Nodes>
void momentum_beam(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, const TimeRule& rule,
                   const PointKinematics* begin, double step, const RotaryTerm<Nodes>& rotary, bool with_tangent,
                   PointKinematics* end, ElementSystem<Nodes>& system, const Vector6* carried = nullptr);

}  // namespace flexarm
