#pragma once
/// Motors with limits, and servos, at the instants of a step of an explicit scheme. (docs/notes/explicit.md 5)

#include <vector>

#include "integrators/explicit_margins.h"
#include "integrators/explicit_rotors.h"
#include "integrators/stage_derivatives.h"
#include "joints/motor_step.h"
#include "joints/servo_step.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// The motors of a model, whose rotors turn with their coordinates or, behind elastic gears, by themselves. Allocates
/// no memory after construction.
class ExplicitMotors {
 public:
  /// Sets the margins of motors with limits in `margins`, which must outlive this object.
  ExplicitMotors(const Model& model, const ExplicitTableau& tableau, ExplicitMargins& margins);

  /// Begins a step: samples set points, and takes the samples of sampled servos that are due.
  void begin(const State& state, double step);
  /// Sets the inputs of all servos at a stage, or at the end if that is the number of stages. `part`: of the step.
  /// `values`: of the model's functions of time.
  void set_instant(const State& state, std::size_t stage, double part, const std::vector<double>& values);
  /// Whether the inputs are those of the last call of keep_inputs().
  bool has_kept_inputs() const { return inputs_ == kept_inputs_; }
  void keep_inputs() { kept_inputs_ = inputs_; }

  /// The motor's effort at the instant [N m or N]. `other`: effort of the scene or of commands on its coordinate.
  /// `link`: motion of the coordinate. `integral`: of its servo. `integral_rate`: output, the derivative of the
  /// integral.
  double effort(std::size_t actuator, const State& state, double other, const ExplicitRotors::Motion& rotor,
                const ExplicitRotors::Motion& link, double integral, double& integral_rate);
  /// The impulse of the motor by what jumps of the set point, times the gain of the derivative: at the beginning
  /// of the step, or in it after that. It is zero if the motor has a limit. `weights`: of the stages. [N m s or N s]
  double first_impulse(std::size_t actuator, const State& state) const;
  double later_impulse(std::size_t actuator, const State& state, const std::vector<double>& weights) const;
  /// Writes the servo's state at the end of the step.
  void accept(std::size_t actuator, double step, const ExplicitRotors::Motion& rotor,
              const ExplicitRotors::Motion& link, double integral, ServoState& servo) const;

 private:
  /// What a servo is given from outside at an instant.
  struct Input {
    double set_point = 0, set_rate = 0, feedforward = 0;
    double held = 0;  // output of a sampled servo
    double law = 0, off = 0;
    bool operator==(const Input& other) const;
  };
  /// The scene's function for a set point whose jumps strike; null if there is none, or if it is constant.
  const TimeFunction* striking_function(std::size_t actuator, const State& state) const;
  double impulse_by(std::size_t actuator, const State& state, double from, double to, double smooth) const;
  /// Whether an actuator has a servo that moves its coordinate.
  bool has_servo(std::size_t actuator) const;
  /// Cuts an effort at the motor's limits.
  double cut(std::size_t actuator, const MotorRange& range, double demand);
  void take_sample(const Actuator& actuator, const ActuatorState& own, double link_position, ServoState& servo) const;

  const Model& model_;
  StageDerivatives derivatives_;
  double begin_ = 0, step_ = 0;  // of the step
  std::vector<bool> varies_;     // per function of time: whether it is not constant
  // Per actuator:
  std::vector<StageDerivatives::Samples> samples_;  // of set points
  std::vector<ServoState> sampled_;                 // of sampled servos, after the sample at the beginning
  std::vector<double> held_;                        // mean output of sampled servos over the step
  std::vector<double> first_;                       // set points at the beginning, after a jump there
  std::vector<Input> inputs_, kept_inputs_;
  std::vector<int> limits_;  // places among the margins
  ExplicitMargins& margins_;
};

}  // namespace flexarm
