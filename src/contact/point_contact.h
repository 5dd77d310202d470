#pragma once
/// Contact of a ball (or a corner, with radius 0) with a shape. All vectors are in the frame of the body to which the
/// shape is fixed. (docs/notes/contact.md)

#include "contact/contact_law.h"
#include "contact/shape.h"

namespace flexarm {

/// The change of a signed distance between two points. `gradient` times the displacement is exactly the change: it is
/// Gonzalez' discrete gradient. For forces at an instant it is the gradient at the end.
struct GapChange {
  double begin, end;  ///< distances, < 0 inside [m]
  Vector3 gradient;
  Matrix3 slope;         ///< derivative of `gradient` with respect to the point at the end
  Vector3 end_gradient;  ///< gradient of the distance at the end
};
GapChange gap_change(const ContactShape& shape, const Vector3& from, const Vector3& to, bool at_end);

/// The motion of the ball relative to the shape over a step. Of a rim, the lowest point touches (see rim.h). It has the
/// offset from the middle, which is zero for balls, and the face in question is chosen before.
struct PointMotion {
  Vector3 begin, end;                                                    ///< positions of the middle [m]
  Vector3 begin_offset = Vector3::Zero(), end_offset = Vector3::Zero();  ///< [m]
  /// Of a segment the point is fixed over a step, and the nearest one is nearer than this by an excess. Its change is
  /// spread over displacements and, by `lever`, over rotations. [m]
  double begin_excess = 0, end_excess = 0, lever = 0;
  int face = 0;                              ///< the only one by which the point may enter; 0: any
  Vector3 turn;                              ///< rotation of the ball minus that of the body, tangent-scaled, mean axes
  Vector3 begin_velocity = Vector3::Zero();  ///< of the ball's middle, or of the point, at the beginning [m/s]
  double duration = 0;                       ///< [s]; 0: an equilibrium
  Matrix3 outwards = Matrix3::Zero();        ///< for a corner, see ContactPoint; at the beginning
  bool at_end = false;                       ///< forces are those at the end; else means over the step, with exact work

  Vector3 begin_point() const { return begin + begin_offset; }
  Vector3 end_point() const { return end + end_offset; }
  double end_weight() const { return at_end ? 1 : 0.5; }
  Vector3 offset() const { return end_weight() * end_offset + (1 - end_weight()) * begin_offset; }
};
/// What the contact of one point and one shape remembers from step to step. All numbers are zero without contact.
struct PointMemory {
  static constexpr int kSize = 11;
  double speed = 0;                   ///< see remembered_speed()
  Vector3 stretch = Vector3::Zero();  ///< of friction, see ContactGrip [m]
  int face = 0;                       ///< face by which a corner has entered; 0: none
  double within = 0;                  ///< depth below that face from which on forces begin [m]
  double start = 0;                   ///< offset of the penetration, see let_out() [m]
  Vector3 turned = Vector3::Zero();   ///< stretch of the resistance to turning, see turn_grip() [rad]
  double root = 0;                    ///< of the hardening of the grips, see grip_root(); 0: not known yet
};
/// The forces on the ball: a force through its middle and a couple, conjugate to the displacement and to the rotation.
/// The wrench is NaN at an instant with too deep a penetration.
struct PointAction {
  Vector6 wrench = Vector6::Zero();
  Matrix6 slope = Matrix6::Zero();  ///< derivative with respect to {end, turn} of PointMotion
  Eigen::Matrix<double, 6, 3> by_offset = Eigen::Matrix<double, 6, 3>::Zero();  ///< to PointMotion::end_offset
  Eigen::Matrix<double, 6, 3> by_begin = Eigen::Matrix<double, 6, 3>::Zero();   ///< to begin, of friction
  Vector6 by_excess = Vector6::Zero();                                          ///< to PointMotion::end_excess
  Vector3 normal = Vector3::Zero();                                             ///< gradient of the gap at the end
  double push = 0, push_slope = 0;  ///< normal force [N], and its derivative with respect to the penetration at the end
  PointMemory memory;               ///< at the end of the step
  double dissipated = 0;            ///< over the step [J]
  double work = 0;                  ///< done by the decay of the offset, see let_out() [J]
  bool acts = false;                ///< the ball and the shape touch in the step
};
/// Computes the forces. `whole`: the shape with all its faces; `radius`: of the ball [m].
PointAction point_action(const ContactShape& whole, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope);

/// The forces on the ball at an instant, at the point of its surface that touches.
struct PointTouch {
  double gap = 0;                                                ///< < 0 inside [m]
  Vector3 normal;                                                ///< unit vector, outwards from the shape
  double push = 0;                                               ///< along the normal [N]
  Vector3 friction = Vector3::Zero(), couple = Vector3::Zero();  ///< [N, N m]
};
/// Computes the forces at an instant. `point`, `velocity`: of the ball's middle; `memory`: at the end of the last step.
PointTouch point_touch(const ContactShape& whole, const ContactLaw& law, double radius, const Vector3& point,
                       const Vector3& velocity, const PointMemory& memory);

/// The shape that acts on a point over a step: the whole shape, or the half-space below one face.
struct FeltShape {
  ContactShape shape;
  int face = 0;         ///< 0: the whole shape
  double radius = 0;    ///< forces begin at this distance, minus `start`; < 0 with PointMemory::within [m]
  double start = 0;     ///< offset of the penetration, see let_out() [m]
  bool is_felt = true;  ///< false: they cannot touch in this step
  double let_go = 0;    ///< stored energy that is lost because the point has left its face sideways [J]
};
FeltShape felt_shape(const ContactShape& shape, const ContactLaw& law, double radius, const PointMotion& motion,
                     const PointMemory& memory);
/// Returns the memory of a point that is inside the shape in an initial state. `face`: see PointMotion.
PointMemory start_inside(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                         const Matrix3& outwards, int face = 0);
/// Returns the stored energy [J].
double stored_energy(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                     const PointMemory& memory);

/// Whether a ball that moves straight from one point to another, and touches at neither, hits the shape in between.
bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius);

}  // namespace flexarm
