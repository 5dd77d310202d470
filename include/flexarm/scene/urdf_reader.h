#pragma once
/// Reads a URDF file with flexarm's extension elements. The only door to urdfdom and tinyxml2.

#include <map>
#include <optional>
#include <string>

#include "flexarm/scene/diagnostic.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm::scene {

/// The scene, if the input has no error; all findings in any case.
struct ReadResult {
  std::optional<SceneDescription> scene;
  Diagnostics diagnostics;
  /// Of a scene: the file, or where it has expressions, the same with numbers in their place and without its
  /// parameters, which programs can read that know none.
  std::string urdf = {};
};

/// Values for parameters of a scene, by their names.
using ParameterValues = std::map<std::string, double>;

struct ForceElementKind;

/// What <simulation> can say as well, where either place is enough; and values for parameters in the place of the
/// file's.
struct ReadOptions {
  bool clamp_start = false;    ///< start="clamp": joints that would start outside their limits start at the nearest one
  bool lock_massless = false;  ///< massless="lock": see SceneDescription::lock_massless
  bool equilibrium_start = false;  ///< <initial equilibrium="true"/>: see SceneDescription::starts_in_equilibrium
  /// A name that the scene has no <parameter> for, and a value outside its limits, are errors of the scene.
  ParameterValues parameters = {};
  /// For xacro, which read_scene_file() runs for files *.xacro, as "NAME=VALUE NAME=VALUE".
  std::string xacro_arguments = {};
  /// Kinds of elements between points of links that a scene may have besides those of the format; null: none. For who
  /// builds in the library's sources, where kinds are declared (scene/force_element_kinds.h).
  const std::vector<ForceElementKind>* more_force_elements = nullptr;
};

/// Reads a file, *.xacro by the program xacro where there is one. Never throws for bad input: every error of the file
/// is in the diagnostics.
ReadResult read_scene_file(const std::string& path, const ReadOptions& options = {});
/// Reads text (the parameter `robot_description`); `name` stands for the file in diagnostics.
ReadResult read_scene_text(const std::string& text, const std::string& name, const ReadOptions& options = {});

}  // namespace flexarm::scene
