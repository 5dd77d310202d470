#include "python/names.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/scene/scene_description.h"

namespace flexarm::python {
namespace {

std::size_t index_of(const char* what, const std::vector<std::string>& names, const Key& key) {
  const auto fail = [&](const std::string& got) {
    throw std::invalid_argument(
        fmt::format("expected the name of a {}, one of [{}], or its index, got {}", what, fmt::join(names, ", "), got));
  };
  if (const std::size_t* index = std::get_if<std::size_t>(&key)) {
    if (*index >= names.size()) fail(std::to_string(*index));
    return *index;
  }
  const std::string& name = std::get<std::string>(key);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) fail("'" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

std::size_t joint_index(const Simulation& simulation, const Key& joint) {
  return index_of("joint coordinate", simulation.coordinate_names(), joint);
}

std::size_t link_index(const Simulation& simulation, const Key& link) {
  return index_of("link", simulation.link_names(), link);
}

std::size_t probe_index(const Simulation& simulation, const Key& probe) {
  return index_of("probe", probe_names(simulation), probe);
}

std::size_t sensor_index(const Simulation& simulation, const Key& sensor) {
  return index_of("sensor", sensor_names(simulation), sensor);
}

std::vector<std::string> probe_names(const Simulation& simulation) {
  return names_of(simulation.scene().probes);
}

std::vector<std::string> sensor_names(const Simulation& simulation) {
  return names_of(simulation.scene().sensors);
}

std::vector<std::string> effort_joints(const Simulation& simulation) {
  return joints_where(simulation, [&](std::size_t joint) { return simulation.is_commandable(joint); });
}

std::vector<std::string> servo_joints(const Simulation& simulation) {
  return joints_where(simulation, [&](std::size_t joint) { return simulation.has_servo(joint); });
}

}  // namespace flexarm::python
