#pragma once
/// Input and output of the planar beam kernel of the energy-momentum family, for one element (S = double) or a pack of
/// elements. Like conserving_element.h, with two translations and one rotation for each node. (docs/notes/planar.md)

#include <array>

#include "elements/element_lanes.h"
#include "math/lanes.h"
#include "math/shape_functions.h"
#include "model/beam_element.h"
#include "model/state.h"

namespace flexarm::planar {

template <typename S>
using Vector2T = Eigen::Matrix<S, 2, 1>;

/// Symmetric stiffness of a section: {N_1, N_2, M} = C {Gamma_1, Gamma_2, K}. The axes 1 and 2 are those of the plane
/// at the reference orientation of the section (PlaneOfMotion::strain_basis).
template <typename S>
struct SectionStiffness {
  Matrix3T<S> matrix;

  Vector3T<S> stress(const Vector3T<S>& strain) const { return matrix * strain; }
};

/// Constant data of an element; units as in BeamElement.
template <int Nodes, typename S = double>
struct Element {
  struct Point {
    NodalValues<Nodes, S> shape, derivative;
    S weight;
    Vector3T<S> reference_strain;
    SectionStiffness<S> section, damped;  ///< C, and D C D
  };
  std::array<Point, Nodes - 1> points;
  Eigen::Matrix<S, Nodes, Nodes> mass;
  S stiffness_damping, mass_damping;
  bool has_stiffness_damping = false, has_mass_damping = false, is_damped_evenly = true;

  const SectionStiffness<S>& section(int point) const { return points[point].section; }
  const SectionStiffness<S>& damped_section(int point) const { return points[point].damped; }
};

/// Writes an element into a lane of a pack. `basis`: PlaneOfMotion::strain_basis of its nodes.
template <int Nodes, typename S>
void set_lane(Element<Nodes, S>& pack, int lane, const BeamElement<Nodes>& element,
              const Eigen::Matrix<double, 6, 3>& basis) {
  using flexarm::set_lane;
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& point = element.stiffness_points[k];
    auto& to = pack.points[k];
    set_interpolation_lane(to, lane, point);
    set_lane(to.reference_strain, lane, Vector3(basis.transpose() * point.reference_strain));
    set_lane(to.section.matrix, lane, Matrix3(basis.transpose() * point.stiffness * basis));
    set_lane(to.damped.matrix, lane, Matrix3(basis.transpose() * damped_stiffness(element, k) * basis));
  }
  set_mass_and_damping_lane(pack, lane, element);
}

/// The motion of an element's nodes over a step.
template <int Nodes, typename S = double>
struct Nodal {
  std::array<Vector2T<S>, Nodes> begin, end;  ///< positions [m]
  std::array<S, Nodes> cosine, sine;          ///< of half the angle at the end, see PlanarPose
  std::array<S, Nodes> increment;             ///< tangent-scaled, 2 tan(angle / 2)
  std::array<Vector2T<S>, Nodes> velocity;    ///< at the beginning [m/s]
};

/// Kinematics of a stiffness point at one instant.
template <typename S>
struct PointKinematics {
  S cosine, sine;       ///< of the whole angle
  Vector2T<S> tangent;  ///< r'
  Vector3T<S> strain;   ///< {Gamma_1, Gamma_2, K}
};

/// See flexarm::CarriedStrains.
template <int Nodes, typename S = double>
struct CarriedStrains {
  std::array<Vector3T<S>, Nodes - 1> end, conjugate;
  bool has_conjugate = false;
};

/// Residual {f_1, f_2, phi} of each node, and its tangent: block (i, j) is the derivative of node i's residual with
/// respect to node j's {dx, dy, spin}. A fourth row of zeros fills the register. `carried`: see flexarm::BlockSystem.
template <int Nodes, typename S = double>
struct BlockSystem {
  std::array<Eigen::Matrix<S, 4, 1>, Nodes> residual, carried;
  std::array<std::array<Eigen::Matrix<S, 4, 3>, Nodes>, Nodes> tangent;
  S dissipated;  ///< over the step [J]
};

/// See StrainMemoryT.
template <typename S>
struct StrainMemory {
  Vector3T<S> average = Vector3T<S>::Zero(), rate = Vector3T<S>::Zero(), delayed_rate = Vector3T<S>::Zero();
};

}  // namespace flexarm::planar
