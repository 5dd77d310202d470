#pragma once
/// What all subcommands do with their input.

#include <string>

#include <CLI/CLI.hpp>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

/// A scene file on the command line, and how it is to be read.
struct SceneInput {
  std::string path;
  scene::ReadOptions options;
};

/// The argument `scene` and its options; `input` must outlive the command.
void add_scene(CLI::App& command, SceneInput& input);

/// Reads a scene and builds its simulation; findings go to the standard error output.
/// @throws InputError if the scene has errors, ModelError if it cannot be built.
Simulation load_simulation(const SceneInput& input, const SimulationOptions& options = {});

/// For options: a finite number > 0, or >= 0.
std::string check_positive(const std::string& text);
std::string check_non_negative(const std::string& text);

/// Goes to the equilibrium if there is one that can be found, and says so if not: a free body has none.
void seek_equilibrium(Simulation& simulation);

}  // namespace flexarm::cli
