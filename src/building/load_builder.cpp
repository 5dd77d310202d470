#include "building/load_builder.h"

#include <algorithm>
#include <utility>

#include "building/inertia_builder.h"
#include "building/model_builder.h"

namespace flexarm {
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
    // Lumped with the weights int I^i ds: exact for a dead load, the nodes' Newton-Cotes rule for a follower load.
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

std::vector<ProbePoint> place_probes(const ScenePlan& plan, const Model& model) {
  std::vector<ProbePoint> probes;
  for (const scene::Probe& probe : plan.scene.probes) probes.push_back(probe_point(plan, model, probe.link, probe.at));
  return probes;
}

}  // namespace flexarm
