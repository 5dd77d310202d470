#pragma once
/// Finds joints, links, probes and sensors by name or index.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm::python {

/// A name, or its index in the list of names.
using Key = std::variant<std::size_t, std::string>;

template <class Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

// The index. @throws std::invalid_argument with the existing names, if there is no such name or index
std::size_t joint_index(const Simulation& simulation, const Key& joint);
std::size_t link_index(const Simulation& simulation, const Key& link);
std::size_t probe_index(const Simulation& simulation, const Key& probe);
std::size_t sensor_index(const Simulation& simulation, const Key& sensor);

std::vector<std::string> probe_names(const Simulation& simulation);
std::vector<std::string> sensor_names(const Simulation& simulation);

/// Joint coordinates that meet a condition, in order.
template <class Condition>
std::vector<std::string> joints_where(const Simulation& simulation, const Condition& holds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
    if (holds(i)) names.push_back(simulation.coordinate_names()[i]);
  return names;
}
/// Joints that take commands of efforts.
std::vector<std::string> effort_joints(const Simulation& simulation);
/// Joints with servos.
std::vector<std::string> servo_joints(const Simulation& simulation);

}  // namespace flexarm::python
