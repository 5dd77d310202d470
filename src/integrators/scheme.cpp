#include "flexarm/integrators/scheme.h"

namespace flexarm {

const std::vector<Scheme>& schemes() {
  static const std::vector<Scheme> table = {
      {{StressRule::DiscreteGradient, RotationRule::TangentScaled, true, 0.25, 0.5},
       "em",
       true,
       true,
       "invariant energy-momentum scheme, one multiplier per element"},
      {{StressRule::Average, RotationRule::TangentScaled, true, 0.25, 0.5},
       "em0",
       false,
       true,
       "its base, without the multiplier: momenta exact, energy approximate"},
      {{StressRule::Exponential, RotationRule::Unscaled, false, 0.25, 0.5},
       "m1",
       false,
       true,
       "momentum-conserving scheme M1 (Muñoz 2004, sec. 6.3)"},
      {{StressRule::EndPoint, RotationRule::Unscaled, false, 0.25, 0.5},
       "newmark",
       false,
       false,
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
