#pragma once
/// Functions that the dynamic reference tests share: runs with checks, and drifts of invariants.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kGravity = 9.81;  // m/s^2
/// Axis of hinges whose links move in the x-z plane.
const Vector3 kAcross(0, 1, 0);

inline SimulationOptions options(const std::string& scheme, double step, double tolerance = 1e-8) {
  SimulationOptions out;
  out.scheme = scheme;
  out.step = step;
  out.tolerance = tolerance;
  return out;
}

/// Makes `steps` steps, with `observe()` after each. A step that does not converge is a test failure and ends the run.
template <class Observe>
void run(Simulation& simulation, int steps, const Observe& observe) {
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.scheme() << " at t = " << simulation.time() << ": "
                                  << to_string(result.reason);
    observe();
  }
}
inline void run(Simulation& simulation, int steps) {
  run(simulation, steps, [] {});
}

inline double total_mass(const Simulation& simulation) {
  double mass = 0;
  for (const NodalInertia& inertia : model_of(simulation).inertias) mass += inertia.total_mass;
  return mass;
}

/// The constant of the energy account: energy - work + dissipation [J].
inline double energy_account(const Simulation& simulation) {
  const Energies e = simulation.energies();
  return e.total() - e.work + e.dissipated;
}

/// Largest change of energy and momenta since construction, relative to their largest values. The linear momentum is
/// relative to sqrt(2 m T), because the total may vanish although its parts do not.
class InvariantDrift {
 public:
  explicit InvariantDrift(const Simulation& simulation)
      : simulation_(simulation),
        balance_(energy_account(simulation)),
        linear_(simulation.momentum()),
        angular_(simulation.angular_momentum()) {
    observe();
  }
  void observe() {
    const Energies e = simulation_.energies();
    energy_scale_ = std::max({energy_scale_, e.kinetic, e.strain, std::abs(e.potential), e.dissipated});
    linear_scale_ = std::max(linear_scale_, std::sqrt(2 * total_mass(simulation_) * e.kinetic));
    angular_scale_ = std::max(angular_scale_, simulation_.angular_momentum().norm());
    energy_ = std::max(energy_, std::abs(energy_account(simulation_) - balance_));
    linear_drift_ = std::max(linear_drift_, (simulation_.momentum() - linear_).norm());
    angular_drift_ = std::max(angular_drift_, (simulation_.angular_momentum() - angular_).norm());
  }
  /// Drift of total - work + dissipated.
  double energy() const { return energy_ / energy_scale_; }
  double momentum() const { return linear_drift_ / linear_scale_; }
  double angular_momentum() const { return angular_drift_ / angular_scale_; }

 private:
  const Simulation& simulation_;
  double balance_;
  Vector3 linear_, angular_;
  double energy_ = 0, linear_drift_ = 0, angular_drift_ = 0;
  double energy_scale_ = 0, linear_scale_ = 0, angular_scale_ = 0;
};

inline void initial_field(SceneBuilder& builder, const std::string& link, const Vector3& linear,
                          const Vector3& angular) {
  builder.scene.initial_links.push_back({link, linear, angular, {}});
}
inline void initial_joint(SceneBuilder& builder, const std::string& coordinate, double position, double velocity) {
  builder.scene.initial_joints.push_back({coordinate, position, velocity, {}});
}

/// Changes the velocity of the first initial field such that the centre of mass moves with `drift`. Near the origin,
/// the angular momentum has no round-off of large distances.
inline void set_drift(SceneBuilder& builder, const Vector3& drift) {
  const Simulation simulation(builder.scene);
  builder.scene.initial_links.front().linear += drift - simulation.momentum() / total_mass(simulation);
}

}  // namespace flexarm::test
