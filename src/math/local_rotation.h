#pragma once
/// Strain-invariant interpolation of section rotations by local rotation vectors, and its exact variation.
///
/// The nodal rotations are measured from a reference rotation that moves with the element, so a superposed rigid
/// rotation changes no strain and the result does not depend on the path. (Muñoz 2004, eq. 5.6-5.15)
///
/// Differences to the thesis, which save operations: the thesis has local vectors in the reference frame,
/// Theta_i = log(R^T Lambda_i), and transforms every generalised shape function to world axes by R (.) R^T. Here the
/// vectors themselves are in world axes, theta_i = R Theta_i = log(Lambda_i R^T). Since R T(Theta) R^T = T(R Theta), no
/// matrix needs a transformation. If the number of nodes is odd, the reference node has theta = 0 and T^-1 = I, and its
/// shape function follows from those of the others by sum I_g = I. If it is even, the two reference nodes have opposite
/// vectors, hence one T^-1 is the transpose of the other.

#include <array>
#include <cstddef>

#include "math/shape_functions.h"
#include "math/so3.h"

namespace flexarm {

/// The two nodes of which the reference rotation is the half-way rotation. If there is a middle node, both are this
/// node.
struct ReferenceNodes {
  int first;
  int second;
};

template <int Nodes>
constexpr ReferenceNodes reference_nodes() {
  return {(Nodes - 1) / 2, Nodes / 2};
}

/// Interpolated rotation at a point.
template <typename S = double>
struct InterpolatedRotation {
  Matrix3T<S> rotation;  ///< Lambda, section frame to world
  /// Upsilon = vee(Lambda^T Lambda') in the section frame; ' is the derivative with respect to the coordinate of the
  /// given derivatives of the shape functions.
  Vector3T<S> curvature;
};

/// Generalised shape functions at a point: dvartheta = sum_i values[i] dvartheta_i for spatial spins, and
/// d(Upsilon) = Lambda^T sum_i derivatives[i] dvartheta_i. The values sum to I, the derivatives to 0.
template <int Nodes, typename S = double>
struct GeneralisedShapeFunctions {
  std::array<Matrix3T<S>, Nodes> values;
  std::array<Matrix3T<S>, Nodes> derivatives;
};

/// The interpolation of an element's rotations; its constructor does what is common to all points. The rotation of
/// every node relative to the reference must be less than 2 pi. If the number of nodes is even, so must be the relative
/// rotation of the two reference nodes. Elements with larger rotations must be divided.
template <int Nodes, typename S = double>
class LocalRotations {
 public:
  static constexpr ReferenceNodes reference = reference_nodes<Nodes>();
  static constexpr bool has_middle_node = reference.first == reference.second;

  /// `rotations`: unit quaternions, section frame to world. Their signs matter: a quaternion of opposite sign means one
  /// turn more, so relative rotations may be larger than pi.
  explicit LocalRotations(const std::array<QuaternionT<S>, Nodes>& rotations) {
    QuaternionT<S> middle = rotations[reference.first];
    quarter_tangent_.setZero();
    if constexpr (!has_middle_node)
      middle = set_reference_pair(middle, rotations[reference.second]);
    else
      local_[reference.first].setZero();
    for (int i = 0; i < Nodes; ++i) {
      if (i == reference.first || i == reference.second) continue;
      local_[i] = so3::unfolded_log(relative(rotations[i], middle));
    }
    reference_rotation_ = middle.toRotationMatrix();
  }

  /// `rotations`: matrices, section frame to world. The rotation from one node to the next must be less than pi.
  explicit LocalRotations(const std::array<Matrix3T<S>, Nodes>& rotations) : LocalRotations(quaternions(rotations)) {}

  /// R, the reference rotation.
  const Matrix3T<S>& reference_rotation() const { return reference_rotation_; }
  /// theta_i = log(Lambda_i R^T), world axes. [rad]
  const std::array<Vector3T<S>, Nodes>& rotation_vectors() const { return local_; }
  /// tan(|theta_ab|/4) theta_ab/|theta_ab|, theta_ab = log(Lambda_b Lambda_a^T); zero if there is a middle node.
  const Vector3T<S>& quarter_tangent() const { return quarter_tangent_; }

  /// theta = sum_i weights_i theta_i.
  template <typename W>
  Vector3T<S> interpolate(const NodalValues<Nodes, W>& weights) const {
    Vector3T<S> sum = S(weights[0]) * local_[0];
    for (int i = 1; i < Nodes; ++i) sum += S(weights[i]) * local_[i];
    return sum;
  }

  /// Returns rotation and curvature, given the shape functions and their derivatives (with respect to any coordinate).
  template <typename W>
  InterpolatedRotation<S> evaluate(const NodalValues<Nodes, W>& shape,
                                   const NodalValues<Nodes, W>& shape_derivative) const {
    return evaluate(so3::ExponentialMap<S>(interpolate(shape)), interpolate(shape_derivative));
  }

  /// The same from the exponential map of theta and the derivative of theta.
  InterpolatedRotation<S> evaluate(const so3::ExponentialMap<S>& map, const Vector3T<S>& derivative) const {
    InterpolatedRotation<S> result;
    result.rotation.noalias() = map.rotation() * reference_rotation_;
    result.curvature.noalias() = reference_rotation_.transpose() * map.material_spin(derivative);
    return result;
  }

 private:
  static QuaternionT<S> relative(const QuaternionT<S>& to, const QuaternionT<S>& from) {
    return to * QuaternionT<S>(from.w(), -from.x(), -from.y(), -from.z());
  }

  /// Sets the local vectors of the reference pair, and returns the half-way rotation. Half the rotation of a quaternion
  /// q is q + 1, normalised, and the tangent of a quarter of its angle is q_v / (q_0 + 1), so no trigonometry is
  /// needed.
  QuaternionT<S> set_reference_pair(const QuaternionT<S>& first, const QuaternionT<S>& second) {
    using std::sqrt;
    QuaternionT<S> q = relative(second, first);
    local_[reference.second] = S(0.5) * so3::unfolded_log(q);
    local_[reference.first] = -local_[reference.second];
    q.w() += S(1);
    quarter_tangent_ = Vector3T<S>(q.x(), q.y(), q.z()) / q.w();
    q.coeffs() /= sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
    return q * first;
  }

  static std::array<QuaternionT<S>, Nodes> quaternions(const std::array<Matrix3T<S>, Nodes>& rotations) {
    std::array<QuaternionT<S>, Nodes> result;
    for (std::size_t i = 0; i < Nodes; ++i) result[i] = so3::quaternion_from_matrix(rotations[i]);
    for (std::size_t i = 1; i < Nodes; ++i) result[i] = so3::nearer_of_two(result[i], result[i - 1]);
    return result;
  }

  Matrix3T<S> reference_rotation_;
  std::array<Vector3T<S>, Nodes> local_;
  Vector3T<S> quarter_tangent_;
};

/// The variation of an element's interpolation; its constructor does what is common to all points.
template <int Nodes, typename S = double>
class LocalRotationVariation {
 public:
  explicit LocalRotationVariation(const LocalRotations<Nodes, S>& local) : local_(local) {
    for (int i = 0; i < Nodes; ++i) {
      if (i == first) continue;
      inverse_tangents_[i] = so3::inverse_tangent(local.rotation_vectors()[i]);
    }
    if constexpr (first == second)
      inverse_tangents_[first].setIdentity();
    else
      inverse_tangents_[first] = inverse_tangents_[second].transpose();
  }

  const LocalRotations<Nodes, S>& local_rotations() const { return local_; }

  /// Returns rotation and curvature, and sets the generalised shape functions I_g, I_g', given the shape functions and
  /// their derivatives.
  template <typename W>
  InterpolatedRotation<S> evaluate(const NodalValues<Nodes, W>& shape, const NodalValues<Nodes, W>& shape_derivative,
                                   GeneralisedShapeFunctions<Nodes, S>& generalised) const {
    const so3::ExponentialMap<S> map(local_.interpolate(shape));
    const Vector3T<S> derivative = local_.interpolate(shape_derivative);
    const Matrix3T<S> tangent = map.tangent();
    const Matrix3T<S> tangent_derivative = map.tangent_derivative(derivative);
    // The terms T I^i T_i^-1 of the nodes do not sum to I. The rest is the spin of the reference frame.
    Matrix3T<S> rest = Matrix3T<S>::Identity(), rest_derivative = Matrix3T<S>::Zero();
    for (int i = 0; i < Nodes; ++i) {
      if (first == second && i == first) continue;
      const S value(shape[i]), slope(shape_derivative[i]);
      generalised.values[i].noalias() = (value * tangent) * inverse_tangents_[i];
      generalised.derivatives[i].noalias() = (value * tangent_derivative + slope * tangent) * inverse_tangents_[i];
      rest -= generalised.values[i];
      rest_derivative -= generalised.derivatives[i];
    }
    distribute(rest, generalised.values);
    distribute(rest_derivative, generalised.derivatives);
    return local_.evaluate(map, derivative);
  }

 private:
  static constexpr int first = reference_nodes<Nodes>().first;
  static constexpr int second = reference_nodes<Nodes>().second;

  /// Adds rest upsilon_i to the reference nodes: upsilon = I, or (I +- hat(quarter_tangent)) / 2 for a pair.
  void distribute(const Matrix3T<S>& rest, std::array<Matrix3T<S>, Nodes>& shape) const {
    if constexpr (first == second) {
      shape[first] = rest;
    } else {
      const Matrix3T<S> share = S(0.5) * rest;
      const Matrix3T<S> skew = share * so3::hat(local_.quarter_tangent());
      shape[first] += share + skew;
      shape[second] += share - skew;
    }
  }

  LocalRotations<Nodes, S> local_;
  std::array<Matrix3T<S>, Nodes> inverse_tangents_;
};

/// Returns rotation and curvature half-way between the nodes of an element of two nodes. The local vector is zero
/// there, so the rotation is the reference rotation. `slope`: derivative of the second node's shape function.
/// (docs/notes/beam.md 2.4)
template <typename S>
InterpolatedRotation<S> evaluate_half_way(const LocalRotations<2, S>& local, const S& slope) {
  InterpolatedRotation<S> result;
  result.rotation = local.reference_rotation();
  result.curvature.noalias() = result.rotation.transpose() * Vector3T<S>((S(2) * slope) * local.rotation_vectors()[1]);
  return result;
}

/// The same, and sets the generalised shape functions. The values give the spin of the reference rotation; the
/// derivatives are plus and minus the symmetric matrix slope (e e^T + theta/sin(theta) (I - e e^T)).
template <typename S>
InterpolatedRotation<S> evaluate_half_way(const LocalRotations<2, S>& local, const S& slope,
                                          GeneralisedShapeFunctions<2, S>& generalised) {
  const Vector3T<S> half_tangent = S(0.5) * local.quarter_tangent(), &theta = local.rotation_vectors()[1];
  const Matrix3T<S> skew = so3::hat(half_tangent);
  generalised.values[0] = skew;
  generalised.values[1] = skew.transpose();
  for (Matrix3T<S>& value : generalised.values) value.diagonal().setConstant(S(0.5));
  const std::array<S, 3> a = so3::series_coefficients<2>(so3::dot(theta, theta));
  const S across = slope / a[0];
  Matrix3T<S>& derivative = generalised.derivatives[1];
  derivative.noalias() = Vector3T<S>((-a[2] * across) * theta) * theta.transpose();
  derivative.diagonal().array() += across;
  generalised.derivatives[0] = -derivative;
  return evaluate_half_way(local, slope);
}

}  // namespace flexarm
