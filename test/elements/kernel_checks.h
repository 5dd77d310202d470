#pragma once
/// Checks of tangents, momenta and energies that are common to tests of all beam kernels.

#include <gtest/gtest.h>

#include <functional>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "support/node_counts.h"

namespace flexarm::test {

struct InterpolationChoice {
  Interpolation interpolation;
  RotationParameters parameters = RotationParameters::Unscaled;
};

/// Calls visit(step) for one random step with each of these interpolations.
template <int Nodes, int Count, class Visit>
void for_each_interpolation(unsigned seed, const InterpolationChoice (&choices)[Count], const Visit& visit) {
  RandomSource random(seed);
  for (const InterpolationChoice& choice : choices) {
    SCOPED_TRACE(static_cast<int>(choice.interpolation) + 10 * static_cast<int>(choice.parameters));
    RandomStep<Nodes> step(random, 0.5);
    step.set_interpolation(random, choice.interpolation, choice.parameters);
    visit(step);
  }
}

/// Compares a tangent with differences of its residual, where residual_at(column, h) has coordinate `column` displaced
/// by h. `size`: increment over which the residual is smooth. The step of the differences is proportional to it, their
/// round-off inversely proportional. Takes matrices of dynamic size, so that it is compiled only once.
void expect_consistent_tangent(const Eigen::MatrixXd& tangent, const Eigen::VectorXd& residual,
                               const std::function<Eigen::VectorXd(int column, double h)>& residual_at, double size);

/// The same for kernel(nodes, with_tangent) -> ElementSystem.
template <int Nodes, class Kernel>
void expect_consistent_tangent(const RandomStep<Nodes>& step, const Kernel& kernel, double size = 1) {
  const ElementSystem<Nodes> system = kernel(step.nodes, true);
  EXPECT_LE(largest(kernel(step.nodes, false).residual - system.residual),
            1e-13 * largest(system.residual));  // the residual is the same without a tangent
  expect_consistent_tangent(
      system.tangent, system.residual,
      [&](int column, double h) { return kernel(step.perturbed(column, h), false).residual; }, size);
}

/// Translational velocities at the end by v_1 = factor Delta r / h - (factor - 1) v_0.
template <int Nodes>
std::array<Vector3, Nodes> end_velocities(const ElementNodes<Nodes>& nodes, double h, double factor = 2) {
  std::array<Vector3, Nodes> out;
  for (int i = 0; i < Nodes; ++i)
    out[i] = factor / h * (nodes.end[i] - nodes.begin[i]) - (factor - 1) * nodes.velocity[i];
  return out;
}

/// Translational kinetic energy.
template <int Nodes>
double kinetic_energy(const BeamElement<Nodes>& element, const std::array<Vector3, Nodes>& velocity) {
  double sum = 0;
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) sum += 0.5 * element.mass(i, j) * velocity[i].dot(velocity[j]);
  return sum;
}

/// {linear, angular momentum about the origin} of the translation.
template <int Nodes>
Vector6 momenta(const BeamElement<Nodes>& element, const std::array<Vector3, Nodes>& position,
                const std::array<Vector3, Nodes>& velocity) {
  Vector6 sum = Vector6::Zero();
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) {
      sum.head<3>() += element.mass(i, j) * velocity[j];
      sum.tail<3>() += element.mass(i, j) * position[i].cross(velocity[j]);
    }
  return sum;
}

/// Resultant {force, moment about the origin} of nodal forces and moments. `end_weight`: weight of the end of the step
/// in the arms.
template <int Nodes>
Vector6 resultant(const ElementNodes<Nodes>& nodes, const Eigen::Matrix<double, 6 * Nodes, 1>& forces,
                  double end_weight) {
  Vector6 sum = Vector6::Zero();
  for (int i = 0; i < Nodes; ++i) {
    const Vector3 f = forces.template segment<3>(6 * i);
    const Vector3 arm = (1 - end_weight) * nodes.begin[i] + end_weight * nodes.end[i];
    sum.head<3>() += f;
    sum.tail<3>() += arm.cross(f) + forces.template segment<3>(6 * i + 3);
  }
  return sum;
}

}  // namespace flexarm::test
