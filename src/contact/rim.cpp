#include "contact/rim.h"

#include <cmath>

#include "math/so3.h"

namespace flexarm {
namespace {

/// The sine of the tilt, but at least kFlatRim.
double sine(double cosine) {
  return std::sqrt(std::max(0.0, 1 - cosine * cosine) + kFlatRim * kFlatRim);
}

}  // namespace

Vector3 lowest_point(const Rim& rim, const Vector3& normal) {
  const double cosine = normal.dot(rim.axis);
  return -rim.radius / sine(cosine) * (normal - cosine * rim.axis);
}

Matrix3 lowest_point_by_spin(const Rim& rim, const Vector3& normal) {
  const double cosine = normal.dot(rim.axis), root = sine(cosine);
  const Eigen::RowVector3d cosine_by_spin = rim.axis.cross(normal).transpose();
  const Matrix3 axis_by_spin = -so3::hat(rim.axis);
  const Vector3 across = normal - cosine * rim.axis;
  return rim.radius / root * ((rim.axis - cosine / (root * root) * across) * cosine_by_spin + cosine * axis_by_spin);
}

RimLever rim_lever(double radius, double begin, double end) {
  const double s0 = sine(begin), s1 = sine(end), square = kFlatRim * kFlatRim;
  const double ratio = (begin + end) / (s0 + s1), factor = 1 + square / (s0 * s1);
  const double ratio_slope = (1 + ratio * end / s1) / (s0 + s1), factor_slope = square * end / (s0 * s1 * s1 * s1);
  return {radius * ratio * factor, radius * (ratio_slope * factor + ratio * factor_slope)};
}

Vector3 couple_beside(const Rim& rim, const Vector3& normal) {
  const double cosine = normal.dot(rim.axis), root = sine(cosine);
  return (rim_lever(rim.radius, cosine, cosine).value - rim.radius * cosine / root) * rim.axis.cross(normal);
}

}  // namespace flexarm
