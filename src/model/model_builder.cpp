#include "model/model_builder.h"

#include <algorithm>
#include <map>
#include <set>

#include "mass_properties.h"
#include "mechanism_builder.h"

namespace flexarm {
namespace {

/// Loads, their histories, and probes.
class LoadPlacer {
 public:
  LoadPlacer(const scene::SceneDescription& scene, MechanismBuilder& mechanism)
      : scene_(scene), mechanism_(mechanism), model_(mechanism.model) {}

  void place() {
    for (const scene::PointLoad& load : scene_.loads) point_load(load);
    for (const scene::DistributedLoad& load : scene_.distributed_loads) distributed_load(load);
    for (const scene::Probe& probe : scene_.probes) model_.probes.push_back(probe_point(probe));
  }

 private:
  void point_load(const scene::PointLoad& load) {
    const Attachment attachment = mechanism_.attachment(load.link, load.at);
    if (attachment.node < 0)
      throw ModelError(mechanism_.at(load.location, "<load>") + "link '" + load.link + "' is fixed to the world");
    const Pose at = attachment.offset * Pose{load.at, Quaternion::Identity()};
    NodalLoad out;
    out.node = attachment.node;
    out.arm = at.position;
    out.follows = load.frame == scene::LoadFrame::Follower;
    out.force = out.follows ? Vector3(attachment.offset.orientation * load.force) : load.force;
    out.moment = out.follows ? Vector3(attachment.offset.orientation * load.moment) : load.moment;
    out.history = mechanism_.add_history(load.history);
    model_.loads.push_back(out);
  }

  void distributed_load(const scene::DistributedLoad& load) {
    const int link = mechanism_.link_index(load.link);
    const auto& mesh = mechanism_.meshes[link];
    if (!mesh)
      throw ModelError(mechanism_.at(load.location, "<distributed_load>") + "link '" + load.link + "' has no <beam>");
    const int history = mechanism_.add_history(load.history);
    // Lumped with the weights int I^i ds: exact for a dead load, the nodes' Newton-Cotes rule for a follower load.
    const std::vector<double> weights = mechanism_.length_weights(link);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const Pose& pose = mesh->mesh.nodes[i].pose;
      NodalLoad out;
      out.node = mesh->first_node + static_cast<int>(i);
      out.arm = -mesh->mesh.centroid;
      out.follows = load.frame == scene::LoadFrame::Follower;
      out.force = weights[i] * load.force;
      if (out.follows) out.force = pose.orientation.conjugate() * out.force;
      out.history = history;
      model_.loads.push_back(out);
    }
  }

  ProbePoint probe_point(const scene::Probe& probe) const {
    ProbePoint out;
    out.link = mechanism_.link_index(probe.link);
    const LinkFrame& link = model_.links[out.link];
    const Pose at{probe.at, Quaternion::Identity()};
    if (!link.beam) {
      out.attachment = {link.frame.node, link.frame.offset * at};
      return out;
    }
    const auto& mesh = *mechanism_.meshes[out.link];
    const double s = mesh.centreline.nearest(probe.at);
    const std::vector<double>& ends = link.beam->element_ends;
    const auto found = std::lower_bound(ends.begin(), std::prev(ends.end()), s - 1e-12 * link.beam->length);
    const double begin = found == ends.begin() ? 0.0 : *std::prev(found);
    out.element = static_cast<int>(found - ends.begin());
    out.xi = 2 * (s - begin) / (*found - begin) - 1;
    Pose section = mesh.centreline.at(s);
    section.position += section.orientation * mesh.mesh.centroid;
    out.offset = section.inverse() * at;
    return out;
  }

  const scene::SceneDescription& scene_;
  MechanismBuilder& mechanism_;
  Model& model_;
};

/// A model, and its coordinates that move nothing that has inertia: their accelerations would be undetermined.
struct BuiltModel {
  Model model;
  std::vector<int> massless;
};

BuiltModel build(const scene::SceneDescription& scene) {
  MechanismBuilder mechanism(scene);
  mechanism.build();
  LoadPlacer(scene, mechanism).place();
  mechanism.model.length_scale = mechanism.extent();
  Model model = std::move(mechanism.model);
  model.gravity = scene.gravity;
  std::vector<int> massless = finish_mass_properties(mechanism.node_parents, model);
  return {std::move(model), std::move(massless)};
}

[[noreturn]] void refuse_massless(const scene::SceneDescription& scene, const BuiltModel& built) {
  std::map<std::string, const scene::JointDescription*> joints;  // by coordinate
  for (const auto* list : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *list)
      for (const std::string& suffix : scene::coordinate_suffixes(joint)) joints.emplace(joint.name + suffix, &joint);
  std::string text;
  for (const int index : built.massless) {
    const std::string& name = built.model.coordinates[index].name;
    text += MechanismBuilder::at(joints.at(name)->location, "<joint>") + "joint coordinate '" + name +
            "' moves nothing that has inertia\n";
  }
  throw ModelError(text + scene.file +
                   ": give the links outboard of these joints an <inertial> or a <beam>, or hold those with one "
                   "coordinate where they are by massless=\"lock\" of <simulation> (--massless lock)");
}

/// The scene with constant motions of these coordinates in place of everything else that it says of them.
scene::SceneDescription with_locked(scene::SceneDescription scene, const BuiltModel& built) {
  std::set<std::string> locked;
  for (const int index : built.massless) {
    const Coordinate& coordinate = built.model.coordinates[index];
    if (coordinate.is_angle) continue;  // of a free rotation, which no motion can prescribe
    locked.insert(coordinate.name);
    const Released& start = built.model.initial_released[coordinate.joint];
    scene.motions.push_back({coordinate.name, TimeFunction(start.displacement[coordinate.component]), {scene.file}});
  }
  const auto drop = [&](auto& entries) {
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return locked.count(entry.coordinate) > 0; }),
                  entries.end());
  };
  drop(scene.initial_joints);
  drop(scene.efforts);
  return scene;
}

}  // namespace

Model build_model(const scene::SceneDescription& scene) {
  BuiltModel built = build(scene);
  if (scene.lock_massless && !built.massless.empty()) built = build(with_locked(scene, built));
  if (!built.massless.empty()) refuse_massless(scene, built);
  return std::move(built.model);
}

}  // namespace flexarm
