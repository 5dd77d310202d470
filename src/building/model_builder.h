#pragma once
/// From a scene description to a model.

#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Meshes the flexible links, turns joints into elementary maps, lumps rigid bodies on nodes and places loads.
/// @throws ModelError
Model build_model(const scene::SceneDescription& scene);

}  // namespace flexarm
