#pragma once
/// Translational inertia of an element over a step of the energy-momentum family, in space and in the plane.

#include <array>

#include <Eigen/Core>

namespace flexarm {

/// Per node the force [N]; its derivative by a node's own displacement over the element's mass [1/s^2], the same for
/// all directions; what damping takes over the step [J].
template <int Nodes, class Vector>
struct TranslationalForces {
  using S = typename Vector::Scalar;
  std::array<Vector, Nodes> forces;
  S slope, dissipated;
};

/// (1/h) int I^i I^j mass (v_{n+1} - v_n), v_{n+1} = factor Delta r / h - (factor - 1) v_n, and mass-proportional
/// damping by the mean velocity Delta r / h.
template <class Vector, int Nodes, class Element, class NodeMotion>
inline TranslationalForces<Nodes, Vector> translational_forces(const Element& element, const NodeMotion& nodes,
                                                               double factor, double step) {
  using S = typename Vector::Scalar;
  TranslationalForces<Nodes, Vector> out;
  std::array<Vector, Nodes> mean, force;
  // Without conjugation, as so3::dot(), of which this has the order of operations.
  const auto product = [](const Vector& a, const Vector& b) {
    S sum = a[0] * b[0];
    for (int k = 1; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  };
  out.slope = S(factor / (step * step));
  for (int i = 0; i < Nodes; ++i) {
    mean[i] = S(1 / step) * (nodes.end[i] - nodes.begin[i]);
    force[i] = S(factor / step) * (mean[i] - nodes.velocity[i]);
  }
  out.dissipated = S(0);
  if (element.has_mass_damping) {
    out.slope += element.mass_damping * S(1 / step);
    for (int i = 0; i < Nodes; ++i) {
      force[i] += element.mass_damping * mean[i];
      for (int j = 0; j < Nodes; ++j)
        out.dissipated += element.mass_damping * S(step) * element.mass(i, j) * product(mean[i], mean[j]);
    }
  }
  for (int i = 0; i < Nodes; ++i) {
    out.forces[i] = element.mass(i, 0) * force[0];
    for (int j = 1; j < Nodes; ++j) out.forces[i] += element.mass(i, j) * force[j];
  }
  return out;
}

}  // namespace flexarm
