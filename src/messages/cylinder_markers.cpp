#include "messages/cylinder_markers.h"

#include <algorithm>
#include <variant>

#include "flexarm/scene/scene_description.h"
#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/markers.h"

namespace flexarm::messages {

CylinderMarkers::CylinderMarkers(const Simulation& simulation) : simulation_(simulation) {
  const scene::SceneDescription& scene = simulation.scene();
  for (const scene::JointDescription& hinge : scene.joints)
    if (hinge.is_hidden) add_parts(hinge.child);
  for (const scene::JointDescription& pin : scene.loop_joints)
    if (pin.is_hidden) add_parts(pin.parent);
}

void CylinderMarkers::add_parts(const std::string& link) {
  const std::vector<std::string>& names = simulation_.link_names();
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), link) - names.begin());
  for (const scene::VisualDescription& visual : simulation_.scene().links[index].visuals)
    if (std::holds_alternative<scene::CylinderShape>(visual.shape)) parts_.push_back({index, visual});
}

void CylinderMarkers::add_to(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) const {
  for (const Part& part : parts_) {
    visualization_msgs::Marker marker =
        make_marker(header, simulation_.link_names()[part.link], visualization_msgs::Marker::CYLINDER);
    const auto& shape = std::get<scene::CylinderShape>(part.visual.shape);
    marker.pose = to_pose(simulation_.link_pose(part.link) * part.visual.origin);
    marker.scale.x = marker.scale.y = 2 * shape.radius;
    marker.scale.z = shape.length;
    if (const auto& color = part.visual.color)
      marker.color = make_color((*color)[0], (*color)[1], (*color)[2], (*color)[3]);
    message.markers.push_back(marker);
  }
}

}  // namespace flexarm::messages
