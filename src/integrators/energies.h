#pragma once
/// Energies and momenta of a state.

#include "flexarm/model/results.h"
#include "model/model.h"
#include "model/state.h"
#include "schemes/scheme.h"

namespace flexarm {

/// Linear and angular momentum (about the world origin) [kg m/s, kg m^2/s].
struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

/// By the scheme's own quadrature (lumped or integrated rotary inertia), so that its balance is exact. `strain`
/// contains the elastic energy of joint stops, of springs, force elements and gears, and what numerical dissipation has
/// stored (second order in the step); `potential` is that of gravity.
Energies energies(const Model& model, const Scheme& scheme, const State& state);
Momenta momenta(const Model& model, const Scheme& scheme, const State& state);

}  // namespace flexarm
