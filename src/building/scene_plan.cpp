#include "building/scene_plan.h"

#include <algorithm>
#include <stdexcept>

#include "building/elementary_joints.h"
#include "building/model_builder.h"
#include "building/passes.h"
#include "model/carried_origin.h"
#include "scene/limits.h"

namespace flexarm {
namespace {

/// Meshes all flexible links, with element borders wherever a joint or a load attaches.
LinkMeshes mesh_links(const scene::SceneDescription& scene, const LinkNames& links) {
  LinkMeshes meshes(scene.links.size());
  for (std::size_t i = 0; i < scene.links.size(); ++i) {
    if (!scene.links[i].beam) continue;
    meshes[i] = LinkMesh{centreline_of(scene.links[i]), {}};
  }
  std::vector<std::vector<double>> borders(scene.links.size());  // arc lengths
  const auto attach = [&](const std::string& link, const Vector3& point) {
    const int index = links[link];
    if (meshes[index]) borders[index].push_back(meshes[index]->centreline.nearest(point));
  };
  for (const scene::JointDescription& joint : scene.joints) attach(joint.parent, joint.origin.position);
  for (const scene::JointDescription& joint : scene.loop_joints) {
    attach(joint.parent, joint.origin.position);
    attach(joint.child, joint.child_origin.position);
  }
  for (const scene::ClearanceDescription& clearance : scene.clearances) {
    attach(clearance.joint.parent, clearance.joint.origin.position);
    attach(clearance.joint.child, clearance.joint.child_origin.position);
  }
  for (const scene::PointLoad& load : scene.loads) attach(load.link, load.at);
  for (const auto& element : scene.force_elements)
    for (const scene::LinkPoint& point : element->points()) attach(point.link, point.at);
  for (const scene::DistributedLoad& load : scene.distributed_loads) {
    const int link = links[load.link];
    if (!meshes[link]) continue;  // the pass that places loads reports it
    for (const double end : ends_of(load, meshes[link]->centreline)) borders[link].push_back(end);
  }
  int room = scene::kMostBeamNodes;  // number of nodes that may still be made
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (!meshes[i]) continue;
    const scene::BeamDescription& beam = *scene.links[i].beam;
    const int most = std::min(scene::kMostBeamElements, room / beam.order);
    meshes[i]->mesh = mesh_of(scene.links[i], meshes[i]->centreline, borders[i], most);
    room = std::max(0, room - static_cast<int>(meshes[i]->mesh.nodes.size()));
  }
  return meshes;
}

/// Size of the largest part. Joints on the root link are taken relative to `origin`.
double size_of(const scene::SceneDescription& scene, const JointTree& tree, const LinkMeshes& meshes,
               const Vector3& origin) {
  double size = 0;
  const auto reach = [&](const std::string& link, const Vector3& place) {
    size = std::max(size, (link == scene.root_link ? Vector3(place - origin) : place).norm());
  };
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *joints) {
      reach(joint.parent, joint.origin.position);
      reach(joint.child, joint.child_origin.position);
    }
  for (std::size_t i = 0; i < scene.links.size(); ++i) {
    if (meshes[i]) size = std::max(size, meshes[i]->centreline.length());
    const bool is_root = static_cast<int>(i) == tree.root;
    if (scene.links[i].inertial && !is_root) size = std::max(size, scene.links[i].inertial->center_of_mass.norm());
  }
  return size;
}

/// The value of Model::floats.
bool floats(const scene::SceneDescription& scene, const JointTree& tree, const LinkMeshes& meshes) {
  const auto& on_root = tree.below[tree.root];
  const auto is_free = [&](const scene::JointDescription* joint) {
    return joint->kind == scene::JointKind::Floating &&
           std::none_of(scene.motions.begin(), scene.motions.end(), [&](const scene::PrescribedMotion& motion) {
             const std::vector<std::string> names = coordinate_names(*joint);
             return std::count(names.begin(), names.end(), motion.coordinate) > 0;
           });
  };
  const auto holds_root = [&](const scene::JointDescription& loop) {
    return loop.parent == scene.root_link || loop.child == scene.root_link;
  };
  if (!scene.contacts.empty() || !scene.clearances.empty()) return false;  // something may stand in the way
  const auto ties_root = [&](const auto& element) {
    const std::vector<scene::LinkPoint> points = element->points();
    return std::any_of(points.begin(), points.end(),
                       [&](const scene::LinkPoint& point) { return point.link == scene.root_link; });
  };
  return !on_root.empty() && !meshes[tree.root] && std::all_of(on_root.begin(), on_root.end(), is_free) &&
         std::none_of(scene.loop_joints.begin(), scene.loop_joints.end(), holds_root) &&
         std::none_of(scene.force_elements.begin(), scene.force_elements.end(), ties_root);
}

}  // namespace

std::string at(const scene::SourceLocation& location, const std::string& element) {
  return location.file + ":" + std::to_string(location.line) + ": " + element + ": ";
}

std::string at_loop_joint(const scene::SceneDescription& scene, const std::string& name) {
  const auto joint = std::find_if(scene.loop_joints.begin(), scene.loop_joints.end(),
                                  [&](const scene::JointDescription& loop) { return loop.name == name; });
  return at(joint->location, "<loop_joint> '" + name + "'");
}

LinkNames::LinkNames(const scene::SceneDescription& scene) : file_(scene.file) {
  for (std::size_t i = 0; i < scene.links.size(); ++i)
    if (!indices_.emplace(scene.links[i].name, static_cast<int>(i)).second)
      throw ModelError(scene.file + ": two links are named '" + scene.links[i].name + "'");
}

int LinkNames::operator[](const std::string& name) const {
  const auto found = indices_.find(name);
  if (found == indices_.end()) throw ModelError(file_ + ": there is no link '" + name + "'");
  return found->second;
}

JointTree::JointTree(const scene::SceneDescription& scene, const LinkNames& links)
    : root(links[scene.root_link]), above(scene.links.size(), nullptr), below(scene.links.size()) {
  for (const scene::JointDescription& joint : scene.joints) {
    const int child = links[joint.child];
    if (above[child]) throw ModelError(at(joint.location, "<joint>") + "link '" + joint.child + "' has two parents");
    above[child] = &joint;
    below[links[joint.parent]].push_back(&joint);
  }
  // Joints that slide come after the beams that are welded to the line.
  for (auto& list : below)
    std::stable_partition(list.begin(), list.end(),
                          [](const scene::JointDescription* joint) { return joint->kind != scene::JointKind::Slide; });
  // Depth first: nodes of a branch are consecutive, which keeps the matrix banded.
  std::vector<const scene::JointDescription*> stack(below[root].rbegin(), below[root].rend());
  while (!stack.empty()) {
    const scene::JointDescription* joint = stack.back();
    stack.pop_back();
    joints.push_back(joint);
    const auto& next = below[links[joint->child]];
    stack.insert(stack.end(), next.rbegin(), next.rend());
  }
  if (joints.size() + 1 != scene.links.size())
    throw ModelError(scene.file + ": not every link is connected to the root link '" + scene.root_link + "'");
}

Centreline centreline_of(const scene::LinkDescription& link) {
  const scene::BeamDescription& beam = *link.beam;
  if (beam.order < 1 || beam.order > 4) throw ModelError(at(beam.location, "<beam>") + "order must be 1 to 4");
  try {
    return Centreline(beam.centreline, beam.section_y);
  } catch (const std::invalid_argument& error) {
    throw ModelError(at(beam.location, "<centerline> of link '" + link.name + "'") + error.what());
  }
}

BeamMesh mesh_of(const scene::LinkDescription& link, const Centreline& centreline, const std::vector<double>& borders,
                 int most) {
  try {
    return mesh_beam(*link.beam, centreline, borders, most);
  } catch (const std::invalid_argument& error) {
    throw ModelError(at(link.beam->location, "<beam> of link '" + link.name + "'") + error.what());
  }
}

std::vector<double> ends_of(const scene::DistributedLoad& load, const Centreline& centreline) {
  std::vector<double> ends;
  for (const std::optional<double>& end : {load.from, load.to}) {
    if (!end) continue;
    if (*end > centreline.length())
      throw ModelError(at(load.location, "<distributed_load>") + "the line of link '" + load.link + "' is " +
                       std::to_string(centreline.length()) + " m long, got " + std::to_string(*end));
    ends.push_back(*end);
  }
  return ends;
}

InitialPositions::InitialPositions(const scene::SceneDescription& scene) {
  for (const scene::InitialJoint& initial : scene.initial_joints) positions_[initial.coordinate] = initial.position;
  for (const scene::PrescribedMotion& motion : scene.motions) positions_[motion.coordinate] = motion.position(0.0);
}

double InitialPositions::of(const std::string& coordinate, double otherwise) const {
  const auto found = positions_.find(coordinate);
  return found == positions_.end() ? otherwise : found->second;
}

ScenePlan::ScenePlan(const scene::SceneDescription& scene)
    : scene(scene),
      links(scene),
      tree(scene, links),
      meshes(mesh_links(scene, links)),
      initial_positions(scene),
      held(joints_to_hold(scene, links, tree)),
      floats(flexarm::floats(scene, tree, meshes)) {
  const auto& on_root = tree.below[tree.root];
  if (on_root.empty() || meshes[tree.root]) return;
  const scene::JointDescription& first = *on_root.front();
  const double size = size_of(scene, tree, meshes, first.origin.position);
  if (first.origin.position.norm() > kFarInSizes * size) origin = first.origin.position;
  if (!floats) return;
  Vector3 start;
  for (int k = 0; k < 3; ++k) start[k] = initial_positions.of(coordinate_names(first)[k]);
  if (start.norm() > kFarInSizes * (size > 0 ? size : 1.0)) start_origin = first.origin.orientation * start;
}

}  // namespace flexarm
