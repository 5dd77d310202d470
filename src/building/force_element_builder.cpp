#include "building/passes.h"

#include <algorithm>

#include <fmt/format.h>

#include "building/model_builder.h"

namespace flexarm {
namespace {

Vector3 position_of(const Model& model, const NodePoint& point) {
  if (point.node < 0) return point.arm;
  const NodePose& node = model.nodes[point.node];
  return node.position + node.rotation * point.arm;
}

}  // namespace

ForceElementList place_force_elements(const ScenePlan& plan, Model& model) {
  ForceElementList placed;
  for (const auto& element : plan.scene.force_elements) {
    scene::ForcePlacement placement;
    placement.nodes = &model.nodes;
    placement.origin = model.origin + model.initial_origin;
    std::vector<NodePoint>& places = placement.places;
    for (const scene::LinkPoint& point : element->points()) {
      const Attachment place = attachment(plan, model, point.link, point.at);
      places.push_back({place.node, place.offset * point.at, place.offset.orientation});
      placement.positions.push_back(position_of(model, places.back()));
    }
    const auto is_on_first = [&](const NodePoint& place) { return place.node == places.front().node; };
    if (std::all_of(places.begin(), places.end(), is_on_first))
      throw ModelError(at(element->location, fmt::format("<{}>", element->kind())) +
                       (places.size() == 2 ? "both ends belong" : "all points belong") + " to the same rigid body");
    for (TimeFunction& function : element->functions()) {
      placement.functions.push_back(static_cast<int>(model.histories.size()));
      model.histories.push_back(std::move(function));
    }
    placed.push_back(element->place(placement));
  }
  return placed;
}

}  // namespace flexarm
