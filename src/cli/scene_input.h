#pragma once
/// Reads scenes for all subcommands, and declares options that several of them share.

#include <string>
#include <vector>

#include "cli/command.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#include "simulation/equilibrium_text.h"

namespace flexarm::cli {

/// A scene file on the command line, and the options for reading it.
struct SceneInput {
  std::string path;
  scene::ReadOptions options;
};

/// Declares the argument `scene` and its options. `input` must outlive the command.
void add_scene(Command& command, SceneInput& input, const std::string& help = "scene file");

/// The options of a scene as words that any command understands: {"--set=mass=4", "--start=clamp"}.
Words option_words(const SceneInput& input);

/// Reads a scene; prints findings to standard error.
/// @returns a result that contains a scene
/// @throws InputError if the scene has errors
scene::ReadResult read_scene(const SceneInput& input);

/// Reads a scene and builds its simulation; prints findings to standard error.
/// @throws InputError if the scene has errors, ModelError if it cannot be built
Simulation load_simulation(const SceneInput& input, const SimulationOptions& options = {});
/// Builds the simulation of a scene that was read; prints warnings about its start to standard error.
/// @throws ModelError if it cannot be built
Simulation started(scene::SceneDescription scene, const SimulationOptions& options = {});

/// A check for options: a number between 0 and 1, both excluded.
std::string check_part(const std::string& text);
/// A check for options: a tolerance of Newton's method.
std::string check_tolerance(const std::string& text);
/// Names of all time integration schemes.
Words scheme_choices();

/// Declares an option with which the equilibrium that the loads lead to is taken even if it is unstable. `wanted` must
/// outlive the command.
void add_equilibrium(Command& command, Equilibrium& wanted);
/// If the loads lead to an unstable equilibrium, says so on standard error, and which equilibrium was taken.
void warn_of_instability(const Simulation& simulation, const StaticResult& result, Equilibrium wanted);

/// If the step is so long for an explicit scheme that motions grow, says so on standard error.
void warn_of_growth(const Simulation& simulation);
/// If a step is more than a tenth of the period of the slowest of these modes, says so on standard error.
void warn_of_long_step(const Simulation& simulation, const std::vector<Mode>& modes);

/// Goes to the equilibrium, and computes the first `count` modes about it. If none can be found, for example since the
/// mechanism can move freely, says so on standard error and computes the modes about the initial configuration; then
/// there are as many more modes as there may be free motions.
/// @throws std::runtime_error if the eigenvalue problem cannot be solved
struct ModesAbout {
  std::vector<Mode> modes;
  bool is_equilibrium;  ///< false: the modes are about the initial configuration
};
ModesAbout modes_about_equilibrium(Simulation& simulation, int count, Equilibrium wanted = Equilibrium::Stable);
/// Prints the positions of the joints, and which joints press on their limits.
void print_where(const Simulation& simulation, bool is_equilibrium);

/// Whether a few modes take only seconds. Without springs, each joint coordinate has a free mode, which must be
/// computed, too.
bool are_modes_quick(const Simulation& simulation);

}  // namespace flexarm::cli
