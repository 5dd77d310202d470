#pragma once
/// Springs, motors, gears and controllers of coordinates over a step.

#include <vector>

#include "integrators/balance.h"
#include "integrators/joint_efforts.h"
#include "integrators/step_configuration.h"
#include "integrators/step_events.h"
#include "integrators/step_histories.h"
#include "joints/motor_step.h"
#include "joints/servo_step.h"

namespace flexarm {

/// What acts on coordinates that have an Actuator: it takes the efforts over from JointFold. Rotors behind elastic
/// gears are solved for in every evaluation, and no unknowns of the step.
class Actuators {
 public:
  /// @throws ModelError if the scheme scales velocities, of which a rotor's would be left out, or steps backwards,
  /// against friction that sticks or samples.
  Actuators(StepConfiguration& configuration, const StepHistories& histories, JointEfforts& efforts);

  /// For an equilibrium: from now on rotors behind elastic gears stay where the state has them.
  void hold_rotors() { holds_rotors_ = true; }
  void begin();
  /// Before joints fold their slaves.
  void evaluate(Balance& balance);
  /// Adds what couples a joint's coordinate to its master by a rotor's gyroscopic effect; after evaluate().
  void add_gyroscope(int joint, FoldMaps& maps) const;
  /// Writes rotors and servos.
  void accept(State& state) const;
  /// Notes when gears come out of their play or into it, when dry friction stops rotors or turns its direction, and
  /// when motors come to their limits or leave them.
  void note_events(FirstEvent& first);
  /// As SmoothReversals::turn_too_fast(), of smooth friction of rotors and of losses of gears.
  bool turn_too_fast(double refinement) const;
  /// In an equilibrium: lets integrals of servos take over what their errors ask for. The largest of those errors
  /// [rad or m].
  double hand_to_integrals(State& state) const;
  /// Stiffness of an actuator's motor on its coordinate, at the last evaluation [N m/rad or N/m].
  double stiffness(std::size_t actuator) const { return -parts_[actuator].action.slope; }
  /// The sum of what gear and motor do to its rotor, at the last evaluation [N m or N].
  double effort_on_rotor(std::size_t actuator) const {
    return parts_[actuator].action.motor - parts_[actuator].action.effort;
  }
  /// The motor gives less than it was asked for at the last evaluation.
  bool is_cut(std::size_t actuator) const { return parts_[actuator].action.motor != parts_[actuator].action.demand; }

 private:
  /// Of one actuator in this step.
  struct Part {
    RotorStep rotor;
    ServoInput input;
    ServoState servo;  // of a sampled one, after the sample at the beginning of the step
    MotorDemand demand;
    // ---- at the last evaluation
    MotorAction action;
    double link = 0;                          // increment of the coordinate
    double carried = 0;                       // turn of a gyroscope's carrier about the axis, over the ratio
    double load_by_carried = 0;               // derivative of the rotor's inertial effort with respect to that
    Vector3 carried_by_spin, moment_by_link;  // its derivative, and that of the carrier's moment
  };
  RotorStep rotor_step(const Actuator& actuator, const ActuatorState& state) const;
  /// How far a gyroscope's carrier turns about the axis.
  void turn_carrier(const Gyroscope& gyroscope, Part& part) const;
  /// Adds the gyroscope's moment on its carrier.
  void add_moment(const Gyroscope& gyroscope, const ActuatorState& state, Part& part, Balance& balance) const;
  void check(const Actuator& actuator) const;
  ServoInput servo_input(const Actuator& actuator, const Part& part, const ActuatorState& state) const;
  SetPoint set_point(const Servo& servo, const ServoState& state) const;
  SetPoint commanded_set_point(const ServoState& state) const;
  double rate_of_command(const ServoState& state, double time) const;
  /// Adds what the servo asks for.
  void ask(const Actuator& actuator, const ActuatorState& state, Part& part) const;
  void note_play(std::size_t index, FirstEvent& first);
  void note_limits(std::size_t index, FirstEvent& first) const;
  /// What the motor is asked for.
  double demand_at(std::size_t index, int end) const;
  void set_point_at(const Servo& servo, const ServoState& state, int end, ServoInstant& at) const;
  PassiveEffort spring_effort(const JointSpring& spring, const CoordinateStep& link) const;

  StepConfiguration& configuration_;
  const StepHistories& histories_;
  JointEfforts& efforts_;
  std::vector<Part> parts_;        // per actuator
  std::vector<int> gyroscope_of_;  // per joint: the actuator that has one, or -1
  bool holds_rotors_ = false;
};

}  // namespace flexarm
