#pragma once
/// An interface for what follows a run from one solved sub-step to the next.

namespace flexarm {

struct State;
class StepSystem;

/// Sees what a Stepper does to its state. What it does itself changes nothing there.
class StepFollower {
 public:
  virtual ~StepFollower() = default;
  /// A step of the run begins, and has ended after `duration` [s].
  virtual void begin_step() = 0;
  virtual void end_step(double duration) = 0;
  /// What follows until the next call may be taken back: sub-steps of a composed scheme.
  virtual void keep() = 0;
  virtual void take_back() = 0;
  /// The equations of a sub-step that begins at `state` are solved, and about to be accepted.
  virtual void follow(const State& state, const StepSystem& solved) = 0;
};

}  // namespace flexarm
