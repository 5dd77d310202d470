#pragma once
/// Splits the rotation of a section that slides along a line into the part of the line's motion and that of the travel.
/// (joints.md 4.4)

#include "flexarm/math/pose.h"

namespace flexarm::slide {

/// Frames of the line before and after a step, at both places.
struct TravelledFrames {
  Matrix3 at_00, at_01, at_10, at_11;  ///< first index: place, second: time
  Vector3 curvature_10, curvature_11;  ///< in space [1/m]
};

/// The section's rotation increment = fixed + along Delta X: "move, then slide" (1) with the weight 1 - c and "slide,
/// then move" (2) with c.
class RotationSplit {
 public:
  /// Of a travel by `change` [m]. Where that `is_short`, the line's curvatures in its middle, before and after the
  /// step, take the place of rotations over it [1/m].
  RotationSplit(const TravelledFrames& frames, double c, double change, bool is_short, const Vector3& curvature_begin,
                const Vector3& curvature_end);

  Vector3 fixed() const;  ///< tangent-scaled rotation
  Vector3 along() const;  ///< the same per arc length [1/m]

  /// Derivatives of a linear function of `fixed` or `along`: with respect to the spins of the frames 01 and 11, to the
  /// curvature of the line at the end where the travel is short, and to the arc length at the end.
  struct Gradient {
    Vector3 at_01 = Vector3::Zero(), at_11 = Vector3::Zero(), curvature = Vector3::Zero();
    double arc_length = 0;
  };

  /// Of fixed() . `moment`.
  Gradient of_fixed(const Vector3& moment) const;

  /// Of along() . `moment`. `slope_begin`, `slope_end`: derivatives of the short travel's curvatures with respect to
  /// the arc length at the end.
  Gradient of_along(const Vector3& moment, const Vector3& slope_begin, const Vector3& slope_end) const;

 private:
  Vector3 slid_back(const Vector3& a2) const;

  double begin_, end_, change_;
  bool is_short_;
  Vector3 curvature_10_, curvature_11_;
  Vector3 a1_, b1_, a2_, b2_, along1_, along2_;
  double c1_, c2_;
  Vector3 turned1_, turned2_;
};

}  // namespace flexarm::slide
