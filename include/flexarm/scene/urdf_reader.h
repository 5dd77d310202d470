#pragma once
/// Reads a scene: a URDF file with flexarm's own elements. No other part of the library uses urdfdom and tinyxml2.

#include <map>
#include <optional>
#include <string>

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The scene, if the input has no errors, with all errors and warnings.
struct ReadResult {
  std::optional<SceneDescription> scene;
  Diagnostics diagnostics;
  /// The scene's XML text in which expressions are replaced by numbers and parameters are removed, for programs that
  /// support neither.
  std::string urdf = {};
};

/// Values of the scene's parameters, by name.
using ParameterValues = std::map<std::string, double>;

struct ForceElementKind;

/// Options for reading. The options with an attribute of <simulation> apply if either the attribute or the option is
/// set.
struct ReadOptions {
  bool clamp_start = false;    ///< start="clamp": joints whose start is outside their limits start at the nearest limit
  bool lock_massless = false;  ///< massless="lock": see SceneDescription::lock_massless
  bool equilibrium_start = false;  ///< <initial equilibrium="true"/>: see SceneDescription::starts_in_equilibrium
  /// Values that replace those in the file. It is an error if the scene has no such <parameter>, or if a value is
  /// outside its limits.
  ParameterValues parameters = {};
  /// Arguments for xacro, "NAME=VALUE NAME=VALUE". read_scene_file() runs xacro for files *.xacro.
  std::string xacro_arguments = {};
  /// Additional kinds of elements between points of links; null: only those of the format. For code within the
  /// library's sources, which can declare kinds (scene/force_element_kinds.h).
  const std::vector<ForceElementKind>* more_force_elements = nullptr;
  bool is_spawned = false;  ///< its root link floats (flexarm/simulation/payloads.h): no warning that it is clamped
};

/// Reads a file. Files *.xacro are expanded by the program xacro, which must be installed. Never throws for bad input:
/// the diagnostics contain every error of the file.
ReadResult read_scene_file(const std::string& path, const ReadOptions& options = {});
/// Reads a text, such as the parameter `robot_description`. Diagnostics show `name` as the file.
ReadResult read_scene_text(const std::string& text, const std::string& name, const ReadOptions& options = {});

}  // namespace flexarm::scene
