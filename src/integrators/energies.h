#pragma once
/// Computes energies and momenta of a state.

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Linear and angular momentum (about the world origin) [kg m/s, kg m^2/s].
struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

/// Energies by the scheme's own quadrature (lumped or integrated rotary inertia), so that the energy balance is exact.
/// `strain` contains the elastic energy of beams, joint stops, springs, force elements and gears, and the energy stored
/// by numerical dissipation (of second order in the step). `potential` is that of gravity.
Energies energies(const Model& model, const Scheme& scheme, const State& state);
Momenta momenta(const Model& model, const Scheme& scheme, const State& state);

}  // namespace flexarm
