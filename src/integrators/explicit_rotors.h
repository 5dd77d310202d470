#pragma once
/// Rotors behind elastic gears at the instants of a step of an explicit scheme. (docs/notes/explicit.md 5)

#include <vector>

#include "joints/articulated_bodies.h"
#include "model/model.h"
#include "model/state.h"

namespace flexarm {

/// Each rotor has two unknowns: its angle, and its rate; with an axis (Gyroscope) the rate is axial momentum / inertia,
/// as in ActuatorState. Allocates no memory after construction.
class ExplicitRotors {
 public:
  struct Motion {
    double angle = 0, rate = 0;  ///< rate: of the angle
  };

  explicit ExplicitRotors(const Model& model);

  /// Number of unknowns of all rotors.
  std::size_t size() const { return 2 * actuators_.size(); }
  /// Place of an actuator's rotor among the unknowns; -1: it turns with its coordinate.
  int place(std::size_t actuator) const { return places_[actuator]; }
  void pack(const State& state, double* unknowns) const;
  /// Whether the unknowns are those of the state.
  bool are_those_of(const State& state, const double* unknowns) const;

  /// The motion of an actuator's rotor. `link`: that of its coordinate, which the rotor follows if its gear is rigid.
  Motion motion(std::size_t actuator, const double* unknowns, const Motion& link,
                const ArticulatedBodies& bodies) const;
  /// Returns the effort of an elastic gear on its coordinate, if the motor gives the effort `motor`. Sets the
  /// derivatives of the rotor's unknowns, adds what is dissipated to `dissipated` [W], and the moment of a Gyroscope to
  /// the bodies.
  double act(std::size_t actuator, double motor, const Motion& rotor, const Motion& link, const double* unknowns,
             double* changes, double& dissipated, ArticulatedBodies& bodies);
  /// Adds the moments of gyroscopes again, as act() added them last.
  void add_moments(ArticulatedBodies& bodies) const;
  /// Changes the rate of an actuator's rotor by an impulse of its motor [N m s or N s], and adds the moment on its
  /// carrier to the bodies.
  void strike(std::size_t actuator, double impulse, double* unknowns, ArticulatedBodies& bodies) const;

 private:
  const Model& model_;
  std::vector<int> actuators_, places_;
  std::vector<Vector3> moments_;  // per rotor: on its carrier, world axes [N m]
};

}  // namespace flexarm
