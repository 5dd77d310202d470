#pragma once
/// What all subcommands do with their input.

#include <string>
#include <vector>

#include "cli/command.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "simulation/equilibrium_text.h"

namespace flexarm::cli {

/// A scene file on the command line, and how it is to be read.
struct SceneInput {
  std::string path;
  scene::ReadOptions options;
};

/// The argument `scene` and its options; `input` must outlive the command.
void add_scene(Command& command, SceneInput& input);

/// Reads a scene; findings go to the standard error output.
/// @returns with a scene
/// @throws InputError if the scene has errors
scene::ReadResult read_scene(const SceneInput& input);

/// Reads a scene and builds its simulation; findings go to the standard error output.
/// @throws InputError if the scene has errors, ModelError if it cannot be built.
Simulation load_simulation(const SceneInput& input, const SimulationOptions& options = {});

/// For options: between 0 and 1, both excluded.
std::string check_part(const std::string& text);
/// The same for a tolerance of Newton's method.
std::string check_tolerance(const std::string& text);
/// Names of time integration schemes.
Words scheme_choices();

/// An option by which the equilibrium that the loads lead to is taken, stable or not; `wanted` must outlive the
/// command.
void add_equilibrium(Command& command, Equilibrium& wanted);
/// On the standard error output: that the loads lead to an unstable equilibrium, and which one was taken.
void warn_of_instability(const Simulation& simulation, const StaticResult& result, Equilibrium wanted);

/// Goes to the equilibrium if there is one that can be found; the `count` first modes about it. A mechanism that can
/// move freely has none, which is said on the standard error output; then those about the initial configuration, as
/// many more as there may be free motions.
/// @throws std::runtime_error if the eigenvalue problem cannot be solved.
struct ModesAbout {
  std::vector<Mode> modes;
  bool is_equilibrium;  ///< else about the initial configuration
};
ModesAbout modes_about_equilibrium(Simulation& simulation, int count, Equilibrium wanted = Equilibrium::Stable);
/// Where the joints are then, and which of them are pressed on their limits.
void print_where(const Simulation& simulation, bool is_equilibrium);

/// Whether a few modes take seconds and no more: without springs, there is a free one for every joint coordinate.
bool are_modes_quick(const Simulation& simulation);

}  // namespace flexarm::cli
