#pragma once
/// Joints, links, probes and sensors, as Python names them.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::python {

/// A name, or its place in the list of names.
using Key = std::variant<std::size_t, std::string>;

template <class Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

// Indices; @throws std::invalid_argument where there is none, with the names that there are.
std::size_t joint_index(const Simulation& simulation, const Key& joint);
std::size_t link_index(const Simulation& simulation, const Key& link);
std::size_t probe_index(const Simulation& simulation, const Key& probe);
std::size_t sensor_index(const Simulation& simulation, const Key& sensor);

std::vector<std::string> probe_names(const Simulation& simulation);
std::vector<std::string> sensor_names(const Simulation& simulation);

/// Joint coordinates for which something holds, in their order.
template <class Condition>
std::vector<std::string> joints_where(const Simulation& simulation, const Condition& holds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    if (holds(i)) names.push_back(simulation.coordinate_names()[i]);
  return names;
}
/// Those that take commands of efforts.
std::vector<std::string> effort_joints(const Simulation& simulation);
/// Those with servos.
std::vector<std::string> servo_joints(const Simulation& simulation);

}  // namespace flexarm::python
