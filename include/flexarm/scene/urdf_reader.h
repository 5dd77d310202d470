#pragma once
/// Reads a URDF file with flexarm's elements. The only part that uses urdfdom and tinyxml2.

#include <map>
#include <optional>
#include <string>

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The scene, if the input has no errors; and all errors and warnings.
struct ReadResult {
  std::optional<SceneDescription> scene;
  Diagnostics diagnostics;
  /// The text of the scene's file. Expressions are replaced by numbers and parameters are left out, so that programs
  /// that know neither can read it.
  std::string urdf = {};
};

/// Values for parameters of a scene, by their names.
using ParameterValues = std::map<std::string, double>;

struct ForceElementKind;

/// Options that <simulation> has, too (either place is enough), and values of parameters instead of those in the file.
struct ReadOptions {
  bool clamp_start = false;    ///< start="clamp": joints that would start outside their limits start at the nearest one
  bool lock_massless = false;  ///< massless="lock": see SceneDescription::lock_massless
  bool equilibrium_start = false;  ///< <initial equilibrium="true"/>: see SceneDescription::starts_in_equilibrium
  /// It is an error if the scene has no <parameter> of a name, or if a value is outside its limits.
  ParameterValues parameters = {};
  /// For xacro, which read_scene_file() runs for files *.xacro, as "NAME=VALUE NAME=VALUE".
  std::string xacro_arguments = {};
  /// More kinds of elements between points of links than those of the format; null: none. For code within the library's
  /// sources, where kinds are declared (scene/force_element_kinds.h).
  const std::vector<ForceElementKind>* more_force_elements = nullptr;
};

/// Reads a file, *.xacro by the program xacro where there is one. Never throws for bad input: every error of the file
/// is in the diagnostics.
ReadResult read_scene_file(const std::string& path, const ReadOptions& options = {});
/// Reads text (the parameter `robot_description`); `name` stands for the file in diagnostics.
ReadResult read_scene_text(const std::string& text, const std::string& name, const ReadOptions& options = {});

}  // namespace flexarm::scene
