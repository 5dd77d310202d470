#pragma once
/// Scenes of contact tests.

#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test::touching {

inline constexpr double kG = 9.81;
inline const std::string kFloor = "<ground name='floor'/>";

inline std::string floating(const std::string& link) {
  return joint("of_" + link, "floating", "world", link);
}

/// <contact>. `more`: its other attributes.
inline std::string contact_of(const std::string& first, const std::string& second, const std::string& more = "") {
  return "<contact first='" + first + "' second='" + second + "' " + more + "/>";
}

/// A part of the world, which may touch others. `more`: children of its joint.
inline std::string fixed(const std::string& link, const std::string& shape, const std::string& more = "") {
  return "<link name='" + link + "'>" + collision(shape) + "</link>" +
         joint("of_" + link, "fixed", "world", link, more);
}

/// A beam along `line`, such as <line to='1 0 0'/>, of a round bar. `material`: other children of <beam>.
inline std::string round_beam(const std::string& name, const std::string& line, double radius,
                              const std::string& material, int elements, int order = 2) {
  return fmt::format(
      "<link name='{}'><beam elements='{}' order='{}'><centerline>{}</centerline>"
      "<circle radius='{:.17g}'/>{}</beam></link>",
      name, elements, order, line, radius, material);
}

/// Place and velocity of a floating link at the start.
inline std::string start(const std::string& link, const Vector3& place, const Vector3& velocity,
                         const Vector3& rate = Vector3::Zero()) {
  std::string out;
  for (int k = 0; k < 3; ++k)
    out += fmt::format("<initial joint='of_{}/{}' position='{:.17g}'/>", link, "xyz"[k], place[k]);
  return out + fmt::format("<initial link='{}' linear='{}' angular='{}'/>", link, xyz(velocity), xyz(rate));
}

/// Reads a scene and starts it. `parts`: links, joints and contacts; `starts`: entries of <simulation>. Step in s,
/// gravity in m/s^2.
inline Simulation simulation_of(const std::string& parts, const std::string& starts, double step,
                                const Vector3& gravity = {0, 0, -kG}, const SimulationOptions& options = {}) {
  return Simulation(scene_of(robot(parts, test::gravity(gravity) + integrator("em", step) + starts)), options);
}

}  // namespace flexarm::test::touching
