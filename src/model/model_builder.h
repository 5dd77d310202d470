#pragma once
/// From a scene description to a model.

#include <stdexcept>

#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// A scene that is well-formed as a file and impossible as a mechanism; what() names file, line and element.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Meshes the flexible links, turns joints into elementary maps, lumps rigid bodies on nodes and places loads.
/// @throws ModelError
Model build_model(const scene::SceneDescription& scene);

}  // namespace flexarm
