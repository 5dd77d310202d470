#pragma once
/// All efforts along coordinates over a step except passive ones.

#include <vector>

#include "integrators/held_efforts.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"

namespace flexarm {

/// Its effort is what a motor makes of that of the scene or of a command.
inline bool has_motor(const Coordinate& coordinate) {
  return coordinate.actuator >= 0 && coordinate.motion < 0;
}

/// One effort for each coordinate, whoever makes it: the scene or a command, a motor, or what drives a prescribed
/// coordinate. Their work and what the state keeps of them are made here alone.
class JointEfforts {
 public:
  JointEfforts(const StepConfiguration& configuration, const StepHistories& histories);

  /// Those of the scene and of commands, in which motors have a part.
  void begin();
  const StepForce& of(std::size_t coordinate) const { return efforts_[coordinate]; }
  /// What the motor of a coordinate does in all over the step, and at its end; it works along `way`, its rotor's.
  void set_motor(std::size_t coordinate, double acting, double at_end, double way);
  /// Finds what drove prescribed coordinates, from the residual as the step left it, and adds to its means over steps.
  void find_drives(const ReducedResidual& residual, HeldEfforts& held, StepMeans& drives);
  /// Adds the work of all over the step to `work` [J].
  void add_work(double& work) const;
  void accept(State& state) const;

 private:
  /// Over the step, of an effort that changes evenly to its value at the end, where only ends are known.
  double mean_of_ends(std::size_t coordinate, double at_end) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  std::vector<StepForce> efforts_;  // per coordinate
  std::vector<double> motor_ways_;  // per actuator
};

}  // namespace flexarm
