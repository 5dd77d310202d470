#pragma once
/// Which parts of two models are the same, when a scene is edited while it moves.

#include <optional>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "model/model.h"

namespace flexarm {

/// Name of a flexible link that is in both models, but with different elements. None if there is no such link.
std::optional<std::string> link_with_other_mesh(const Model& before, const Model& after);

/// A scene and its model.
struct ModelOfScene {
  const scene::SceneDescription& scene;
  const Model& model;
};

/// For each item of the model after the edit: the index of the same item before it, or -1. Links, coordinates and
/// sensors are the same if their names are. Nodes are the same only if their frames are at the same place of their
/// bodies.
struct ModelCorrespondence {
  /// Requires that flexible links have the same meshes in both models.
  ModelCorrespondence(const ModelOfScene& before, const ModelOfScene& after);

  std::vector<int> links, coordinates, sensors, nodes, stiffness_points, mass_points;

 private:
  void find_nodes(const Model& before, const Model& after);
  void find_points(const Model& before, const Model& after);
};

}  // namespace flexarm
