#include "messages/legend.h"

#include <cmath>

#include <fmt/format.h>

#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/markers.h"
#include "messages/picture_axes.h"
#include "messages/triangle_mesh.h"
#include "pictures/color_scale.h"

namespace flexarm::messages {
namespace {

// Lengths per radius of the scene.
constexpr double kDistance = 1.4;  ///< from the scene's centre
constexpr double kBarCentre = 0.75, kHalfHeight = 0.12;
constexpr double kBarRadius = 0.018;
constexpr double kLegendTextHeight = 0.055;
constexpr double kTextDistance = 0.14;  ///< from the bar
constexpr double kLine = 0.08;          ///< from one line of text to the next

constexpr const char* kName = "legend";

class Legend {
 public:
  Legend(const std_msgs::Header& header, const pictures::SceneExtent& extent, visualization_msgs::MarkerArray& message)
      : header_(header), extent_(extent), message_(message) {}

  void add_bar(double largest) {
    const auto height = [](double part) { return kBarCentre + (2 * part - 1) * kHalfHeight; };
    const Quaternion upright = Quaternion::FromTwoVectors(Vector3::UnitX(), axes_.up);
    constexpr std::size_t kParts = pictures::kColorsOfAmounts.size() - 1;  // between them, colours are linear
    std::vector<Pose> sections;
    sections.reserve(kParts + 1);
    for (std::size_t k = 0; k <= kParts; ++k)
      sections.push_back({place(0, height(static_cast<double>(k) / static_cast<double>(kParts))), upright});
    const TriangleMesh mesh = tube_mesh(sections, std::vector<double>(sections.size(), kBarRadius * extent_.radius));
    visualization_msgs::Marker bar = next(visualization_msgs::Marker::TRIANGLE_LIST);
    draw(mesh, bar);
    const double foot = place(0, height(0)).dot(axes_.up), whole = place(0, height(1)).dot(axes_.up) - foot;
    for (const TriangleMesh::Triangle& triangle : mesh.triangles)
      for (const int corner : triangle) {
        const auto& [position, normal] = mesh.vertices[corner];
        bar.colors.push_back(lit(strain_color((position.dot(axes_.up) - foot) / whole), normal));
      }
    message_.markers.push_back(bar);
    for (const double part : {0.0, 0.5, 1.0})
      add_text(-kTextDistance, height(part), fmt::format("{:.2g} %", 100 * part * largest));
    add_text(0, height(1) + 2 * kLegendTextHeight, "edge strain");
  }

  /// Adds samples of arrows below the bar.
  void add_arrows(const ArrowScale& scale, const std::vector<ArrowKind>& kinds) {
    double height = kBarCentre - kHalfHeight - kLine;
    if (scale.force > 0) {
      add_sample({place(-0.5 * kLongestArrow, height), {scale.force * axes_.right, Vector3::Zero()}}, scale);
      height -= kLine;
      add_text(0, height, fmt::format("{:.2g} N", scale.force));
    }
    if (scale.moment > 0) {
      height -= kLargestCircle + 0.5 * kLine;
      add_sample({place(0, height), {Vector3::Zero(), scale.moment * axes_.to_camera}}, scale);
      height -= kLargestCircle + 0.5 * kLine;
      add_text(0, height, fmt::format("{:.2g} N m", scale.moment));
    }
    if (scale.force == 0 && scale.moment == 0) return;
    for (const ArrowKind& kind : kinds) add_text(0, height -= kLine, kind.name, kind.color);
  }

 private:
  visualization_msgs::Marker next(int type) { return make_marker(header_, kName, type, ++last_id_); }
  /// A point in the plane of the picture; coordinates per radius of the scene.
  Vector3 place(double right, double up) const {
    return extent_.center + extent_.radius * ((right - kDistance) * axes_.right + up * axes_.up);
  }
  void add_text(double right, double up, const std::string& text,
                const std_msgs::ColorRGBA& color = make_color(1, 1, 1)) {
    visualization_msgs::Marker marker = next(visualization_msgs::Marker::TEXT_VIEW_FACING);
    marker.pose.position = to_point(place(right, up));
    marker.scale.z = kLegendTextHeight * extent_.radius;
    marker.color = color;
    marker.text = text;
    message_.markers.push_back(marker);
  }
  void add_sample(const ActingWrench& wrench, const ArrowScale& scale) {
    visualization_msgs::Marker marker = next(visualization_msgs::Marker::TRIANGLE_LIST);
    draw(arrow_mesh(wrench, scale, extent_.radius), marker);
    add_if_any(std::move(marker), message_);
  }

  const std_msgs::Header& header_;
  const pictures::SceneExtent& extent_;
  const PictureAxes axes_ = picture_axes();
  visualization_msgs::MarkerArray& message_;
  int last_id_ = 0;
};

}  // namespace

void add_legend(const std_msgs::Header& header, const pictures::SceneExtent& extent, const LegendContent& content,
                visualization_msgs::MarkerArray& message) {
  Legend legend(header, extent, message);
  if (content.largest_strain) legend.add_bar(*content.largest_strain);
  legend.add_arrows(content.arrows, content.kinds);
}

}  // namespace flexarm::messages
