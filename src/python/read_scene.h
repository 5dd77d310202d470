#pragma once
/// Scenes that can be read again with other values of their parameters.

#include <functional>
#include <string>
#include <utility>

#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::python {

/// Reads the scene again, with another value of one parameter.
using SceneReader = std::function<scene::ReadResult(const std::string& parameter, double value)>;

struct ReadScene : scene::SceneDescription {
  ReadScene(scene::SceneDescription scene, SceneReader reader)
      : scene::SceneDescription(std::move(scene)), read(std::move(reader)) {}

  SceneReader read;
};

}  // namespace flexarm::python
