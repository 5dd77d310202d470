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

/// A point of the link of that name, given in the link's undeformed frame [m].
ProbePoint probe_point(const ScenePlan& plan, const Model& model, const std::string& name, const Vector3& point);
std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model);

}  // namespace flexarm
