#include "building/sensor_builder.h"

#include <algorithm>

#include "building/load_builder.h"
#include "building/model_builder.h"

namespace flexarm {
namespace {

using scene::SensorKind;

bool measures_reaction(SensorKind kind) {
  return kind == SensorKind::Wrench || kind == SensorKind::Reaction;
}

bool measures_section(SensorKind kind) {
  return kind == SensorKind::SectionForce || kind == SensorKind::Strain;
}

/// Of the joint that carries a link, or of the loop joint that the sensor names.
ReactionPlace reaction_place(const scene::SceneDescription& scene, const scene::Sensor& sensor, const LinkFrame& link,
                             const Mechanism& mechanism, const Model& model) {
  ReactionPlace place;
  place.link = link.frame;
  if (sensor.joint.empty()) {
    place.joint = mechanism.slave_joint[link.frame.node];
    return place;
  }
  const auto& joints = scene.loop_joints;
  const auto joint =
      std::find_if(joints.begin(), joints.end(), [&](const auto& each) { return each.name == sensor.joint; });
  const auto set_side = [&](bool is_reversed) { place.is_reversed = (sensor.link != joint->child) != is_reversed; };
  for (const JointChain& chain : mechanism.loop_joints) {
    if (chain.joint->name != sensor.joint) continue;
    place.joint = chain.first_map + chain.map_count - 1;
    set_side(chain.is_reversed);
  }
  for (std::size_t k = 0; k < model.closures.size(); ++k) {
    if (model.closures[k].name != sensor.joint) continue;
    place.closure = static_cast<int>(k);
    set_side(model.closures[k].is_reversed);
  }
  if (place.joint < 0 && place.closure < 0)
    throw ModelError(at(sensor.location, "<sensor> '" + sensor.name + "'") + "there is no loop joint '" + sensor.joint +
                     "'");
  return place;
}

/// Index into Model::reactions, which sensors of the same share.
int index_of(const ReactionPlace& place, Model& model) {
  const auto same = std::find(model.reactions.begin(), model.reactions.end(), place);
  const auto index = static_cast<int>(same - model.reactions.begin());
  if (same == model.reactions.end()) model.reactions.push_back(place);
  return index;
}

}  // namespace

bool measures_reaction(const scene::SceneDescription& scene, const std::string& link) {
  return std::any_of(scene.sensors.begin(), scene.sensors.end(), [&](const scene::Sensor& sensor) {
    return sensor.link == link && sensor.joint.empty() && measures_reaction(sensor.kind);
  });
}

void place_sensors(const ScenePlan& plan, const Mechanism& mechanism, Model& model) {
  for (const scene::Sensor& sensor : plan.scene.sensors) {
    const std::string where = at(sensor.location, "<sensor> '" + sensor.name + "'");
    const int link = plan.links[sensor.link];
    if (measures_section(sensor.kind) && !plan.meshes[link])
      throw ModelError(where + "link '" + sensor.link + "' has no <beam>");
    if (measures_reaction(sensor.kind) && sensor.joint.empty() && link == plan.tree.root)
      throw ModelError(where + "no joint carries the root link '" + sensor.link + "'");
    SensorPlace place{probe_point(plan, model, sensor.link, sensor.at)};
    if (measures_reaction(sensor.kind))
      place.reaction = index_of(reaction_place(plan.scene, sensor, model.links[link], mechanism, model), model);
    model.sensors.push_back(place);
  }
}

}  // namespace flexarm
