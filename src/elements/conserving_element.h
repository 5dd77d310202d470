#pragma once
/// Input and output of the beam kernel of the energy-momentum family, for one element (S = double) or a pack of
/// elements.

#include <array>

#include "elements/element_lanes.h"
#include "math/lanes.h"
#include "math/local_rotation.h"
#include "model/beam_element.h"
#include "model/state.h"

namespace flexarm {

template <typename S>
inline S dot6(const Vector6T<S>& a, const Vector6T<S>& b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

template <int Nodes, typename S>
Vector3T<S> mean_of(const std::array<Vector3T<S>, Nodes>& vectors) {
  Vector3T<S> sum = vectors[0];
  for (int i = 1; i < Nodes; ++i) sum += vectors[i];
  return S(1.0 / Nodes) * sum;
}

/// Stiffness of a section by blocks: the symmetric C of {N, M} = C {Gamma, K}.
template <typename S>
struct SectionStiffness {
  Matrix3T<S> forces, coupling, moments;  ///< dN/dGamma, dN/dK, dM/dK
  bool is_coupled = false;                ///< false: `coupling` is zero

  Vector6T<S> stress(const Vector6T<S>& strain) const {
    Vector6T<S> out;
    out.template head<3>() = forces * strain.template head<3>();
    out.template tail<3>() = moments * strain.template tail<3>();
    if (is_coupled) {
      out.template head<3>() += coupling * strain.template tail<3>();
      out.template tail<3>() += coupling.transpose() * strain.template head<3>();
    }
    return out;
  }
  /// Returns D C D for a diagonal D.
  SectionStiffness scaled(const Vector6T<S>& diagonal) const {
    SectionStiffness out = *this;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        out.forces(i, j) *= diagonal[i] * diagonal[j];
        out.coupling(i, j) *= diagonal[i] * diagonal[j + 3];
        out.moments(i, j) *= diagonal[i + 3] * diagonal[j + 3];
      }
    return out;
  }
};

/// Constant data of an element; units as in BeamElement.
template <int Nodes, typename S = double>
struct ConservingElement {
  struct Point {
    NodalValues<Nodes, S> shape, derivative;
    S weight;
    Vector6T<S> reference_strain;
  };
  std::array<Point, Nodes - 1> points;
  /// By points. For a uniform element only the first one is used, to read less memory.
  std::array<SectionStiffness<S>, Nodes - 1> sections;
  bool is_uniform = true;
  Eigen::Matrix<S, Nodes, Nodes> mass;
  S stiffness_damping, mass_damping;
  Vector6T<S> damping_scale;
  bool has_stiffness_damping = false, has_mass_damping = false, is_damped_evenly = true;

  const SectionStiffness<S>& section(int point) const { return sections[is_uniform ? 0 : point]; }
  SectionStiffness<S> damped_section(int point) const { return section(point).scaled(damping_scale); }  ///< D C D
};

/// Writes an element into a lane of a pack.
template <int Nodes, typename S>
void set_lane(ConservingElement<Nodes, S>& pack, int lane, const BeamElement<Nodes>& element) {
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& point = element.stiffness_points[k];
    auto& to = pack.points[k];
    set_interpolation_lane(to, lane, point);
    set_lane(to.reference_strain, lane, point.reference_strain);
    SectionStiffness<S>& section = pack.sections[k];
    const auto coupling = point.stiffness.template topRightCorner<3, 3>();
    set_lane(section.forces, lane, point.stiffness.template topLeftCorner<3, 3>());
    set_lane(section.coupling, lane, coupling);
    set_lane(section.moments, lane, point.stiffness.template bottomRightCorner<3, 3>());
    section.is_coupled = section.is_coupled || !coupling.isZero(0);
    pack.is_uniform = pack.is_uniform && point.stiffness == element.stiffness_points[0].stiffness;
  }
  set_lane(pack.damping_scale, lane, element.damping_scale);
  set_mass_and_damping_lane(pack, lane, element);
}

/// The motion of an element's nodes over a step.
template <int Nodes, typename S = double>
struct BeamNodes {
  std::array<Vector3T<S>, Nodes> begin, end;      ///< positions [m]
  std::array<QuaternionT<S>, Nodes> orientation;  ///< at the end
  std::array<Vector3T<S>, Nodes> increment;       ///< tangent-scaled, Lambda_{n+1} = cay(w) Lambda_n
  std::array<Vector3T<S>, Nodes> velocity;        ///< at the beginning [m/s]
};

/// Generalised shape functions at the stiffness points of an element.
template <int Nodes, typename S = double>
using ElementFunctions = std::array<GeneralisedShapeFunctions<Nodes, S>, Nodes - 1>;

/// Carried strains at the stiffness points of an element, see carry_strains() (docs/notes/newton.md).
template <int Nodes, typename S = double>
struct CarriedStrains {
  std::array<Vector6T<S>, Nodes - 1> end;        ///< at the end of the step
  std::array<Vector6T<S>, Nodes - 1> conjugate;  ///< s
  bool has_conjugate = false;                    ///< if false, s of the trial configuration is used
};

/// Block (i, j): derivative of node i's {f, phi} with respect to node j's {dr, spin}.
template <int Nodes, typename S>
using BlockTangent = std::array<std::array<Matrix6T<S>, Nodes>, Nodes>;

/// Residual {f_i, phi_i} per node and its tangent.
template <int Nodes, typename S = double>
struct BlockSystem {
  std::array<Vector6T<S>, Nodes> residual;
  std::array<Vector6T<S>, Nodes> carried;  ///< residual with carried strains minus `residual`; set only with these
  BlockTangent<Nodes, S> tangent;
  S dissipated;  ///< over the step [J]
};

}  // namespace flexarm
