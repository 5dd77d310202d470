#include "simulation/linear_names.h"

#include <algorithm>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "simulation/inside.h"
#include "simulation/published_motion.h"

namespace flexarm {
namespace {

/// Name of a node: its link, and its index from the link's first node.
std::string name_of_node(const Model& model, int node) {
  for (const LinkFrame& link : model.links) {
    const int last = link.beam ? link.beam->tip.node : link.frame.node;
    if (link.frame.node >= 0 && link.frame.node <= node && node <= last)
      return fmt::format("{}/{}", link.name, node - link.frame.node);
  }
  return fmt::format("node {}", node);
}

}  // namespace

std::vector<std::string> coordinate_names(const Model& model, const DegreesOfFreedom& dof,
                                          const std::vector<int>& scalars, const std::vector<int>& rotors) {
  std::vector<std::string> names;
  for (const int scalar : scalars) {
    const char* const axes[] = {"x", "y", "z", "rx", "ry", "rz"};
    if (scalar < 6 * dof.node_count) {
      names.push_back(fmt::format("{}:{}", name_of_node(model, scalar / 6), axes[scalar % 6]));
      continue;
    }
    const auto named = std::find_if(model.coordinates.begin(), model.coordinates.end(),
                                    [&](const Coordinate& own) { return dof.scalar_of(own) == scalar; });
    names.push_back(named == model.coordinates.end() ? fmt::format("scalar {}", scalar) : named->name);
  }
  for (const int actuator : rotors)
    names.push_back("rotor:" + model.coordinates[model.actuators[actuator].coordinate].name);
  return names;
}

KnownRates published_rates(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  OutputVelocities velocities;
  const DegreesOfFreedom dof(model);
  const Scheme scheme = scheme_of(simulation);
  velocities.update_rates(model, dof, scheme, state_of(simulation));
  velocities.update_nodes(model, dof, scheme, state_of(simulation));
  KnownRates rates;
  rates.nodes = velocities.nodes();
  for (const Coordinate& coordinate : model.coordinates) rates.coordinates.push_back(velocities.rate(coordinate));
  for (const ActuatorState& actuator : state_of(simulation).actuators) rates.rotors.push_back(actuator.rate);
  return rates;
}

MechanismMotion motion_of(const Simulation& simulation) {
  MechanismMotion motion{pose_of(state_of(simulation)), published_rates(simulation), {}};
  for (const ActuatorState& actuator : state_of(simulation).actuators) motion.rotors.push_back(actuator.angle);
  return motion;
}

}  // namespace flexarm
