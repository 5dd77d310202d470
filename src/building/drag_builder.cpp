#include <memory>
#include <utility>
#include <vector>

#include "building/passes.h"
#include "elements/air_drag.h"
#include "flexarm/model/model_error.h"

namespace flexarm {
namespace {

/// The drag on a rigid link acts at one place.
DragPlace place_of_rigid(const ScenePlan& plan, const Model& model, const scene::LinkDescription& link) {
  const scene::DragDescription& drag = *link.drag;
  const Vector3 at = drag.at.value_or(link.inertial ? link.inertial->center_of_mass : Vector3(Vector3::Zero()));
  const Attachment place = attachment(plan, model, link.name, at);
  if (place.node < 0)
    throw ModelError(flexarm::at(drag.location, "<drag>") + "link '" + link.name +
                     "' is part of the world, which cannot move");
  return {{place.node, place.offset * at, place.offset.orientation},
          0.5 * drag.density * drag.coefficient.cwiseProduct(*drag.area)};
}

/// The drag per length of a beam acts at its nodes, each with the length that belongs to it.
std::vector<DragPlace> places_of_beam(const ScenePlan& plan, const Model& model, int link) {
  const scene::DragDescription& drag = *plan.scene.links[link].drag;
  const BeamMesh& mesh = plan.meshes[link]->mesh;
  const LinkFrame& frame = model.links[link];
  const std::vector<double> lengths = length_weights(plan, model, link, 0, frame.beam->length);
  std::vector<DragPlace> places;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Eigen::Vector2d extent = mesh.section.at(mesh.nodes[i].arc_length).extent;
    const Vector3 width = drag.area.value_or(Vector3(0, extent[1], extent[0]));  // flow along y meets the height
    places.push_back({{frame.frame.node + static_cast<int>(i), -mesh.centroid, Quaternion::Identity()},
                      0.5 * drag.density * lengths[i] * drag.coefficient.cwiseProduct(width)});
  }
  return places;
}

}  // namespace

ForceElementList place_drags(const ScenePlan& plan, const Model& model) {
  ForceElementList placed;
  for (std::size_t i = 0; i < plan.scene.links.size(); ++i) {
    const scene::LinkDescription& link = plan.scene.links[i];
    if (!link.drag) continue;
    std::vector<DragPlace> places;
    if (plan.meshes[i])
      places = places_of_beam(plan, model, static_cast<int>(i));
    else
      places.push_back(place_of_rigid(plan, model, link));
    placed.push_back(std::make_shared<AirDrag>(link.name, std::move(places)));
  }
  return placed;
}

}  // namespace flexarm
