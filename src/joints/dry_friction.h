#pragma once
/// Dry friction: Coulomb's set-valued law over a step, and the normal force in a joint. (beyond.md 3)

#include "flexarm/math/pose.h"

namespace flexarm {

/// Coulomb's law for the increment x of one coordinate over a step. The friction effort against x is a staircase
/// function of x. This is a maximal monotone graph: there is exactly one solution whatever other efforts act, and x
/// times the effort is never negative.
///
/// Let F be the largest friction effort (capacity), and x_r the increment with which the coordinate is at rest at the
/// end of the step. For x_r > 0, the effort is
///   -F  for x < 0,    [-F, 0]  at x = 0,    0  for 0 < x < x_r,    [0, F]  at x = x_r,    F  for x > x_r;
/// for x_r < 0 it is mirrored. If the coordinate is at rest at the beginning, x_r = 0 and the law is F Sign(x). The
/// coordinate sticks if x = 0. If x = x_r, it stops, with an effort that takes exactly the remaining kinetic energy.
/// With the law F Sign(x) alone, a conserving scheme would stop with x = 0 and keep all this energy, and its velocities
/// would alternate for ever.
///
/// The solver revises the branch between iterations. On each branch, either the effort or the increment is known.
class StickSlip {
 public:
  /// The branches of the staircase, in the order of increasing x.
  enum Branch { SlipBack, HeldLow, Free, HeldHigh, SlipForth };

  /// Starts a step. `rest_increment`: x_r. `rate`: at the beginning; the first branch assumes that its sign stays.
  void begin(double rest_increment, double rate);
  /// Corrects the branch, given the increment and the effort against it that the present branch has led to. Returns
  /// whether the branch has changed. `slack`: by how much an effort may exceed the capacity, relative to the capacity.
  bool revise(double increment, double effort, double capacity, double slack);

  Branch branch() const { return branch_; }
  void take_branch(Branch branch) { branch_ = branch; }
  /// Makes the coordinate come to rest at the end of the step, whatever effort that needs.
  void take_rest() {
    low_ = high_ = rest_increment_;
    branch_ = HeldLow;
  }
  /// Returns the friction effort against the increment, divided by the capacity, on a branch that determines it.
  int direction() const { return branch_ == SlipForth ? 1 : branch_ == SlipBack ? -1 : 0; }
  /// Whether the branch determines the increment, and not the effort.
  bool is_held() const { return branch_ == HeldLow || branch_ == HeldHigh; }
  double held_increment() const { return branch_ == HeldLow ? low_ : high_; }
  /// Whether the branch determines the increment such that the coordinate is at rest at the end of the step.
  bool is_stopped() const { return is_held() && held_increment() == rest_increment_; }

 private:
  double low_ = 0, high_ = 0, rest_increment_ = 0;
  Branch branch_ = HeldLow;
};

/// Which part of a joint's force is the normal force of a coordinate's friction.
enum class Contact {
  Travel,  ///< translation: the part normal to its direction
  Turn,    ///< rotation: the part normal to its axis
  Both     ///< coupled motion, as in a thread or in teeth: the whole force
};

/// The normal force in a joint, and terms of its variation.
struct NormalForce {
  double magnitude = 0;                 ///< [N]
  Vector3 direction = Vector3::Zero();  ///< d(magnitude)/d(joint's force), a unit vector; zero without force
  /// At constant force, d(magnitude) = along * d(column . arm), with the coordinate's column of the joint's map.
  double along = 0;
  Vector6 arm = Vector6::Zero();
};
/// Returns the normal force. `column`: the coordinate's column {translation, rotation} of the joint's map; `force`: the
/// joint's force on the slave [N].
NormalForce normal_force(Contact contact, const Vector6& column, const Vector3& force);

}  // namespace flexarm
