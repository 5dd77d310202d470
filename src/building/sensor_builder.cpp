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

/// Index into Model::reactions of what carries a link; shared by its sensors.
int reaction_of(const LinkFrame& link, const std::vector<int>& slave_joint, Model& model) {
  const ReactionPlace place{slave_joint[link.frame.node], link.frame.offset.position};
  const auto same = std::find_if(model.reactions.begin(), model.reactions.end(),
                                 [&](const ReactionPlace& other) { return other.joint == place.joint; });
  if (same == model.reactions.end())
    return model.reactions.push_back(place), static_cast<int>(model.reactions.size()) - 1;
  return static_cast<int>(same - model.reactions.begin());
}

}  // namespace

bool measures_reaction(const scene::SceneDescription& scene, const std::string& link) {
  return std::any_of(scene.sensors.begin(), scene.sensors.end(), [&](const scene::Sensor& sensor) {
    return sensor.link == link && measures_reaction(sensor.kind);
  });
}

void place_sensors(const ScenePlan& plan, const std::vector<int>& slave_joint, Model& model) {
  for (const scene::Sensor& sensor : plan.scene.sensors) {
    const std::string where = at(sensor.location, "<sensor> '" + sensor.name + "'");
    const int link = plan.links[sensor.link];
    if (measures_section(sensor.kind) && !plan.meshes[link])
      throw ModelError(where + "link '" + sensor.link + "' has no <beam>");
    if (measures_reaction(sensor.kind) && link == plan.tree.root)
      throw ModelError(where + "no joint carries the root link '" + sensor.link + "'");
    SensorPlace place{probe_point(plan, model, sensor.link, sensor.at)};
    if (measures_reaction(sensor.kind)) place.reaction = reaction_of(model.links[link], slave_joint, model);
    model.sensors.push_back(place);
  }
}

}  // namespace flexarm
