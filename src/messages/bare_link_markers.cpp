#include "messages/bare_link_markers.h"

#include <utility>
#include <variant>

#include "flexarm/scene/scene_description.h"
#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/markers.h"
#include "pictures/bare_links.h"

namespace flexarm::messages {
namespace {

constexpr const char* kBareLinks = "masses";
constexpr double kStickWidth = 0.012;  ///< per radius of the scene
const std_msgs::ColorRGBA kBareLinkColor = make_color(0.56, 0.6, 0.66);

visualization_msgs::Marker shape_marker(const std_msgs::Header& header, const scene::VisualDescription& visual,
                                        int id) {
  visualization_msgs::Marker marker = make_marker(header, kBareLinks, visualization_msgs::Marker::CUBE, id);
  const auto set = [&](int type, const Vector3& size) {
    marker.type = type;
    marker.scale = to_vector3(size);
  };
  if (const auto* box = std::get_if<scene::BoxShape>(&visual.shape)) set(visualization_msgs::Marker::CUBE, box->size);
  if (const auto* ball = std::get_if<scene::SphereShape>(&visual.shape))
    set(visualization_msgs::Marker::SPHERE, Vector3::Constant(2 * ball->radius));
  if (const auto* cylinder = std::get_if<scene::CylinderShape>(&visual.shape))
    set(visualization_msgs::Marker::CYLINDER, {2 * cylinder->radius, 2 * cylinder->radius, cylinder->length});
  marker.color = kBareLinkColor;
  return marker;
}

}  // namespace

BareLinkMarkers::BareLinkMarkers(const Simulation& simulation, double scene_radius)
    : simulation_(simulation), stick_width_(kStickWidth * scene_radius) {
  const std::vector<scene::LinkDescription>& links = simulation.scene().links;
  std::vector<std::vector<Vector3>> places = pictures::carried_places(simulation);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].beam || !links[i].visuals.empty()) continue;
    BareLink bare{i, {}, {}};
    for (const scene::VisualDescription& shape : links[i].collisions)
      if (!std::holds_alternative<scene::MeshShape>(shape.shape) && !scene::is_point(shape))
        bare.shapes.push_back(shape);
    if (bare.shapes.empty()) {
      bare.ends = std::move(places[i]);
      if (const auto mass = pictures::mass_ball(links[i])) {
        const double radius = pictures::shown_radius(*mass, scene_radius);
        bare.shapes.push_back({{mass->at, Quaternion::Identity()}, scene::SphereShape{radius}});
        bare.ends.push_back(mass->at);
      }
    }
    links_.push_back(std::move(bare));
  }
}

void BareLinkMarkers::add_to(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) const {
  visualization_msgs::Marker lines = make_marker(header, kBareLinks, visualization_msgs::Marker::LINE_LIST);
  lines.scale.x = stick_width_;
  lines.color = kBareLinkColor;
  int id = 0;
  for (const BareLink& bare : links_) {
    const Pose pose = simulation_.link_pose(bare.link);
    for (const Vector3& end : bare.ends) {
      lines.points.push_back(to_point(pose.position));
      lines.points.push_back(to_point(pose * end));
    }
    for (const scene::VisualDescription& shape : bare.shapes) {
      message.markers.push_back(shape_marker(header, shape, ++id));
      message.markers.back().pose = to_pose(pose * shape.origin);
    }
  }
  add_if_any(std::move(lines), message);
}

}  // namespace flexarm::messages
