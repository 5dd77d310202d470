#pragma once
/// What lets the beta schemes keep an element's energy: its change over a step, and a multiple of some forces that does
/// just that work (beam.md 3.3).

#include "elements/beam_point.h"

namespace flexarm {

/// An energy of an element and its derivative with respect to the nodal {dr, spin}.
template <int Nodes>
struct ElementEnergy {
  double change = 0;  ///< over the step [J]
  Eigen::Matrix<double, 6 * Nodes, 1> gradient = Eigen::Matrix<double, 6 * Nodes, 1>::Zero();
};

/// Adds the change of strain energy of a stiffness point and its gradient, the internal forces at the end.
template <int Nodes>
void add_strain_energy(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PointKinematics& begin,
                       const PointKinematics& end, const GeneralisedShapeFunctions<Nodes>& generalised,
                       ElementEnergy<Nodes>& energy);

/// Adds the change of translational kinetic energy and its gradient.
template <int Nodes>
void add_kinetic_energy(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double factor, double step,
                        ElementEnergy<Nodes>& energy);

/// Work of nodal forces {f_i, phi_i} along the increments {Delta r, w} of the nodes [J]; w is tangent-scaled.
template <int Nodes>
double work_of(const Eigen::Matrix<double, 6 * Nodes, 1>& forces, const ElementNodes<Nodes>& nodes);

/// system += beta correction with the beta for which the nodal increments do the work energy.change on the sum, and the
/// tangent of that (beam.md 3.3; eq. F.37-F.39 of Muñoz 2004 leave out G).
template <int Nodes>
void correct_energy(const ElementNodes<Nodes>& nodes, const ElementEnergy<Nodes>& energy,
                    const ElementSystem<Nodes>& correction, bool with_tangent, ElementSystem<Nodes>& system);

}  // namespace flexarm
