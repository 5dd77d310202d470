#include "joints/slide_rotation.h"

#include <cassert>

#include "math/cayley.h"
#include "math/so3.h"

namespace flexarm::slide {
namespace {

Vector3 increment(const Matrix3& from, const Matrix3& to) {
  return cayley::increment(so3::quaternion_from_matrix(Matrix3(to * from.transpose())));
}

}  // namespace

RotationSplit::RotationSplit(const TravelledFrames& frames, double c, double change, bool is_short,
                             const Vector3& curvature_begin, const Vector3& curvature_end)
    : begin_(1 - c),
      end_(c),
      change_(change),
      is_short_(is_short),
      curvature_10_(frames.curvature_10),
      curvature_11_(frames.curvature_11),
      a1_(increment(frames.at_00, frames.at_01)),
      b1_(increment(frames.at_01, frames.at_11)),
      a2_(increment(frames.at_10, frames.at_11)),
      b2_(increment(frames.at_00, frames.at_10)),
      along1_(is_short ? curvature_end : Vector3(b1_ / change)),
      along2_(is_short ? curvature_begin : Vector3(b2_ / change)),
      c1_(1 / (1 - 0.25 * a1_.dot(b1_))),
      c2_(1 / (1 - 0.25 * a2_.dot(b2_))),
      turned1_(cayley::inverse_tangent(a1_) * along1_),
      turned2_(cayley::inverse_tangent(a2_).transpose() * along2_) {
  assert((is_short || change != 0) && "a way of no length is short");
}

Vector3 RotationSplit::fixed() const {
  return begin_ * a1_ + end_ * a2_;
}

Vector3 RotationSplit::along() const {
  return begin_ * c1_ * turned1_ + end_ * c2_ * turned2_;
}

RotationSplit::Gradient RotationSplit::of_fixed(const Vector3& moment) const {
  Gradient out;
  out.at_01 = begin_ * (cayley::inverse_tangent(a1_).transpose() * moment);
  out.at_11 = end_ * (cayley::inverse_tangent(a2_).transpose() * moment);
  out.arc_length = out.at_11.dot(curvature_11_) - end_ * moment.dot(slid_back(a2_));
  return out;
}

RotationSplit::Gradient RotationSplit::of_along(const Vector3& moment, const Vector3& slope_begin,
                                                const Vector3& slope_end) const {
  const Matrix3 inverse1 = cayley::inverse_tangent(a1_), inverse2 = cayley::inverse_tangent(a2_);
  const double work1 = begin_ * 0.25 * c1_ * c1_ * moment.dot(turned1_),
               work2 = end_ * 0.25 * c2_ * c2_ * moment.dot(turned2_);
  const Vector3 along1 = begin_ * c1_ * (inverse1.transpose() * moment), along2 = end_ * c2_ * (inverse2 * moment);
  const Vector3 a1 = begin_ * c1_ * (cayley::xi_inverse_tangent(a1_, along1_).transpose() * moment) + work1 * b1_;
  // S^-T(a) = S^-1(-a)
  const Vector3 a2 =
      -end_ * c2_ * (cayley::xi_inverse_tangent(Vector3(-a2_), along2_).transpose() * moment) + work2 * b2_;
  Vector3 b1 = work1 * a1_, b2 = work2 * a2_;
  Gradient out;
  if (is_short_) {
    out.curvature = along1;
    out.arc_length = along1.dot(slope_end) + along2.dot(slope_begin);
  } else {
    b1 += along1 / change_;
    b2 += along2 / change_;
    out.arc_length = -(along1.dot(along1_) + along2.dot(along2_)) / change_;
  }
  const Matrix3 inverse_b1 = cayley::inverse_tangent(b1_);
  out.at_01 = inverse1.transpose() * a1 - inverse_b1 * b1;
  out.at_11 = inverse_b1.transpose() * b1 + inverse2.transpose() * a2;
  out.arc_length +=
      out.at_11.dot(curvature_11_) - a2.dot(slid_back(a2_)) + b2.dot(cayley::inverse_tangent(b2_) * curvature_10_);
  return out;
}

/// Returns minus the derivative of a2 with respect to the arc length due to the motion of its first frame, 10.
Vector3 RotationSplit::slid_back(const Vector3& a2) const {
  return cayley::inverse_tangent(a2).transpose() * curvature_10_;
}

}  // namespace flexarm::slide
