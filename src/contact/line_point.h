#pragma once
/// The contact forces between a ball and a tube around a line, over a step, in world axes. (docs/notes/contact.md 1.3)

#include "contact/contact_law.h"

namespace flexarm {

/// The relative motion of the ball and a place of the line over a step. The place is the same at both ends of the step.
struct LineMotion {
  Vector3 begin, end;                   ///< from that place of the line to the ball's middle [m]
  double begin_distance, end_distance;  ///< of the ball's middle from the nearest place of the line [m]
  Vector3 turn, line_turn;              ///< rotations of the ball and of the line at that place, tangent-scaled
  double begin_rate = 0;                ///< rate of the penetration at the beginning [m/s]
  double duration = 0;                  ///< [s]; 0: an equilibrium
  bool at_end = false;                  ///< forces are those at the end; else means over the step, with exact work
};
/// What a contact remembers from step to step. All numbers are zero without contact.
struct LineMemory {
  static constexpr int kSize = 7;
  double speed = 0;                   ///< see remembered_speed()
  Vector3 stretch = Vector3::Zero();  ///< of friction, see ContactGrip; in world axes, rotates with the line [m]
  double stiffening = 0;              ///< factor of the law's stiffnesses, constant during a contact; 0: not set yet
  double start = 0;                   ///< offset of the penetration, see let_out() [m]
  double root = 0;                    ///< of the hardening of the grip, see grip_root(); 0: not known yet
};
/// The forces on the ball: a force through its middle and a couple. The opposite wrench acts on the line, about the
/// same middle. For forces at an instant, the wrench has only friction; `push` then acts along the normal, on the
/// nearest place of the line. The wrench is NaN at an instant with too deep a penetration.
struct LineAction {
  Vector6 wrench = Vector6::Zero();
  using Columns = Eigen::Matrix<double, 6, 3>;
  /// Derivatives of the wrench with respect to members of LineMotion: end, turn, line_turn, end_distance.
  Columns by_end = Columns::Zero(), by_turn = Columns::Zero(), by_line_turn = Columns::Zero();
  Vector6 by_distance = Vector6::Zero();
  ContactPush push;
  LineMemory memory;      ///< at the end of the step
  double dissipated = 0;  ///< over the step [J]
  double work = 0;        ///< done by the decay of the offset, see let_out() [J]
  bool acts = false;      ///< the ball and the tube touch in the step
};
/// The radius of the ball, and the sum of the radii of ball and tube [m].
struct LineRadii {
  double ball, sum;
};
LineAction line_action(const ContactLaw& law, const LineRadii& radii, const LineMotion& motion,
                       const LineMemory& memory, bool with_slope);

}  // namespace flexarm
