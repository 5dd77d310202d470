#include "pictures/run_extent.h"

#include <Eigen/Geometry>

#include "pictures/shape_surface.h"

namespace flexarm::pictures {
namespace {

/// Points of a rigid link that its picture must show, in its frame.
std::vector<Vector3> shown_points(const Picture& picture, const PictureLink& link) {
  std::vector<Vector3> points;
  if (link.shapes.empty()) {
    points = link.stick;
    points.push_back(Vector3::Zero());
    return points;
  }
  Eigen::AlignedBox3d box;
  for (const PictureShape& shape : link.shapes) {
    const Eigen::AlignedBox3d around = box_around(shape, picture.meshes);
    for (int corner = 0; corner < 8; ++corner)
      box.extend(shape.pose * around.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  points.reserve(8);
  for (int corner = 0; corner < 8; ++corner)
    points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  return points;
}

/// Visits what an instant shows, in the order of its numbers.
class InstantVisitor {
 public:
  explicit InstantVisitor(const Picture& picture) : picture_(picture) {
    points_.reserve(picture.links.size());
    for (const PictureLink& link : picture.links)
      points_.push_back(link.beam < 0 ? shown_points(picture, link) : std::vector<Vector3>());
  }

  void visit(const std::vector<double>& values, const ExtentBallVisitor& visit) const {
    std::size_t at = 0;
    const auto place = [&] { return Vector3(values[at], values[at + 1], values[at + 2]); };
    for (std::size_t i = 0; i < points_.size(); ++i, at += 7) {
      const Pose pose{place(), Quaternion(values[at + 6], values[at + 3], values[at + 4], values[at + 5])};
      for (const Vector3& point : points_[i]) visit({pose * point, 0, picture_.links[i].is_fixed});
    }
    for (const PictureBeam& beam : picture_.beams)
      for (std::size_t k = 0; k < beam.sections.size(); ++k, at += 19)
        visit({place(), beam.tube, picture_.links[beam.link].is_fixed});
    for (std::size_t i = 0; i < picture_.probes.size(); ++i, at += 3) visit({place(), 0, false});
    for (const PictureLine& line : picture_.lines)
      for (std::size_t k = 0; k < line.points; ++k, at += 3) visit({place(), 0, false});
  }

 private:
  const Picture& picture_;
  std::vector<std::vector<Vector3>> points_;  ///< of each link
};

}  // namespace

SceneExtent run_extent(const Picture& picture, const std::vector<std::vector<double>>& instants) {
  const InstantVisitor instant(picture);
  return extent_around([&](const ExtentBallVisitor& visit) {
    for (const std::vector<double>& values : instants) instant.visit(values, visit);
  });
}

}  // namespace flexarm::pictures
