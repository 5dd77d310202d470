#pragma once
/// Everything about a scene that does not depend on positions, including meshes of single links (internal to
/// building/).

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "building/beam_mesh.h"
#include "building/centreline.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// "file:line: element: ", the beginning of messages about an element.
std::string at(const scene::SourceLocation& location, const std::string& element);
/// The same for the loop joint of this name, which the scene must have.
std::string at_loop_joint(const scene::SceneDescription& scene, const std::string& name);

/// Indices of the links of a scene by name.
class LinkNames {
 public:
  /// @throws ModelError if two links have the same name.
  explicit LinkNames(const scene::SceneDescription& scene);
  /// Index into SceneDescription::links.
  /// @throws ModelError if there is no such link.
  int operator[](const std::string& name) const;

 private:
  std::string file_;
  std::unordered_map<std::string, int> indices_;
};

/// The tree that links and joints form.
struct JointTree {
  /// @throws ModelError if a link has two parents or is not connected to the root link.
  JointTree(const scene::SceneDescription& scene, const LinkNames& links);

  int root;                                                        ///< index of the root link
  std::vector<const scene::JointDescription*> joints;              ///< root to leaf; each branch is consecutive
  std::vector<const scene::JointDescription*> above;               ///< per link: joint that carries it; null: root
  std::vector<std::vector<const scene::JointDescription*>> below;  ///< per link: joints on it; slides last
};

/// The undeformed line and mesh of a link with a beam.
struct LinkMesh {
  Centreline centreline;
  BeamMesh mesh;
};

/// @throws ModelError if the beam's centreline or order is impossible.
Centreline centreline_of(const scene::LinkDescription& link);

/// See mesh_beam().
/// @throws ModelError if there is no such mesh.
BeamMesh mesh_of(const scene::LinkDescription& link, const Centreline& centreline, const std::vector<double>& borders,
                 int most = scene::kMostBeamElements);

/// The arc lengths between which the load acts, as far as it names them [m].
/// @throws ModelError if they are beyond the line.
std::vector<double> ends_of(const scene::DistributedLoad& load, const Centreline& centreline);

/// Per link; empty for rigid ones.
using LinkMeshes = std::vector<std::optional<LinkMesh>>;

/// Initial positions of joint coordinates.
class InitialPositions {
 public:
  explicit InitialPositions(const scene::SceneDescription& scene);
  /// The position that the scene gives, or else `otherwise` [m or rad].
  double of(const std::string& coordinate, double otherwise = 0) const;

 private:
  std::unordered_map<std::string, double> positions_;
};

struct ScenePlan {
  /// @throws ModelError
  explicit ScenePlan(const scene::SceneDescription& scene);

  const scene::SceneDescription& scene;
  LinkNames links;
  JointTree tree;
  LinkMeshes meshes;
  InitialPositions initial_positions;
  /// Positions of the joints that are held, by name (see joints_to_hold()).
  std::unordered_map<std::string, double> held;
  /// Origin of the model in the world [m]: the world's own, or the first joint on the root link if that is far away
  /// compared with the mechanism's size, so that positions have as many digits as at the world's origin.
  Vector3 origin = Vector3::Zero();
  /// See Model::floats and Model::initial_origin.
  bool floats;
  Vector3 start_origin = Vector3::Zero();
};

}  // namespace flexarm
