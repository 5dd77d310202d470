#pragma once
/// What acts on a scalar coordinate besides plain efforts: a spring, a motor with its gear, a controller. Efforts,
/// angles and speeds of a motor are those at the joint: its angles divided by the gear ratio, its efforts multiplied by
/// it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/model/results.h"

namespace flexarm {

/// An elastic element of the twist x: it feels what of x is beyond a play, a half of which is on either side.
struct Elasticity {
  double stiffness = 0;  ///< [N m/rad or N/m]
  double damping = 0;    ///< [N m s/rad or N s/m]
  double backlash = 0;   ///< the whole play [rad or m]
};

/// A spring between a coordinate and the position at which it is slack.
struct JointSpring {
  Elasticity elasticity;
  double rest = 0;  ///< [rad or m]
};

/// The motor of a coordinate. Its rotor turns with the coordinate or, behind an elastic gear, by an angle of its own.
struct Drive {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double inertia = 0;                 ///< of the rotor, times the square of the gear's ratio [kg m^2 or kg]
  std::optional<Elasticity> gear;     ///< empty: rigid
  double friction = 0;                ///< of the rotor, behind an elastic gear; else it is the coordinate's [N m or N]
  bool sticks = false;                ///< set-valued Coulomb law; else smooth
  double loss = 0;                    ///< of what the gear transmits, as friction: 1 / efficiency - 1 [-]
  double effort_limit = kInfinity;    ///< of the motor, when it stands still [N m or N]
  double velocity_limit = kInfinity;  ///< its no-load speed, up to which it loses its effort in proportion
};

/// What a controller makes of the error e between the set point and what is measured: the effort
///   proportional e + derivative de/dt + integral (int e dt) + feedforward,
/// where e of a velocity is the integral of its error. With ServoMode::Effort the set point is the effort.
struct ServoLaw {
  ServoMode mode = ServoMode::Position;
  double proportional = 0, derivative = 0, integral = 0;
  double tracking_time = 0;  ///< in which the integral follows a saturated effort [s]; 0: it does not
};

/// Controller of a coordinate over a motor. Its effort is cut at its limit.
struct Servo {
  std::vector<ServoLaw> laws;            ///< the first is that of the start; the others are there to be switched to
  int set_point = -1, feedforward = -1;  ///< histories; -1: none
  double start = 0;                      ///< set point where there is no history
  double effort_limit = Drive::kInfinity;
  bool on_link = false;    ///< measures the coordinate, else the rotor
  double sample_time = 0;  ///< [s]; 0: continuous
  double delay = 0;        ///< [s]
};

/// Steps of that length hit all samples; `sample_time` 0: there are none [s].
inline bool hits_samples(double step, double sample_time) {
  const double steps = std::round(sample_time / step);
  return sample_time == 0 || (steps >= 1 && std::abs(sample_time - steps * step) <= 1e-9 * sample_time);
}

/// Of a rotor whose axis is carried round by the parent link.
struct Gyroscope {
  int node = -1;                   ///< that carries it
  Vector3 axis = Vector3::Zero();  ///< unit, in the node's frame
  double inertia = 0;              ///< about the axis [kg m^2]
  double ratio = 1;                ///< rotor's angle per position of the coordinate
};

struct Actuator {
  int coordinate = -1;  ///< index into Model::coordinates
  std::optional<JointSpring> spring;
  Drive drive;  ///< the default: none, efforts act on the coordinate
  std::optional<Servo> servo;
  std::optional<Gyroscope> gyroscope;
};

/// What programs tell a controller.
struct ServoCommand {
  double set_point = std::numeric_limits<double>::quiet_NaN();  ///< commanded; NaN where no command holds
  // Until `set_time` [s] it moves, arriving with this rate and acceleration; then it stays.
  double set_rate = 0, set_acceleration = 0, set_time = 0;
  double law = 0;  ///< in force, of Servo::laws; another one than the first only under a command
  double off = 0;  ///< 1 where it is switched off: the motor gives nothing; else 0

  double set_point_at(double time) const {
    const double ahead = std::min(time - set_time, 0.0);
    return set_point + ahead * (set_rate + 0.5 * ahead * set_acceleration);
  }
  /// 0 where it has arrived, longer than `tolerance` ago [s].
  double set_rate_at(double time, double tolerance) const {
    const double ahead = time - set_time;
    return ahead <= tolerance ? set_rate + set_acceleration * std::min(ahead, 0.0) : 0;
  }
};

/// What time changes of a controller.
struct ServoState : ServoCommand {
  double integral = 0;      ///< of the error, or with ServoMode::Velocity the error itself [s times the error]
  double average = 0;       ///< of past increments of the error, which damps stiff gains
  double delayed_rate = 0;  ///< what follows the rate of what is measured, backwards, the same
  // Sampled controllers:
  double samples = 0;           ///< taken
  double measured = 0;          ///< in the last sample
  std::vector<double> outputs;  ///< of the last samples, newest first [N m or N]
};

inline const ServoLaw& law_of(const Servo& servo, const ServoState& state) {
  return servo.laws[static_cast<std::size_t>(state.law)];
}

/// What time changes of an actuator.
struct ActuatorState {
  double angle = 0;         ///< of the rotor [rad or m]
  double rate = 0;          ///< [rad/s or m/s]; of a gyroscope's rotor: its momentum over the inertia
  double acceleration = 0;  ///< Newmark family only
  double rest = 0;          ///< 1 where dry friction stopped the rotor in the last step, else 0
  ServoState servo;
};

}  // namespace flexarm
