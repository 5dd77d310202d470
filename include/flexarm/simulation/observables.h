#pragma once
/// Read-only functions of a state: energies, momenta, poses of points.

#include <vector>

#include "flexarm/integrators/scheme.h"
#include "flexarm/model/model.h"
#include "flexarm/model/state.h"

namespace flexarm {

/// Energies of a state [J]; work and dissipation are path integrals since the start.
struct Energies {
  double kinetic = 0, strain = 0, potential = 0, work = 0, dissipated = 0;
  double total() const { return kinetic + strain + potential; }
};

/// Linear and angular momentum (about the world origin) [kg m/s, kg m^2/s].
struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

/// By the scheme's own quadrature (lumped or integrated rotary inertia), so that its balance is exact. `strain`
/// contains the elastic energy of joint stops, `potential` is that of gravity.
Energies energies(const Model& model, const Scheme& scheme, const State& state);
Momenta momenta(const Model& model, const Scheme& scheme, const State& state);

/// One point of a deformed centreline.
struct BeamPoint {
  double arc_length = 0;                ///< of the undeformed line [m]
  Pose pose;                            ///< of the section, in the world
  Vector6 strain = Vector6::Zero();     ///< {Gamma, K} in the section frame [-, 1/m]
  Vector6 resultant = Vector6::Zero();  ///< {N, M} in the section frame [N, N m]
};
/// Points at every node and `between` equally spaced points inside each pair of nodes; appended to `points`.
void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points);

/// Pose and velocity of a named point.
struct ProbeState {
  Pose pose;
  Vector3 velocity = Vector3::Zero();  ///< world axes [m/s]
};
ProbeState probe_state(const Model& model, const State& state, const ProbePoint& probe);

/// Pose of a frame fixed to a node (or to the world).
Pose attached_pose(const State& state, const Attachment& attachment);

/// The state at the start: the model's initial configuration and velocities.
State initial_state(const Model& model);

}  // namespace flexarm
