#include "elements/energy_correction.h"

#include <cassert>
#include <cmath>

#include "elements/orders.h"

namespace flexarm {

namespace {

/// {Delta r, w} of the nodes, tangent-scaled: the increments that joints map exactly.
template <int Nodes>
Eigen::Matrix<double, 6 * Nodes, 1> nodal_increments(const ElementNodes<Nodes>& nodes) {
  Eigen::Matrix<double, 6 * Nodes, 1> increment;
  for (int i = 0; i < Nodes; ++i) {
    increment.template segment<3>(6 * i) = nodes.end[i] - nodes.begin[i];
    increment.template segment<3>(6 * i + 3) = nodes.increment[i];
  }
  return increment;
}

}  // namespace

template <int Nodes>
void add_strain_energy(const typename BeamElement<Nodes>::StiffnessPoint& constants, const PointKinematics& begin,
                       const PointKinematics& end, const GeneralisedShapeFunctions<Nodes>& generalised,
                       ElementEnergy<Nodes>& energy) {
  const Vector6 average = constants.stiffness * (0.5 * (begin.strain + end.strain));
  energy.change += constants.weight * average.dot(end.strain - begin.strain);
  const Vector6 stress = constants.stiffness * end.strain;
  add_point_residual<Nodes>(constants.weight, constants.derivative, GeneralisedTests<Nodes>{generalised},
                            end.rotation * stress.template head<3>(), end.rotation * stress.template tail<3>(),
                            end.tangent, energy.gradient);
}

template <int Nodes>
void add_kinetic_energy(const BeamElement<Nodes>& element, const ElementNodes<Nodes>& nodes, double factor, double step,
                        ElementEnergy<Nodes>& energy) {
  assert(step != 0 && factor != 0);
  std::array<Vector3, Nodes> velocity;
  for (int i = 0; i < Nodes; ++i)
    velocity[i] = (factor / step) * (nodes.end[i] - nodes.begin[i]) - (factor - 1) * nodes.velocity[i];
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      energy.change +=
          0.5 * element.mass(i, j) * (velocity[i] - nodes.velocity[i]).dot(velocity[j] + nodes.velocity[j]);
      energy.gradient.template segment<3>(6 * i) += (factor / step) * element.mass(i, j) * velocity[j];
    }
}

template <int Nodes>
double work_of(const Eigen::Matrix<double, 6 * Nodes, 1>& forces, const ElementNodes<Nodes>& nodes) {
  return nodal_increments(nodes).dot(forces);
}

template <int Nodes>
void correct_energy(const ElementNodes<Nodes>& nodes, const ElementEnergy<Nodes>& energy,
                    const ElementSystem<Nodes>& correction, bool with_tangent, ElementSystem<Nodes>& system) {
  const Eigen::Matrix<double, 6 * Nodes, 1> increment = nodal_increments(nodes);
  const double work = increment.dot(system.residual), denominator = increment.dot(correction.residual);
  // The correction has no direction where the strain rests.
  if (std::abs(denominator) <= 1e-14 * (std::abs(energy.change) + std::abs(work)) || denominator == 0) return;
  const double beta = (energy.change - work) / denominator;
  system.residual += beta * correction.residual;
  if (!with_tangent) return;
  system.tangent += beta * correction.tangent;
  Eigen::Matrix<double, 6 * Nodes, 1> row = energy.gradient;  // g_E - G^T g_beta - K^T increment
  row.noalias() -= system.tangent.transpose().lazyProduct(increment);
  for (int i = 0; i < Nodes; ++i) {
    row.template segment<3>(6 * i) -= system.residual.template segment<3>(6 * i);
    row.template segment<3>(6 * i + 3) -=
        nodes.increment_inverse_tangent[i].transpose() * system.residual.template segment<3>(6 * i + 3);
  }
  system.tangent.noalias() += (correction.residual / denominator) * row.transpose();
}

// Compiled here once for each order of elements.
#define COMPILE_FOR(Nodes)                                                \
  template decltype(add_strain_energy<Nodes>) add_strain_energy<Nodes>;   \
  template decltype(add_kinetic_energy<Nodes>) add_kinetic_energy<Nodes>; \
  template decltype(work_of<Nodes>) work_of<Nodes>;                       \
  template decltype(correct_energy<Nodes>) correct_energy<Nodes>;
FLEXARM_FOR_EACH_ORDER(COMPILE_FOR)
#undef COMPILE_FOR

}  // namespace flexarm
