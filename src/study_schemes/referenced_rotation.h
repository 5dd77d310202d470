#pragma once
/// Interpolation of rotation vectors relative to references: Lambda = exp(theta) Lambda_ref with theta = sum I^i
/// theta_i, where each node and each point has its own reference rotation. The global interpolations of the thesis
/// differ in the reference: the undeformed state (total), the last step (incremental), or the last iterate (iterative).
/// With tangent-scaled vectors and the last step, it is the interpolation of Simo, Tarnow and Doblaré. None of these is
/// strain-invariant. (Muñoz 2004, sec. 5.2; eq. 5.5, E.3, E.9)

#include "math/cayley.h"
#include "math/local_rotation.h"

namespace flexarm {

enum class RotationParameters { Unscaled, TangentScaled };

template <int Nodes, typename S = double>
class ReferencedRotations {
 public:
  /// `vectors`: spatial rotation vectors of the nodes relative to their references; tangent-scaled if `parameters` says
  /// so.
  ReferencedRotations(RotationParameters parameters, const std::array<Vector3T<S>, Nodes>& vectors)
      : parameters_(parameters), vectors_(vectors) {
    for (int i = 0; i < Nodes; ++i)
      inverse_tangents_[i] = is_scaled() ? cayley::inverse_tangent(vectors[i]) : so3::inverse_tangent(vectors[i]);
  }

  /// Returns rotation and curvature at a point, and sets the generalised shape functions. `reference`: rotation and
  /// curvature of the point's reference. `derivative` must be with respect to the same coordinate as that curvature.
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
