#pragma once
/// Data and state of the actuator of a scalar coordinate: a spring, a motor with its gear, a controller. All angles,
/// speeds and efforts of a motor are given at the joint: the rotor's angle is divided by the gear ratio, the motor's
/// effort is multiplied by it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"

namespace flexarm {

/// A spring and damper with play, which acts on a twist x. It deflects only where |x| exceeds half of the play.
struct Elasticity {
  double stiffness = 0;  ///< [N m/rad or N/m]
  double damping = 0;    ///< [N m s/rad or N s/m]
  double backlash = 0;   ///< the whole play [rad or m]
};

/// A spring on a coordinate.
struct JointSpring {
  Elasticity elasticity;
  double rest = 0;  ///< position at which the spring is slack [rad or m]
};

/// The motor of a coordinate. Its rotor turns with the coordinate or, behind an elastic gear, has an angle of its own.
struct Drive {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double inertia = 0;                 ///< of the rotor, times the square of the gear ratio [kg m^2 or kg]
  std::optional<Elasticity> gear;     ///< empty: rigid
  double friction = 0;                ///< of a rotor behind an elastic gear; else see Coordinate::friction [N m or N]
  bool sticks = false;                ///< set-valued Coulomb law; else smooth
  double loss = 0;                    ///< friction per transmitted effort: 1 / efficiency - 1 [-]
  double effort_limit = kInfinity;    ///< of the motor at standstill [N m or N]
  double velocity_limit = kInfinity;  ///< no-load speed, up to which the effort falls linearly [rad/s or m/s]
};

/// A control law. Its effort is
///   proportional e + derivative de/dt + integral (int e dt) + feedforward.
/// In mode Position, e is the set point minus the measured position. In mode Velocity, e is the time integral of the
/// velocity error. In mode Effort, the effort is set point + feedforward.
struct ServoLaw {
  ServoMode mode = ServoMode::Position;
  double proportional = 0, derivative = 0, integral = 0;
  double tracking_time = 0;  ///< time constant with which the integral follows a saturated effort [s]; 0: none
};

/// Controller of a coordinate, which commands the effort of its motor. Its effort is cut at `effort_limit`.
struct Servo {
  std::vector<ServoLaw> laws;            ///< the first one acts at the start; programs may switch to the others
  int set_point = -1, feedforward = -1;  ///< indices into Model::histories; -1: none
  double start = 0;                      ///< set point if there is no history
  double effort_limit = Drive::kInfinity;
  bool on_link = false;    ///< measures the coordinate; else the rotor
  double sample_time = 0;  ///< [s]; 0: continuous
  double delay = 0;        ///< from a sample to its effect [s]
};

/// Whether steps of this length end at every sample. `sample_time` 0: there are no samples, so the answer is yes. [s]
inline bool hits_samples(double step, double sample_time) {
  const double steps = std::round(sample_time / step);
  return sample_time == 0 || (steps >= 1 && std::abs(sample_time - steps * step) <= 1e-9 * sample_time);
}

/// Data for the gyroscopic effect of a rotor, whose axis turns with the parent link.
struct Gyroscope {
  int node = -1;                   ///< node that carries the rotor
  Vector3 axis = Vector3::Zero();  ///< unit vector in the node's frame
  double inertia = 0;              ///< about the axis [kg m^2]
  double ratio = 1;                ///< rotor's angle per position of the coordinate
};

struct Actuator {
  int coordinate = -1;  ///< index into Model::coordinates
  std::optional<JointSpring> spring;
  Drive drive;  ///< default: no motor data, so efforts act directly on the coordinate
  std::optional<Servo> servo;
  std::optional<Gyroscope> gyroscope;
};

/// Commands of programs to a controller.
struct ServoCommand {
  double set_point = std::numeric_limits<double>::quiet_NaN();  ///< commanded; NaN if no command is in force
  // The set point moves until `set_time` [s], where it has this rate and acceleration. Then it is constant.
  double set_rate = 0, set_acceleration = 0, set_time = 0;
  double law = 0;  ///< index of the law in force in Servo::laws; not 0 only under a command
  double off = 0;  ///< 1 if the controller is switched off, so that the motor gives no effort; else 0

  double set_point_at(double time) const {
    const double ahead = std::min(time - set_time, 0.0);
    return set_point + ahead * (set_rate + 0.5 * ahead * set_acceleration);
  }
  /// Rate of the set point; 0 if it has been constant for longer than `tolerance` [s].
  double set_rate_at(double time, double tolerance) const {
    const double ahead = time - set_time;
    return ahead <= tolerance ? set_rate + set_acceleration * std::min(ahead, 0.0) : 0;
  }
};

/// The state of a controller.
struct ServoState : ServoCommand {
  double integral = 0;      ///< of e of ServoLaw; in mode Velocity, e itself [s times the error's unit]
  double average = 0;       ///< moving average of the increments of e; damps stiff gains
  double delayed_rate = 0;  ///< negative rate of the measured quantity, low-pass filtered; damps stiff gains
  // Sampled controllers:
  double samples = 0;           ///< number of samples taken
  double measured = 0;          ///< position in the last sample
  std::vector<double> outputs;  ///< efforts of the last samples, newest first [N m or N]
};

inline const ServoLaw& law_of(const Servo& servo, const ServoState& state) {
  return servo.laws[static_cast<std::size_t>(state.law)];
}

/// The state of an actuator.
struct ActuatorState {
  double angle = 0;         ///< of the rotor [rad or m]
  double rate = 0;          ///< of the rotor [rad/s or m/s]; with a Gyroscope: axial momentum / inertia
  double acceleration = 0;  ///< of the rotor; Newmark family only
  double rest = 0;          ///< 1 if dry friction stopped the rotor in the last step, else 0
  ServoState servo;
};

}  // namespace flexarm
