#pragma once
/// Splits the rotation of a section that slides along a line into a part due to the line's motion and a part due to the
/// travel. (joints.md 4.4)

#include "flexarm/math/pose.h"

namespace flexarm::slide {

/// Frames of the line at the beginning and end of a step, each at the arc lengths where the travel begins and ends.
struct TravelledFrames {
  Matrix3 at_00, at_01, at_10, at_11;  ///< first index: arc length (0: begin, 1: end), second: time
  Vector3 curvature_10, curvature_11;  ///< of the frames 10 and 11, world axes [1/m]
};

/// The rotation increment of the section = fixed + along Delta X. It is the weighted mean of two exact splits: (1) "the
/// line moves, then the section slides" with the weight 1 - c, and (2) "it slides, then the line moves" with c.
class RotationSplit {
 public:
  /// `change`: length of the travel, Delta X [m]. If it `is_short`, the rotations over it are computed from the line's
  /// curvatures in its middle, at the beginning and the end of the step [1/m].
  RotationSplit(const TravelledFrames& frames, double c, double change, bool is_short, const Vector3& curvature_begin,
                const Vector3& curvature_end);

  Vector3 fixed() const;  ///< part due to the line's motion, tangent-scaled [rad]
  Vector3 along() const;  ///< part due to the travel, tangent-scaled, per arc length [1/m]

  /// Derivatives of a linear function of fixed() or along() with respect to: the spins of the frames 01 and 11, the arc
  /// length at the end, and (short travels only) the curvature in the middle at the end of the step.
  struct Gradient {
    Vector3 at_01 = Vector3::Zero(), at_11 = Vector3::Zero(), curvature = Vector3::Zero();
    double arc_length = 0;
  };

  /// Derivatives of fixed() . `moment`.
  Gradient of_fixed(const Vector3& moment) const;

  /// Derivatives of along() . `moment`. `slope_begin`, `slope_end`: derivatives of the short travel's two curvatures
  /// with respect to the arc length at the end.
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
