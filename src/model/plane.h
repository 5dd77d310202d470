#pragma once
/// Data of the plane in which a planar mechanism moves, and projections into it (docs/notes/planar.md).

#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

using Vector2 = Eigen::Vector2d;

/// The pose of a node in the plane: its position, and half of its angle of rotation relative to PlaneOfMotion::frames.
struct alignas(32) PlanarPose {
  double x = 0, y = 0;          ///< [m]
  double cosine = 1, sine = 0;  ///< of half the angle; both with the opposite sign are the same pose, one turn further
};

/// A plane with axes of its own. A planar mechanism that starts in this plane, or in one parallel to it, stays there.
/// Displacements, velocities and forces lie in the plane; rotations and moments point along the normal. {first, second,
/// normal} is right-handed.
struct PlaneOfMotion {
  Vector3 first = Vector3::UnitX(), second = Vector3::UnitY(), normal = Vector3::UnitZ();
  /// Per node: a reference orientation from which the node only rotates about the normal. All nodes of an element have
  /// the same one.
  std::vector<Quaternion> frames;

  /// projected() turns {f, phi} in world axes into {f_1, f_2, phi_n}; expanded() does the reverse.
  template <class V>
  Vector3 projected(const Eigen::MatrixBase<V>& wrench) const {
    const Vector3 force = wrench.template head<3>(), moment = wrench.template tail<3>();
    return {first.dot(force), second.dot(force), normal.dot(moment)};
  }
  template <class V>
  Vector6 expanded(const Eigen::MatrixBase<V>& wrench) const {
    Vector6 out;
    out << wrench[0] * first + wrench[1] * second, wrench[2] * normal;
    return out;
  }
  /// Components of a vector in the plane.
  Vector2 in_plane(const Vector3& vector) const { return {first.dot(vector), second.dot(vector)}; }

  PlanarPose pose(int node, const Vector3& position, const Quaternion& orientation) const {
    const Quaternion turn = orientation * frames[node].conjugate();
    return {first.dot(position), second.dot(position), turn.w(), normal.dot(turn.vec())};
  }
  /// Returns the normal in the node's frame.
  Vector3 material_normal(int node) const { return frames[node].conjugate() * normal; }
  /// Returns the matrix that turns planar strains {Gamma_1, Gamma_2, K} into strains {Gamma, K} in section axes. Its
  /// columns are the plane's axes for Gamma and the normal for K. `node`: any node of the element.
  Eigen::Matrix<double, 6, 3> strain_basis(int node) const {
    Eigen::Matrix<double, 6, 3> basis = Eigen::Matrix<double, 6, 3>::Zero();
    const Quaternion to_material = frames[node].conjugate();
    basis.col(0).head<3>() = to_material * first;
    basis.col(1).head<3>() = to_material * second;
    basis.col(2).tail<3>() = to_material * normal;
    return basis;
  }
};

}  // namespace flexarm
