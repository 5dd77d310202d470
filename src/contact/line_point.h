#pragma once
/// What a ball does that touches a tube along a line, over a step. World axes. (docs/notes/contact.md 1.3)

#include "contact/contact_law.h"

namespace flexarm {

/// Over a step. The line's weights are those of one place of it, the same at both ends of the step.
struct LineMotion {
  Vector3 begin, end;                   ///< from that place of the line to the ball's middle [m]
  double begin_distance, end_distance;  ///< of the middle from what is nearest of the line [m]
  Vector3 turn, line_turn;              ///< of the ball, and of the line there, tangent-scaled
  double begin_rate = 0;                ///< of the penetration, at the beginning [m/s]
  double duration = 0;                  ///< [s]; 0: an equilibrium
  bool at_end = false;                  ///< what acts at the end counts; else means, whose work is exact
};
/// Zero where they do not touch.
struct LineMemory {
  static constexpr int kSize = 6;
  double speed = 0;                   ///< see remembered_speed()
  Vector3 stretch = Vector3::Zero();  ///< of the grip, world axes; it turns with the line
  double stiffening = 0;              ///< of the law's stiffnesses, kept as long as it touches; 0: not yet known
  double start = 0;                   ///< so far inside nothing is felt yet, see let_out() [m]
};
/// On the ball: a force through its middle and a couple; the reverse acts on the line, through the same middle. Of an
/// instant it is the friction alone: the push goes along the normal, to where the line is nearest. Not finite at an
/// instant at which it is too deep inside.
struct LineAction {
  Vector6 wrench = Vector6::Zero();
  using Columns = Eigen::Matrix<double, 6, 3>;
  Columns by_end = Columns::Zero(), by_turn = Columns::Zero(), by_line_turn = Columns::Zero();
  Vector6 by_distance = Vector6::Zero();  ///< at the end
  ContactPush push;
  LineMemory memory;      ///< at the end of the step
  double dissipated = 0;  ///< [J]
  double work = 0;        ///< that letting out has done [J]
  bool acts = false;
};
/// `radii`: of the ball, and of the ball and the tube together [m].
struct LineRadii {
  double ball, sum;
};
LineAction line_action(const ContactLaw& law, const LineRadii& radii, const LineMotion& motion,
                       const LineMemory& memory, bool with_slope);

}  // namespace flexarm
