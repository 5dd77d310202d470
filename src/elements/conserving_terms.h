#pragma once
/// What beams of the energy-momentum family have in common in space and in the plane: translational inertia,
/// strains and stresses of a stiffness point, and dampers with a memory there. Over a step in which the strain grows by
/// s, each damper adds factor C s - remembered to the stress. (docs/schemes.md, "Numerical dissipation", "Structural
/// damping")

#include <array>

#include <Eigen/Core>

#include "elements/conserving_element.h"
#include "schemes/time_rule.h"

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

namespace flexarm::conserving {

/// Of strains of any number; dot6() is the product of all six.
template <typename S, int Size>
S strain_product(const Eigen::Matrix<S, Size, 1>& a, const Eigen::Matrix<S, Size, 1>& b) {
  if constexpr (Size == 6)
    return dot6(a, b);
  else
    return so3::dot(a, b);
}

/// Strains and elastic stresses of a stiffness point over a step.
template <typename S, int Size = 6>
struct PointStress {
  using Strain = Eigen::Matrix<S, Size, 1>;
  Strain strain, stress;                      // means of both ends
  Strain conjugate_strain, conjugate_stress;  // s and C s

  PointStress() = default;
  template <class Stiffness>
  PointStress(const Stiffness& stiffness, const Strain& begin, const Strain& end, const Strain& conjugate)
      : strain(S(0.5) * (begin + end)),
        stress(stiffness.stress(strain)),
        conjugate_strain(conjugate),
        conjugate_stress(stiffness.stress(conjugate)) {}
};

/// The strain rate at the end: (w_0 + w_1)/2 = s/h.
template <class Memory, typename S, int Size>
Eigen::Matrix<S, Size, 1> end_rate(const Memory& begin, const Eigen::Matrix<S, Size, 1>& s, double step) {
  return S(2 / step) * s - begin.rate;
}

/// See NumericalDissipation.
template <typename S, int Size = 6>
struct NumericalDamper {
  using Strain = Eigen::Matrix<S, Size, 1>;
  S factor, dissipated;  // [-], [J/m]
  Strain remembered, average;

  template <class Memory, class Stiffness>
  NumericalDamper(const NumericalDissipation& d, const Memory& begin, const Strain& s, const Stiffness& stiffness,
                  double step)
      : factor(d.stiffness + 2 * d.inertance / (step * step)) {
    const Strain deviation = s - begin.average;
    remembered = stiffness.stress(S(d.stiffness) * begin.average + S(2 * d.inertance / step) * begin.rate);
    dissipated =
        S(d.stiffness * (1 - 0.5 * d.forgetting)) * strain_product<S, Size>(deviation, stiffness.stress(deviation));
    average = begin.average + S(d.forgetting) * deviation;
  }
};

/// What takes the place of the viscosity eta, three passive parts side by side: a dashpot, a dashpot behind a spring
/// that relaxes with the time h_0, and an inertance. The last two grow with eta until it is h_0.
template <typename S>
struct DamperParts {
  S dashpot, delayed, inertance;  // [s], [s], [s^2]

  DamperParts(const S& viscosity, double relaxation) {
    using std::abs;
    const S least = S(0.5) * (viscosity + S(relaxation) - abs(viscosity - S(relaxation)));  // of eta and h_0
    delayed = relaxation > 0 ? S(0.25 / relaxation) * viscosity * least : S(0);
    inertance = S(relaxation) * delayed;
    dashpot = viscosity - delayed;
  }
};

/// The stress eta C (strain rate) by these parts: with the delayed rate q,
///   C [dashpot s/h + inertance (w_1 - w_0)/h + delayed q_mean],   q_mean + (h_0/h) (q_1 - q_0) = s/h.
/// A dashpot alone would leave the strain of a mode that it damps strongly nearly as it is and make its velocity change
/// the sign in every step. These bring both to rest. inertance (w.Cw + q.Cq)/2 is stored.
template <typename S, int Size = 6>
struct StructuralDamper {
  using Strain = Eigen::Matrix<S, Size, 1>;
  S factor, dissipated;  // [-], [J/m]
  Strain remembered, delayed_rate;

  /// `stress` C s; `relaxation` h_0 [s].
  template <class Memory, class Stiffness>
  StructuralDamper(const DamperParts<S>& parts, double relaxation, const Memory& begin, const Strain& s,
                   const Strain& stress, const Stiffness& stiffness, double step) {
    const double follows = 1 / (step + 2 * relaxation);
    const Strain delayed = S(follows) * (s + S(2 * relaxation) * begin.delayed_rate);
    factor = parts.dashpot * S(1 / step) + parts.inertance * S(2 / (step * step)) + parts.delayed * S(follows);
    remembered = stiffness.stress((parts.inertance * S(2 / step)) * begin.rate -
                                  (parts.delayed * S(2 * relaxation * follows)) * begin.delayed_rate);
    dissipated = parts.dashpot * S(1 / step) * strain_product<S, Size>(s, stress) +
                 parts.delayed * S(step) * strain_product<S, Size>(delayed, stiffness.stress(delayed));
    delayed_rate = S(2) * delayed - begin.delayed_rate;
  }
};

}  // namespace flexarm::conserving
