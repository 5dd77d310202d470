#pragma once
/// Dry friction: Coulomb's set-valued law over a step, and the force that presses on a joint. (beyond.md 3)

#include "flexarm/math/pose.h"

namespace flexarm {

/// Coulomb's law for the increment x of one coordinate over a step: the effort against it is a staircase in x, a
/// maximal monotone graph, so that there is one solution whatever else acts, and x times effort is never negative.
///
/// With the capacity F and the increment x_r with which the coordinate comes to rest at the end of the step, x_r > 0:
///   -F  for x < 0,    [-F, 0]  at x = 0,    0  for 0 < x < x_r,    [0, F]  at x = x_r,    F  for x > x_r;
/// mirrored for x_r < 0, and the plain law F Sign(x) where the coordinate rests at the beginning, x_r = 0. At x = 0 it
/// sticks. At x = x_r it stops, with an effort that takes exactly the kinetic energy left. The law F Sign(x) alone
/// would let conserving schemes come to a halt with x = 0, hence with all that energy, and velocities that ring for
/// ever.
///
/// The branch is revised between Newton's iterations; a branch is either an effort or an increment that is known.
class StickSlip {
 public:
  /// Along the staircase.
  enum Branch { SlipBack, HeldLow, Free, HeldHigh, SlipForth };

  /// `rest_increment`: x_r; the coordinate is expected to go on as its `rate` at the beginning says.
  void begin(double rest_increment, double rate);
  /// Corrects the branch for the increment and the effort against it that it has led to; true if it was another one.
  /// `slack`: relative to the capacity, by which an effort may exceed it.
  bool revise(double increment, double effort, double capacity, double slack);

  Branch branch() const { return branch_; }
  void take_branch(Branch branch) { branch_ = branch; }
  /// It comes to rest, however much that takes.
  void take_rest() {
    low_ = high_ = rest_increment_;
    branch_ = HeldLow;
  }
  /// Of the effort against the increment where the branch gives it, per capacity.
  int direction() const { return branch_ == SlipForth ? 1 : branch_ == SlipBack ? -1 : 0; }
  /// True where the branch gives the increment instead.
  bool is_held() const { return branch_ == HeldLow || branch_ == HeldHigh; }
  double held_increment() const { return branch_ == HeldLow ? low_ : high_; }
  /// Held, and at rest at the end of the step.
  bool is_stopped() const { return is_held() && held_increment() == rest_increment_; }

 private:
  double low_ = 0, high_ = 0, rest_increment_ = 0;
  Branch branch_ = HeldLow;
};

/// Along what a coordinate moves.
enum class Contact {
  Travel,  ///< forces across it press
  Turn,    ///< forces across the axis press
  Both     ///< coupled, as in a thread or in teeth: the whole force presses
};

/// The force that presses in a joint, and what its variation needs.
struct NormalForce {
  double magnitude = 0;                 ///< [N]
  Vector3 direction = Vector3::Zero();  ///< its derivative with respect to the joint's force; zero without force
  /// d(magnitude) at constant force = along * d(column . arm), column being the coordinate's.
  double along = 0;
  Vector6 arm = Vector6::Zero();
};
/// `column`: of the coordinate in the joint's map, {translation, rotation}; `force`: on the slave.
NormalForce normal_force(Contact contact, const Vector6& column, const Vector3& force);

}  // namespace flexarm
