#pragma once
/// The plane in which a mechanism moves, if there is one (docs/notes/planar.md).

#include <string>
#include <vector>

#include "flexarm/math/pose.h"

namespace flexarm {

using Vector2 = Eigen::Vector2d;

/// Where a node stands in the plane: its position, and half the angle by which it is turned from PlaneOfMotion::frames.
struct alignas(32) PlanarPose {
  double x = 0, y = 0;          ///< [m]
  double cosine = 1, sine = 0;  ///< of half the angle; both signs are the same pose, a turn apart
};

/// A plane, with axes of its own, or one parallel to it, in which all nodes stay that start there. What lies in it are
/// positions and forces; what points along the normal are turns and moments. {first, second, normal} is right-handed.
struct PlaneOfMotion {
  Vector3 first = Vector3::UnitX(), second = Vector3::UnitY(), normal = Vector3::UnitZ();
  std::vector<Quaternion> frames;  ///< per node: a frame of it from which it is turned about the normal alone; nodes of
                                   ///< an element have the same one

  /// {f, phi} in the world as {f_1, f_2, phi_n}, and back.
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
  /// The normal, in the node's frame.
  Vector3 material_normal(int node) const { return frames[node].conjugate() * normal; }
  /// {first, second} for Gamma, {normal} for K, as the section frames of an element see them: strains are `basis` times
  /// {Gamma_1, Gamma_2, K}.
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
