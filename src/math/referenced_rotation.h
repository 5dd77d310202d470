#pragma once
/// Interpolation of rotation vectors that nodes and points measure from a reference of their own: Lambda = exp(theta)
/// Lambda_ref with theta = sum I^i theta_i. Which reference makes the difference between the thesis's global
/// interpolations: the undeformed state (total), the last step (incremental), the last iterate (iterative); with
/// tangent-scaled vectors and the last step, that of Simo, Tarnow and Doblaré. None is strain-invariant.
/// (Muñoz 2004, sec. 5.2; eq. 5.5, E.3, E.9)

#include "math/cayley.h"
#include "math/local_rotation.h"

namespace flexarm {

enum class RotationParameters { Unscaled, TangentScaled };

template <int Nodes, typename S = double>
class ReferencedRotations {
 public:
  /// `vectors`: spatial rotation vectors (or tangent-scaled ones) from the nodes' references.
  ReferencedRotations(RotationParameters parameters, const std::array<Vector3T<S>, Nodes>& vectors)
      : parameters_(parameters), vectors_(vectors) {
    for (int i = 0; i < Nodes; ++i)
      inverse_tangents_[i] = is_scaled() ? cayley::inverse_tangent(vectors[i]) : so3::inverse_tangent(vectors[i]);
  }

  /// `reference`: rotation and curvature of the point's reference; the derivatives are with respect to the same
  /// coordinate as its curvature.
  InterpolatedRotation<S> evaluate(const NodalValues<Nodes>& shape, const NodalValues<Nodes>& derivative,
                                   const InterpolatedRotation<S>& reference,
                                   GeneralisedShapeFunctions<Nodes, S>& generalised) const {
    Vector3T<S> theta = Vector3T<S>::Zero(), theta_derivative = Vector3T<S>::Zero();
    for (int i = 0; i < Nodes; ++i) {
      theta += S(shape[i]) * vectors_[i];
      theta_derivative += S(derivative[i]) * vectors_[i];
    }
    const Matrix3T<S> tangent = is_scaled() ? cayley::tangent(theta) : so3::tangent(theta);
    const Matrix3T<S> tangent_derivative = is_scaled() ? cayley::tangent_derivative(theta, theta_derivative)
                                                       : so3::tangent_derivative(theta, theta_derivative);
    for (int i = 0; i < Nodes; ++i) {
      const S value(shape[i]), slope(derivative[i]);
      generalised.values[i].noalias() = (value * tangent) * inverse_tangents_[i];
      generalised.derivatives[i].noalias() = (value * tangent_derivative + slope * tangent) * inverse_tangents_[i];
    }
    InterpolatedRotation<S> result;
    const Matrix3T<S> turn = is_scaled() ? cayley::rotation(theta) : so3::exp(theta);
    result.rotation.noalias() = turn * reference.rotation;
    result.curvature = reference.curvature + reference.rotation.transpose() * (tangent.transpose() * theta_derivative);
    return result;
  }

 private:
  bool is_scaled() const { return parameters_ == RotationParameters::TangentScaled; }

  RotationParameters parameters_;
  std::array<Vector3T<S>, Nodes> vectors_;
  std::array<Matrix3T<S>, Nodes> inverse_tangents_;
};

}  // namespace flexarm
