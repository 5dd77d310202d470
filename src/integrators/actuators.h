#pragma once
/// Springs, motors, gears and servos on joint coordinates over a step.

#include <vector>

#include "integrators/balance.h"
#include "integrators/joint_efforts.h"
#include "integrators/step_configuration.h"
#include "integrators/step_events.h"
#include "integrators/step_histories.h"
#include "joints/motor_step.h"
#include "joints/servo_step.h"

namespace flexarm {

/// The part of a step for all coordinates that have an Actuator. On these coordinates it applies the efforts in place
/// of JointFold. The angles of rotors behind elastic gears are no unknowns of the step: each evaluation solves for
/// them.
class Actuators {
 public:
  /// @throws ModelError if the scheme is of the Newmark family and a rotor has a gyroscopic effect, or if the scheme
  /// has backward sub-steps and there is a sampled servo or dry friction of a motor that sticks.
  Actuators(StepConfiguration& configuration, const StepHistories& histories, JointEfforts& efforts);

  /// For equilibria: from now on, keeps rotors behind elastic gears at their angles in the state.
  void hold_rotors() { holds_rotors_ = true; }
  void begin();
  /// Adds the efforts to the balance. To be called before the joints fold their slaves.
  void evaluate(Balance& balance);
  /// Adds the gyroscopic coupling between a joint's coordinate and the joint's master. To be called after evaluate().
  void add_gyroscope(int joint, FoldMaps& maps) const;
  /// Writes the new states of rotors and servos.
  void accept(State& state) const;
  /// Notes when a gear enters or leaves its play, when dry friction stops a rotor or changes its direction, and when a
  /// motor reaches or leaves its limits.
  void note_events(FirstEvent& first);
  /// As SmoothReversals::turn_too_fast(), for the smooth friction of rotors and the losses of gears.
  bool turn_too_fast(double refinement) const;
  /// In an equilibrium: moves the effort that servos give in proportion to their errors into their integrals. Returns
  /// the largest of these errors [rad or m].
  double hand_to_integrals(State& state) const;
  /// Stiffness with which an actuator's motor acts on its coordinate, at the last evaluation [N m/rad or N/m].
  double stiffness(std::size_t actuator) const { return -parts_[actuator].action.slope; }
  /// Total effort of gear and motor on the rotor, at the last evaluation [N m or N].
  double effort_on_rotor(std::size_t actuator) const {
    return parts_[actuator].action.motor - parts_[actuator].action.effort;
  }
  /// Whether the motor gave less effort than demanded at the last evaluation.
  bool is_cut(std::size_t actuator) const { return parts_[actuator].action.motor != parts_[actuator].action.demand; }

 private:
  /// Data of one actuator in this step.
  struct Part {
    RotorStep rotor;
    ServoInput input;
    ServoState servo;  // of a sampled servo, after the sample at the beginning of the step
    MotorDemand demand;
    // ---- at the last evaluation
    MotorAction action;
    double link = 0;             // increment of the coordinate
    double carried = 0;          // rotation of a gyroscope's carrier about the rotor axis, divided by the gear ratio
    double load_by_carried = 0;  // derivative of the rotor's inertial effort with respect to `carried`
    // Derivative of `carried` with respect to the carrier's spin; of the carrier's moment with respect to `link`.
    Vector3 carried_by_spin, moment_by_link;
  };
  RotorStep rotor_step(const Actuator& actuator, const ActuatorState& state) const;
  /// Computes the rotation of a gyroscope's carrier about the rotor axis.
  void turn_carrier(const Gyroscope& gyroscope, Part& part) const;
  /// Adds the gyroscope's moment on its carrier to the balance.
  void add_moment(const Gyroscope& gyroscope, const ActuatorState& state, Part& part, Balance& balance) const;
  void check(const Actuator& actuator) const;
  ServoInput servo_input(const Actuator& actuator, const Part& part, const ActuatorState& state) const;
  SetPoint set_point(const Servo& servo, const ServoState& state) const;
  SetPoint commanded_set_point(const ServoState& state) const;
  double rate_of_command(const ServoState& state, double time) const;
  /// The output of a sampled servo over the step. `before`, `now`: its memory before and after the sample that may be
  /// due at the beginning.
  StepForce held_effort(const Servo& servo, const ServoState& before, const ServoState& now) const;
  /// Adds the servo's demand to that of the motor.
  void ask(const Actuator& actuator, const ActuatorState& state, Part& part) const;
  void note_play(std::size_t index, FirstEvent& first);
  void note_limits(std::size_t index, FirstEvent& first) const;
  /// Effort that is demanded from the motor.
  double demand_at(std::size_t index, int end) const;
  void set_point_at(const Servo& servo, const ServoState& state, int end, ServoInstant& at) const;
  PassiveEffort spring_effort(const JointSpring& spring, const CoordinateStep& link) const;

  StepConfiguration& configuration_;
  const StepHistories& histories_;
  JointEfforts& efforts_;
  std::vector<Part> parts_;        // per actuator
  std::vector<int> gyroscope_of_;  // per joint: the actuator with a gyroscope on it, or -1
  bool holds_rotors_ = false;
};

}  // namespace flexarm
