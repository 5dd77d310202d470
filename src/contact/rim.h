#pragma once
/// The rim of a cylinder: a circle with which it touches flat faces at its lowest point. (docs/notes/contact.md 1.2)

#include "flexarm/math/pose.h"

namespace flexarm {

/// A circle. Its middle and its axis, a unit vector, are in the same frame.
struct Rim {
  Vector3 middle, axis;
  double radius;  ///< [m]
};

/// The lowest point of a circle that lies flat is undetermined. So the point goes to the middle where the sine of the
/// tilt is less than this. It is then inside of the rim by at most the square of this over twice the sine, relative to
/// the radius.
constexpr double kFlatRim = 1e-3;

/// Returns the lowest point over a plane with this normal, relative to the middle [m].
Vector3 lowest_point(const Rim& rim, const Vector3& normal);
/// Returns the derivative of lowest_point() with respect to a spin of the rim relative to the plane [m].
Matrix3 lowest_point_by_spin(const Rim& rim, const Vector3& normal);

/// The change of the height of the lowest point over the middle, divided by that of the cosine between axis and normal,
/// with the opposite sign [m]. `begin`, `end`: cosines. `slope`: derivative with respect to the cosine at the end.
struct RimLever {
  double value = 0, slope = 0;
};
RimLever rim_lever(double radius, double begin, double end);
/// Returns the couple of a push of 1 N along the normal that lowest_point() lacks, by its way to the middle [m].
Vector3 couple_beside(const Rim& rim, const Vector3& normal);

}  // namespace flexarm
