#include "flexarm/integrators/scheme.h"

namespace flexarm {

const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> table = {
      {"em", StressRule::DiscreteGradient, RotationRule::TangentScaled, true, 0.25, 0.5, true, true,
       "invariant energy-momentum scheme, one multiplier per element"},
      {"em0", StressRule::Average, RotationRule::TangentScaled, true, 0.25, 0.5, false, true,
       "its base: momenta exact, energy to third order per step"},
      {"m1", StressRule::Exponential, RotationRule::Unscaled, false, 0.25, 0.5, false, true,
       "momentum-conserving scheme M1 (Muñoz 2004, sec. 6.3)"},
      {"newmark", StressRule::EndPoint, RotationRule::Unscaled, false, 0.25, 0.5, false, false,
       "trapezoidal rule (Muñoz 2004, ch. 4)"},
  };
  return table;
}

std::optional<Scheme> find_scheme(std::string_view name) {
  if (name == "auto") return schemes().front();
  for (const Scheme& scheme : schemes())
    if (scheme.name == name) return scheme;
  return std::nullopt;
}

}  // namespace flexarm
