#include "flexarm/simulation/command_refusal.h"

#include <algorithm>

#include <fmt/format.h>

#include "flexarm/math/near_names.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// Says which joint the coordinate follows; empty if it follows none. A follower of a fixed joint is held: the model
/// treats it as a prescribed motion.
std::string leader_text(const Simulation& simulation, const Coordinate& coordinate) {
  const auto& joints = simulation.scene().joints;
  const auto joint = std::find_if(joints.begin(), joints.end(), [&](const scene::JointDescription& candidate) {
    return candidate.mimic && candidate.name == coordinate.name;
  });
  if (coordinate.mimicked >= 0)
    return fmt::format("'{}' {} '{}' and takes no commands of its own: command that one", coordinate.name,
                       joint == joints.end() ? "follows" : "mimics",
                       model_of(simulation).coordinates[coordinate.mimicked].name);
  if (joint == joints.end()) return {};
  return fmt::format("'{}' mimics '{}' and is held, since a fixed joint leads it", coordinate.name,
                     joint->mimic->joint);
}

}  // namespace

std::string refusal_of_commands(const Simulation& simulation, std::size_t index) {
  if (simulation.is_commandable(index)) return {};
  const Coordinate& coordinate = model_of(simulation).coordinates[index];
  const std::string leader = leader_text(simulation, coordinate);
  return leader.empty() ? "the motion of '" + coordinate.name + "' is prescribed" : leader;
}

std::string refusal_of_set_points(const Simulation& simulation, std::size_t index) {
  if (simulation.has_servo(index)) return {};
  const Coordinate& coordinate = model_of(simulation).coordinates[index];
  std::string leader = leader_text(simulation, coordinate);
  if (!leader.empty()) return leader;
  return fmt::format(
      "'{0}' has no servo: write <servo joint=\"{0}\" mode=\"position\" kp=\"...\" kd=\"...\"/> into the scene",
      coordinate.name);
}

std::string unknown_coordinate(const Simulation& simulation, const std::string& name) {
  const std::vector<std::string>& names = simulation.coordinate_names();
  return "there is no joint coordinate '" + name + "'; the scene has " +
         (names.empty() ? "none" : nearest_listed(name, names));
}

}  // namespace flexarm
