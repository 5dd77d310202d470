#pragma once
/// Simulations of short scenes that tests have as text, and their account of energies.

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test {

/// A scene of these parts beside the link "world". `options`: children of <simulation>. Everything that the reader
/// finds fails the test.
inline scene::SceneDescription scene_of_parts(const std::string& parts, const std::string& options = "",
                                              double step = 1e-3, const std::string& scheme = "em") {
  const std::string text = fmt::format(
      R"(<robot name="r"> <link name="world"/> {} <simulation> <integrator scheme="{}" step="{}" tolerance="1e-12"/> {}
         </simulation> </robot>)",
      parts, scheme, step, options);
  const scene::ReadResult read = scene::read_scene_text(text, "parts.urdf");
  for (const scene::Diagnostic& finding : read.diagnostics) ADD_FAILURE() << finding.text();
  return read.scene.value();
}

inline Simulation simulation_of_parts(const std::string& parts, const std::string& options = "", double step = 1e-3,
                                      const std::string& scheme = "em") {
  return Simulation(scene_of_parts(parts, options, step, scheme));
}

inline void move_until(Simulation& simulation, double time) {
  while (simulation.time() < time - 1e-9) ASSERT_TRUE(simulation.step().converged);
}

/// What the account of energies lacks [J]. `start`: the energy at the start.
inline double imbalance(const Simulation& simulation, double start) {
  const Energies now = simulation.energies();
  return now.total() + now.dissipated - now.work - start;
}

}  // namespace flexarm::test
