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
  Vector3 begin, end;                        ///< where the middle of the point's ball is [m]
  Vector3 turn;                              ///< of the ball less that of the shape's body, tangent-scaled, mean axes
  Vector3 begin_velocity = Vector3::Zero();  ///< of that middle, at the beginning [m/s]
  double duration = 0;                       ///< [s]; 0: an equilibrium
  Matrix3 outwards = Matrix3::Zero();        ///< of a corner, see ContactPoint, at the beginning
  bool at_end = false;                       ///< what acts at the end counts; else means, whose work is exact
};
/// For each point and shape, zero where they do not touch.
struct PointMemory {
  static constexpr int kSize = 10;
  double speed = 0;  ///< see remembered_speed()
  Vector3 stretch = Vector3::Zero();
  int face = 0;                      ///< by which a corner has come in
  double within = 0;                 ///< so far inside of that face nothing is felt yet [m]
  double start = 0;                  ///< nor of what has started inside, see let_out() [m]
  Vector3 turned = Vector3::Zero();  ///< see turn_grip() [rad]
};
/// On the ball: a force through its middle and a couple, conjugate to the way and to the turn. Not finite at an instant
/// at which it is too deep inside.
struct PointAction {
  Vector6 wrench = Vector6::Zero();
  Matrix6 slope = Matrix6::Zero();  ///< by {end, turn}
  PointMemory memory;               ///< at the end of the step
  double dissipated = 0;            ///< [J]
  double work = 0;                  ///< that letting out has done [J]
  bool acts = false;
};
/// `radius`: of the ball [m].
PointAction point_action(const ContactShape& whole, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope);

/// What acts on the ball at an instant, where its surface touches.
struct PointTouch {
  double gap = 0;   ///< < 0 inside [m]
  Vector3 normal;   ///< unit, outwards
  double push = 0;  ///< along it [N]
  Vector3 friction = Vector3::Zero(), couple = Vector3::Zero();
};
/// `point`, `velocity`: of the ball's middle; `memory`: as the last step has left it.
PointTouch point_touch(const ContactShape& whole, const ContactLaw& law, double radius, const Vector3& point,
                       const Vector3& velocity, const PointMemory& memory);

/// What a point feels of a shape over a step: all of it, or what is beyond one face.
struct FeltShape {
  ContactShape shape;
  int face = 0;
  double radius = 0;    ///< from which on it is felt: of a corner that came in beside its face < 0 [m]
  double start = 0;     ///< less this, of what has started inside [m]
  bool is_felt = true;  ///< false: it cannot touch
  double let_go = 0;    ///< what was stored and is lost, since the point has come beside the face that it was in [J]
};
FeltShape felt_shape(const ContactShape& shape, const ContactLaw& law, double radius, const PointMotion& motion,
                     const PointMemory& memory);
/// Of a point that has got inside without a motion.
PointMemory start_inside(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                         const Matrix3& outwards);
/// What is stored [J].
double stored_energy(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                     const PointMemory& memory);

/// True where a ball that goes straight from one point to another, and touches at neither, meets the shape in between.
bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius);

}  // namespace flexarm
