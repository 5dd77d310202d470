#pragma once
/// Loads and probes (internal to building/).

#include <vector>

#include "building/mechanism.h"

namespace flexarm {

struct PlacedLoads {
  std::vector<NodalLoad> loads;
  std::vector<TimeFunction> histories;  ///< those of the model, then those of the loads
};
/// @throws ModelError for a load on what cannot move, and for a distributed one on a rigid link.
PlacedLoads place_loads(const ScenePlan& plan, const Model& model);

std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model);

}  // namespace flexarm
