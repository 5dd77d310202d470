#pragma once
/// What all beam kernels share: the nodes of an element, strains at an integration point, and functions
/// that add the internal forces of a point and their linearisation to the element's residual and tangent.
///
/// Notation of the beam kernels (docs/notes/beam.md): s arc length of the undeformed line, ' derivative with respect to
/// s; r position, Lambda rotation matrix from section to world axes; {Gamma, K} strains (axial and shear; torsion and
/// bending) and {N, M} their stress resultants in section axes; n, m the same in world axes; I^i shape function of node
/// i; spin: infinitesimal rotation vector in world axes, d(Lambda) = hat(spin) Lambda.

#include <array>
#include <type_traits>

#include "math/local_rotation.h"
#include "model/beam_element.h"

namespace flexarm {

/// Kinematics of a stiffness point at one instant.
template <typename S>
struct PointKinematicsT {
  Matrix3T<S> rotation;  ///< Lambda, from section to world axes
  Vector3T<S> tangent;   ///< r' = dr/ds
  Vector6T<S> strain;    ///< {Gamma, K}
};
using PointKinematics = PointKinematicsT<double>;

/// Poses of an element's nodes in one configuration: in a step, the one at its end.
template <int Nodes>
struct PlacedNodes {
  std::array<Vector3, Nodes> end;  ///< positions [m]
  std::array<Quaternion, Nodes> orientation;
  Vector6 prestrain = Vector6::Zero();  ///< subtracted from the strains
};

/// Residual {f_i, phi_i} and its derivative with respect to {dr_j, spin_j}, node by node.
template <int Nodes>
struct ElementSystem {
  Eigen::Matrix<double, 6 * Nodes, 1> residual;
  Eigen::Matrix<double, 6 * Nodes, 1>
      carried;  ///< residual with carried strains minus `residual`; see carried_strains()
  Eigen::Matrix<double, 6 * Nodes, 6 * Nodes> tangent;
  double dissipated = 0;  ///< over the step [J]

  void set_zero() {
    residual.setZero();
    carried.setZero();
    tangent.setZero();
    dissipated = 0;
  }
};

template <int Nodes, typename S = double>
Vector3T<S> interpolate(const NodalValues<Nodes, S>& weights, const std::array<Vector3T<S>, Nodes>& values) {
  Vector3T<S> sum = weights[0] * values[0];
  for (int i = 1; i < Nodes; ++i) sum += weights[i] * values[i];
  return sum;
}

/// Strains of a configuration (Muñoz 2004, eq. 2.1): Gamma = Lambda^T r' - reference, K = Upsilon - reference.
template <typename S>
PointKinematicsT<S> point_kinematics(const InterpolatedRotation<S>& interpolated,
                                     const Vector3T<std::decay_t<S>>& tangent,
                                     const Vector6T<std::decay_t<S>>& reference_strain) {
  PointKinematicsT<S> point;
  point.rotation = interpolated.rotation;
  point.tangent = tangent;
  point.strain.template head<3>() = interpolated.rotation.transpose() * tangent;
  point.strain.template tail<3>() = interpolated.curvature;
  point.strain -= reference_strain;
  return point;
}

/// Returns a stiffness point at the end of a step. `rotation`: the interpolated one.
template <int Nodes>
PointKinematics end_kinematics(const typename BeamElement<Nodes>::StiffnessPoint& constants,
                               const PlacedNodes<Nodes>& nodes, const InterpolatedRotation<double>& rotation) {
  PointKinematics point =
      point_kinematics(rotation, interpolate<Nodes>(constants.derivative, nodes.end), constants.reference_strain);
  point.strain -= nodes.prestrain;
  return point;
}

/// Returns the derivative of {Gamma, K} at an instant; columns {dr', spin, spin'} (beam.md 3.2).
inline Eigen::Matrix<double, 6, 9> strain_derivative(const PointKinematics& point) {
  const Matrix3 transposed = point.rotation.transpose();
  Eigen::Matrix<double, 6, 9> d = Eigen::Matrix<double, 6, 9>::Zero();
  d.topLeftCorner<3, 3>() = transposed;
  d.block<3, 3>(0, 3) = transposed * so3::hat(point.tangent);
  d.bottomRightCorner<3, 3>() = transposed;
  return d;
}

/// Computes carried strains: the strains at an element's stiffness points after an update {dr, spin} of its nodes, to
/// first order. The geometric part of the next tangent uses them in place of the strains of the new configuration,
/// which contain spurious terms of second order (docs/notes/newton.md). `rotation_at(k, generalised)` returns the
/// interpolated rotation at stiffness point k, and sets the generalised shape functions.
template <int Nodes, class RotationAt>
void carried_strains(const BeamElement<Nodes>& element, const PlacedNodes<Nodes>& nodes, const RotationAt& rotation_at,
                     const std::array<Vector6, Nodes>& update, Vector6* strains) {
  for (int k = 0; k < BeamElement<Nodes>::kStiffnessPoints; ++k) {
    const auto& constants = element.stiffness_points[k];
    GeneralisedShapeFunctions<Nodes> generalised;
    const InterpolatedRotation<double> rotation = rotation_at(k, generalised);
    const PointKinematics point = end_kinematics<Nodes>(constants, nodes, rotation);
    Eigen::Matrix<double, 9, 1> variation = Eigen::Matrix<double, 9, 1>::Zero();  // {dr', spin, spin'}
    for (int i = 0; i < Nodes; ++i) {
      variation.head<3>() += constants.derivative[i] * update[i].template head<3>();
      variation.segment<3>(3) += generalised.values[i] * update[i].template tail<3>();
      variation.tail<3>() += generalised.derivatives[i] * update[i].template tail<3>();
    }
    strains[k] = point.strain + strain_derivative(point) * variation;
  }
}

/// Lagrange functions as test functions of the moment rows at a point.
template <int Nodes>
struct LagrangeTests {
  const NodalValues<Nodes>& shape;
  const NodalValues<Nodes>& slope;
  template <class Rows>
  auto value(int i, const Rows& rows) const {
    return shape[i] * rows;
  }
  template <class Rows>
  auto derivative(int i, const Rows& rows) const {
    return slope[i] * rows;
  }
};
/// Transposed generalised shape functions as test functions of the moment rows at a point.
template <int Nodes>
struct GeneralisedTests {
  const GeneralisedShapeFunctions<Nodes>& functions;
  template <class Rows>
  auto value(int i, const Rows& rows) const {
    return functions.values[i].transpose().lazyProduct(rows);
  }
  template <class Rows>
  auto derivative(int i, const Rows& rows) const {
    return functions.derivatives[i].transpose().lazyProduct(rows);
  }
};

/// Adds w {I^i' n, I_t^i' m - I_t^i (arm x n)} to the residual; I_t: the moment rows' test functions.
template <int Nodes, class Tests>
void add_point_residual(double weight, const NodalValues<Nodes>& derivative, const Tests& tests, const Vector3& n,
                        const Vector3& m, const Vector3& arm, Eigen::Matrix<double, 6 * Nodes, 1>& residual) {
  const Vector3 wn = weight * n, wm = weight * m, wc = arm.cross(wn);
  for (int i = 0; i < Nodes; ++i) {
    residual.template segment<3>(6 * i) += derivative[i] * wn;
    residual.template segment<3>(6 * i + 3) += tests.derivative(i, wm);
    residual.template segment<3>(6 * i + 3) -= tests.value(i, wc);
  }
}

/// Maps the nodes' {dr_j, spin_j} to {dr', spin, spin'} of a point.
template <int Nodes>
struct PointVariation {
  const NodalValues<Nodes>& derivative;           ///< dr' = sum derivative[j] dr_j
  const GeneralisedShapeFunctions<Nodes>& spins;  ///< spin = sum values[j] spin_j, spin' = sum derivatives[j] spin_j
};

/// Returns the columns of a point's linearisation with respect to node j's {dr_j, spin_j}.
template <int Nodes, int Rows>
Eigen::Matrix<double, Rows, 6> node_columns(const Eigen::Matrix<double, Rows, 9>& point,
                                            const PointVariation<Nodes>& variation, int j) {
  Eigen::Matrix<double, Rows, 6> columns;
  columns.template leftCols<3>() = variation.derivative[j] * point.template leftCols<3>();
  auto spin = columns.template rightCols<3>();
  spin.noalias() = point.template middleCols<3>(3).lazyProduct(variation.spins.values[j]);
  spin.noalias() += point.template rightCols<3>().lazyProduct(variation.spins.derivatives[j]);
  return columns;
}

/// Adds the tangent of add_point_residual(). `resultants` is d{n, m}, `couple` d(arm x n), both with columns
/// {dr', spin, spin'}.
template <int Nodes, class Tests>
void add_point_tangent(double weight, const Tests& tests, const PointVariation<Nodes>& variation,
                       const Eigen::Matrix<double, 6, 9>& resultants, const Eigen::Matrix<double, 3, 9>& couple,
                       Eigen::Matrix<double, 6 * Nodes, 6 * Nodes>& tangent) {
  Eigen::Matrix<double, 9, 9> all;
  all << weight * resultants, weight * couple;
  for (int j = 0; j < Nodes; ++j) {
    const Eigen::Matrix<double, 9, 6> d = node_columns<Nodes, 9>(all, variation, j);
    const Eigen::Matrix<double, 3, 6> moment = d.template middleRows<3>(3), cross = d.template bottomRows<3>();
    for (int i = 0; i < Nodes; ++i) {
      tangent.template block<3, 6>(6 * i, 6 * j) += variation.derivative[i] * d.template topRows<3>();
      tangent.template block<3, 6>(6 * i + 3, 6 * j) += tests.derivative(i, moment);
      tangent.template block<3, 6>(6 * i + 3, 6 * j) -= tests.value(i, cross);
    }
  }
}

/// Adds coefficient * mass_ij * vectors_j to the force rows, and slope * mass_ij to the translational tangent.
template <int Nodes>
void add_translational(const Eigen::Matrix<double, Nodes, Nodes>& mass, const std::array<Vector3, Nodes>& vectors,
                       double slope, bool with_tangent, ElementSystem<Nodes>& system) {
  for (int i = 0; i < Nodes; ++i) {
    for (int j = 0; j < Nodes; ++j) {
      system.residual.template segment<3>(6 * i) += mass(i, j) * vectors[j];
      if (with_tangent) system.tangent.template block<3, 3>(6 * i, 6 * j).diagonal().array() += slope * mass(i, j);
    }
  }
}

}  // namespace flexarm
