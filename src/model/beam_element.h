#pragma once
/// Constant data of geometrically exact beam elements, and loops over them.

#include <array>
#include <tuple>
#include <utility>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

/// A Maxwell element of the material, in parallel with the section's stiffness C: a spring g C in series with a
/// dashpot.
struct MaxwellBranch {
  double modulus_ratio;    ///< g [-]
  double relaxation_time;  ///< tau [s]
};

/// One Lagrange element with `Nodes` nodes (order Nodes - 1). Stiffness: Nodes - 1 Gauss points (reduced: no shear or
/// membrane locking), inertia: Nodes Gauss points. Derivatives and weights are with respect to the arc length of the
/// undeformed reference line. (Muñoz 2004, sec. 3 and 5; beam.md 2.3)
template <int Nodes>
struct BeamElement {
  static constexpr int kNodes = Nodes;
  static constexpr int kStiffnessPoints = Nodes - 1;
  static constexpr int kMassPoints = Nodes;
  using NodeWeights = Eigen::Matrix<double, Nodes, 1>;

  struct StiffnessPoint {
    NodeWeights shape, derivative;  ///< I^i, dI^i/ds [-, 1/m]
    double weight;                  ///< quadrature weight over s [m]
    Vector6 reference_strain;       ///< {Lambda_0^T r_0', Upsilon_0} of the undeformed line, which is free of stress
    Matrix6 stiffness;              ///< of the section, about the mass centroid
  };
  struct MassPoint {
    NodeWeights shape, derivative;
    double weight;
    Matrix3 inertia;  ///< rotary inertia per length [kg m]
  };

  std::array<int, Nodes> nodes;
  int first_stiffness_point = 0, first_mass_point = 0;  ///< indices of its first points in per-point arrays
  std::array<StiffnessPoint, kStiffnessPoints> stiffness_points;
  std::array<MassPoint, kMassPoints> mass_points;
  Eigen::Matrix<double, Nodes, Nodes> mass;  ///< int I^i I^j mass ds [kg]
  double stiffness_damping = 0;              ///< eta of F += eta D C D d(strain)/dt [s]
  Vector6 damping_scale = Vector6::Ones();   ///< diagonal of D, at most 1: strain i has eta D_ii^2
  double mass_damping = 0;                   ///< coefficient of mass-proportional damping [1/s]
  std::vector<MaxwellBranch> maxwell;        ///< at most Model::maxwell_branches
  int prestrain = -1;                        ///< index into Model::prestrains; -1: none
  int first_block = 0;                       ///< block of nodes i, j in TangentBackend: first_block + i * Nodes + j
};

/// Whether all strains have the same damping coefficient eta.
template <int Nodes>
bool is_damped_evenly(const BeamElement<Nodes>& element) {
  return element.damping_scale == Vector6::Ones();
}

/// Returns D C D of a stiffness point, with the section's stiffness C.
template <int Nodes>
Matrix6 damped_stiffness(const BeamElement<Nodes>& element, int point) {
  const auto scale = element.damping_scale.asDiagonal();
  return scale * element.stiffness_points[point].stiffness * scale;
}

/// Returns the element with D C D in place of the stiffness C.
template <int Nodes>
BeamElement<Nodes> with_damped_stiffness(BeamElement<Nodes> element) {
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k)
    element.stiffness_points[k].stiffness = damped_stiffness(element, k);
  return element;
}

/// Elements of equal order, contiguous in memory.
template <int Nodes>
struct BeamGroup {
  static constexpr int kNodes = Nodes;
  std::vector<BeamElement<Nodes>> elements;
};

/// A part of an element of the scene, see scene::HalvedPart.
struct ElementPart {
  int element = 0, part = 1;
};
/// A part of an element of a link's beam that is divided into two halves.
struct HalvedElement {
  int link = 0, element = 0, part = 1;
  bool operator==(const HalvedElement& other) const { return !(*this < other) && !(other < *this); }
  bool operator!=(const HalvedElement& other) const { return !(*this == other); }
  bool operator<(const HalvedElement& other) const {
    return std::tie(link, element, part) < std::tie(other.link, other.element, other.part);
  }
};

using BeamGroups = std::tuple<BeamGroup<2>, BeamGroup<3>, BeamGroup<4>, BeamGroup<5>>;

/// Calls visit(group) for each order. Code that depends on the number of nodes is dispatched only here.
template <class Groups, class Visitor>
void for_each_group(Groups& groups, Visitor&& visit) {
  std::apply([&](auto&... group) { (visit(group), ...); }, groups);
}

/// Calls visit(element) for all elements.
template <class Groups, class Visitor>
void for_each_element(Groups& groups, Visitor&& visit) {
  for_each_group(groups, [&](auto& group) {
    for (auto& element : group.elements) visit(element);
  });
}

}  // namespace flexarm
