#pragma once
/// Functions that write the scenes of contact tests.

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test::touching {

inline constexpr double kG = 9.81;

inline std::string inertial(double mass, const Vector3& inertia) {
  return fmt::format(
      "<inertial><mass value=\"{:.17g}\"/><inertia ixx=\"{:.17g}\" iyy=\"{:.17g}\" izz=\"{:.17g}\" ixy=\"0\" ixz=\"0\" "
      "iyz=\"0\"/></inertial>",
      mass, inertia.x(), inertia.y(), inertia.z());
}

inline std::string ball(const std::string& name, double mass, double radius) {
  return fmt::format("<link name=\"{}\">{}<collision><geometry><sphere radius=\"{}\"/></geometry></collision></link>",
                     name, inertial(mass, Vector3::Constant(0.4 * mass * radius * radius)), radius);
}

inline std::string box(const std::string& name, double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseAbs2();
  const Vector3 inertia = mass / 12 * (Vector3::Constant(squares.sum()) - squares);
  return fmt::format("<link name=\"{}\">{}<collision><geometry><box size=\"{} {} {}\"/></geometry></collision></link>",
                     name, inertial(mass, inertia), size.x(), size.y(), size.z());
}

inline std::string floating(const std::string& link) {
  return fmt::format("<joint name=\"of_{0}\" type=\"floating\"><parent link=\"world\"/><child link=\"{0}\"/></joint>",
                     link);
}

inline std::string start(const std::string& link, const Vector3& place, const Vector3& velocity,
                         const Vector3& rate = Vector3::Zero()) {
  std::string out;
  const char* axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    out += fmt::format("<initial joint=\"of_{}/{}\" position=\"{:.17g}\"/>", link, axes[k], place[k]);
  return out +
         fmt::format("<initial link=\"{}\" linear=\"{:.17g} {:.17g} {:.17g}\" angular=\"{:.17g} {:.17g} {:.17g}\"/>",
                     link, velocity.x(), velocity.y(), velocity.z(), rate.x(), rate.y(), rate.z());
}

/// Reads a scene and starts it. `parts`: links, joints and contacts; `starts`: entries of <simulation>. Step in s,
/// gravity in m/s^2.
inline Simulation simulation_of(const std::string& parts, const std::string& starts, double step,
                                const Vector3& gravity = {0, 0, -kG}, const SimulationOptions& options = {}) {
  scene::ReadResult result = scene::read_scene_text(
      fmt::format(
          "<robot name=\"contact\"><link name=\"world\"/>{}<simulation><gravity xyz=\"{:.17g} {:.17g} {:.17g}\"/>"
          "<integrator scheme=\"em\" step=\"{:.17g}\"/>{}</simulation></robot>",
          parts, gravity.x(), gravity.y(), gravity.z(), step, starts),
      "contact.urdf");
  for (const scene::Diagnostic& finding : result.diagnostics) ADD_FAILURE() << finding.text();
  return Simulation(result.scene.value(), options);
}

inline void run(Simulation& simulation, double until) {
  while (simulation.time() < until - 0.5 * simulation.step_size()) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << simulation.explain(result);
  }
}

inline double account(const Simulation& simulation) {
  const Energies energies = simulation.energies();
  return energies.total() + energies.dissipated - energies.work;
}

inline const std::string kFloor = "<ground name=\"floor\"/>";

}  // namespace flexarm::test::touching
