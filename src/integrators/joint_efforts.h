#pragma once
/// All efforts on joint coordinates over a step, except passive ones such as damping.

#include <vector>

#include "integrators/held_efforts.h"
#include "integrators/step_configuration.h"
#include "integrators/step_histories.h"

namespace flexarm {

/// Whether a motor transforms the effort of the scene or of a command before it acts on the coordinate.
inline bool has_motor(const Coordinate& coordinate) {
  return coordinate.actuator >= 0 && coordinate.motion < 0;
}

/// One effort per coordinate, from its source: the scene, a command, a motor, or what drives a prescribed coordinate.
/// This class alone computes the work of efforts and writes them into the state.
class JointEfforts {
 public:
  JointEfforts(const StepConfiguration& configuration, const StepHistories& histories);

  /// Starts a step: sets the efforts of the scene and of commands. Motors may replace them later.
  void begin();
  const StepForce& of(std::size_t coordinate) const { return efforts_[coordinate]; }
  /// Sets the total effort of a coordinate's motor over the step and at its end. `way`: increment of its rotor.
  void set_motor(std::size_t coordinate, double acting, double at_end, double way);
  /// Computes the efforts that drove prescribed coordinates, from the residual after the step. Adds them to `drives`.
  void find_drives(const ReducedResidual& residual, HeldEfforts& held, StepMeans& drives);
  /// Adds the work of all efforts over the step to `work` [J].
  void add_work(double& work) const;
  void accept(State& state) const;

 private:
  /// Mean over the step of an effort of which only the values at both ends are known: it is assumed to change linearly.
  double mean_of_ends(std::size_t coordinate, double at_end) const;

  const StepConfiguration& configuration_;
  const StepHistories& histories_;
  std::vector<StepForce> efforts_;  // per coordinate
  std::vector<double> motor_ways_;  // per actuator
};

}  // namespace flexarm
