#pragma once
/// Interface for objects that follow a run from one solved sub-step to the next.

namespace flexarm {

struct State;
class StepSystem;

/// Is told what a Stepper does to its state. It must not change the state.
class StepFollower {
 public:
  virtual ~StepFollower() = default;
  /// A step of the run begins, or has ended after `duration` [s].
  virtual void begin_step() = 0;
  virtual void end_step(double duration) = 0;
  /// Sub-steps after keep() may be undone by take_back(), if they belong to a composed scheme.
  virtual void keep() = 0;
  virtual void take_back() = 0;
  /// The equations of a sub-step that begins at `state` are solved; the solution will be accepted.
  virtual void follow(const State& state, const StepSystem& solved) = 0;
};

}  // namespace flexarm
