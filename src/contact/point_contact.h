#pragma once
/// A point that touches a shape, as the shape sees it: all vectors have the axes of the body that the shape is fixed
/// to. (docs/notes/contact.md)

#include "contact/contact_law.h"
#include "contact/shape.h"

namespace flexarm {

/// Change of a signed distance between two points: `gradient` times the way is exactly the change. It is Gonzalez'
/// discrete gradient; at an instant the gradient at the end.
struct GapChange {
  double begin, end;  ///< [m], < 0 inside
  Vector3 gradient;
  Matrix3 slope;         ///< of the gradient, by the point at the end
  Vector3 end_gradient;  ///< of the distance, at the end
};
GapChange gap_change(const ContactShape& shape, const Vector3& from, const Vector3& to, bool at_end);

/// Over a step.
struct PointMotion {
  Vector3 begin, end;     ///< where the middle of the point's ball is [m]
  Vector3 turn;           ///< of the ball less that of the shape's body, tangent-scaled, mean axes
  double begin_rate = 0;  ///< of the penetration [m/s]
  double duration = 0;    ///< [s]; 0: an equilibrium
  bool at_end = false;    ///< what acts at the end counts; else means, whose work is exact
};
/// For each point and shape, zero where they do not touch.
struct PointMemory {
  static constexpr int kSize = 4;
  double speed = 0;  ///< see remembered_speed()
  Vector3 stretch = Vector3::Zero();
};
/// On the ball: a force through its middle and a couple, conjugate to the way and to the turn.
struct PointAction {
  Vector6 wrench = Vector6::Zero();
  Matrix6 slope = Matrix6::Zero();  ///< by {end, turn}
  PointMemory memory;               ///< at the end of the step
  double dissipated = 0;            ///< [J]
  bool acts = false;
};
/// `radius`: of the ball [m].
PointAction point_action(const ContactShape& shape, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope);

/// Rate of the distance of a point that moves so against the shape's body.
double gap_rate(const ContactShape& shape, const Vector3& point, const Vector3& velocity);
/// True where a ball that goes straight from one point to another, and touches at neither, meets the shape in between.
bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius);

}  // namespace flexarm
