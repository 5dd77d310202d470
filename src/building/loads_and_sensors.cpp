#include "building/passes.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "building/model_builder.h"

namespace flexarm {

// ---------------------------------------------------------------- loads

namespace {

class LoadBuilder {
 public:
  LoadBuilder(const ScenePlan& plan, const Model& model) : plan_(plan), model_(model), placed_{{}, model.histories} {}

  PlacedLoads place() {
    for (const scene::PointLoad& load : plan_.scene.loads) add(load);
    for (const scene::DistributedLoad& load : plan_.scene.distributed_loads) add(load);
    return std::move(placed_);
  }

 private:
  void add(const scene::PointLoad& load) {
    const Attachment link = attachment(plan_, model_, load.link, load.at);
    if (link.node < 0) throw ModelError(at(load.location, "<load>") + "link '" + load.link + "' is fixed to the world");
    NodalLoad out =
        load_on(link.node, link.offset, load.at, load.force, load.moment, load.frame == scene::LoadFrame::Follower);
    out.history = add_history(load.history);
    out.link = plan_.links[load.link];
    placed_.loads.push_back(out);
  }

  void add(const scene::DistributedLoad& load) {
    const int link = plan_.links[load.link];
    if (!plan_.meshes[link])
      throw ModelError(at(load.location, "<distributed_load>") + "link '" + load.link + "' has no <beam>");
    const BeamMesh& mesh = plan_.meshes[link]->mesh;
    const int history = add_history(load.history);
    // Lumped at nodes with the weights int I^i ds: exact for a dead load, and the nodes' Newton-Cotes rule for a
    // follower load.
    const std::vector<double> weights =
        length_weights(plan_, model_, link, load.from.value_or(0.0), load.to.value_or(model_.links[link].beam->length));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] == 0) continue;
      NodalLoad out;
      out.node = model_.links[link].frame.node + static_cast<int>(i);
      out.arm = -mesh.centroid;
      out.follows = load.frame == scene::LoadFrame::Follower;
      out.force = weights[i] * load.force;
      if (out.follows) out.force = mesh.nodes[i].pose.orientation.conjugate() * out.force;
      out.history = history;
      out.link = link;
      placed_.loads.push_back(out);
    }
  }

  int add_history(const TimeFunction& function) {
    placed_.histories.push_back(function);
    return static_cast<int>(placed_.histories.size()) - 1;
  }

  const ScenePlan& plan_;
  const Model& model_;
  PlacedLoads placed_;
};

}  // namespace

PlacedLoads place_loads(const ScenePlan& plan, const Model& model) {
  return LoadBuilder(plan, model).place();
}

// ---------------------------------------------------------------- probes

namespace {

/// A point of the link with this name. `point` is in the link's undeformed frame [m].
ProbePoint probe_point(const ScenePlan& plan, const Model& model, const std::string& name, const Vector3& point) {
  ProbePoint out;
  out.link = plan.links[name];
  const LinkFrame& link = model.links[out.link];
  const Pose at{point, Quaternion::Identity()};
  if (!link.beam) {
    out.attachment = {link.frame.node, link.frame.offset * at};
    return out;
  }
  const auto& [centreline, mesh] = *plan.meshes[out.link];
  const double s = centreline.nearest(point);
  const ElementPlace place = element_at(*link.beam, s);
  out.element = place.element;
  out.xi = place.xi;
  Pose section = centreline.at(s);
  section.position += section.orientation * mesh.centroid;
  out.offset = section.inverse() * at;
  return out;
}

}  // namespace

std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model) {
  std::vector<ProbePoint> probes;
  for (const scene::Probe& probe : plan.scene.probes) probes.push_back(probe_point(plan, model, probe.link, probe.at));
  return probes;
}

// ---------------------------------------------------------------- sensors

namespace {

using scene::SensedPlace;

SensedPlace place_of(const scene::Sensor& sensor) {
  return scene::traits_of(sensor.kind).place;
}

/// The joint whose reaction a sensor measures: the one that carries the link, or the loop joint that the sensor names.
ReactionPlace reaction_place(const ScenePlan& plan, const scene::Sensor& sensor, const LinkFrame& link,
                             const Mechanism& mechanism, const Model& model) {
  ReactionPlace place;
  // On a flexible link this is a point beside the nearest node; the sensor's own point follows (sensed_wrench()).
  place.point = attachment(plan, model, sensor.link, sensor.at);
  place.point.offset = place.point.offset * Pose{sensor.at, Quaternion::Identity()};
  if (sensor.joint.empty()) {
    place.joint = mechanism.slave_joint[link.frame.node];
    return place;
  }
  const auto& joints = plan.scene.loop_joints;
  const auto joint =
      std::find_if(joints.begin(), joints.end(), [&](const auto& each) { return each.name == sensor.joint; });
  if (joint == joints.end())
    throw ModelError(at(sensor.location, "<sensor> '" + sensor.name + "'") + "there is no loop joint '" + sensor.joint +
                     "'");
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
  assert(place.joint >= 0 || place.closure >= 0);
  return place;
}

/// Index of the tendon that a sensor measures, in the scene's list and the model's, which begins with these elements.
std::size_t tendon_of(const scene::SceneDescription& scene, const scene::Sensor& sensor) {
  const std::size_t found = find_force_element(scene, "tendon", sensor.tendon);
  if (found == scene.force_elements.size())
    throw ModelError(at(sensor.location, "<sensor> '" + sensor.name + "'") + "there is no tendon '" + sensor.tendon +
                     "'");
  return found;
}

/// Index into Model::reactions. Sensors of the same reaction at the same point share an entry.
int index_of(const ReactionPlace& place, Model& model) {
  const auto same = std::find(model.reactions.begin(), model.reactions.end(), place);
  const auto index = static_cast<int>(same - model.reactions.begin());
  if (same == model.reactions.end()) model.reactions.push_back(place);
  return index;
}

}  // namespace

bool measures_reaction(const scene::SceneDescription& scene, const std::string& link) {
  return std::any_of(scene.sensors.begin(), scene.sensors.end(), [&](const scene::Sensor& sensor) {
    return sensor.link == link && sensor.joint.empty() && place_of(sensor) == SensedPlace::Joint;
  });
}

void place_sensors(const ScenePlan& plan, const Mechanism& mechanism, Model& model) {
  for (const scene::Sensor& sensor : plan.scene.sensors) {
    const std::string where = at(sensor.location, "<sensor> '" + sensor.name + "'");
    const int link = plan.links[sensor.link];
    if (place_of(sensor) == SensedPlace::Section && !plan.meshes[link])
      throw ModelError(where + "link '" + sensor.link + "' has no <beam>");
    if (place_of(sensor) == SensedPlace::Joint && sensor.joint.empty() && link == plan.tree.root)
      throw ModelError(where + "no joint carries the root link '" + sensor.link + "'");
    SensorPlace place{probe_point(plan, model, sensor.link, sensor.at)};
    if (place_of(sensor) == SensedPlace::Joint)
      place.reaction = index_of(reaction_place(plan, sensor, model.links[link], mechanism, model), model);
    if (place_of(sensor) == SensedPlace::Tendon) place.force_element = tendon_of(plan.scene, sensor);
    model.sensors.push_back(place);
  }
}

void connect_contact_sensors(const scene::SceneDescription& scene, Model& model) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const scene::Sensor& sensor = scene.sensors[i];
    if (place_of(sensor) != SensedPlace::Touch) continue;
    const auto feels = [&](const std::string& name) {
      if (sensor.group.empty()) return name == sensor.link;
      return std::find(sensor.group.begin(), sensor.group.end(), name) != sensor.group.end();
    };
    bool is_touched = false;
    for (std::size_t k = 0; k < model.touching_pairs.size(); ++k) {
      const TouchingPair& pair = model.touching_pairs[k];
      const bool first = feels(pair.first), second = feels(pair.second);
      is_touched = is_touched || first || second;
      if (first != second) model.sensors[i].touched.push_back({k, first});  // within a group forces cancel
    }
    if (!is_touched)
      throw ModelError(at(sensor.location, "<sensor> '" + sensor.name + "'") + "no <contact> lets anything touch " +
                       (sensor.group.empty() ? "link '" + sensor.link + "'" : "its group"));
  }
}

}  // namespace flexarm
