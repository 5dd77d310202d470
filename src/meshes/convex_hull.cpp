#include "meshes/convex_hull.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include <fmt/format.h>

extern "C" {  // needed before Qhull 2020, whose header has no extern "C"
#include <libqhull_r/qhull_ra.h>
}

namespace flexarm::meshes {
namespace {

/// Faces that are in one plane up to this, relative to the size, are merged. Mesh files have single precision.
constexpr double kFlat = 1e-6;

/// Owns Qhull's memory, which is large and therefore on the heap, and discards its messages.
class Qhull {
 public:
  Qhull() : silence_(std::fopen("/dev/null", "w"), std::fclose) { qh_zero(state(), silence_.get()); }
  ~Qhull() {
    qh_freeqhull(state(), !qh_ALL);
    int long_blocks = 0, total = 0;
    qh_memfreeshort(state(), &long_blocks, &total);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  qhT* state() { return state_.get(); }
  FILE* silence() { return silence_.get(); }

 private:
  std::unique_ptr<qhT> state_ = std::make_unique<qhT>();
  std::unique_ptr<FILE, int (*)(FILE*)> silence_;
};

double size_of(const std::vector<Vector3>& points) {
  double size = 0;
  for (const Vector3& point : points) size = std::max(size, (point - points.front()).norm());
  return size;
}

/// Orders the face's corners counterclockwise about its normal.
void orient(const std::vector<Vector3>& corners, Polytope::Face& face) {
  Vector3 area = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
    const Vector3& first = corners[face.corners[0]];
    area += (corners[face.corners[i]] - first).cross(corners[face.corners[i + 1]] - first);
  }
  if (area.dot(face.normal) < 0) std::reverse(face.corners.begin(), face.corners.end());
}

}  // namespace

Polytope convex_hull(const std::vector<Vector3>& points) {
  std::vector<double> coordinates;
  for (const Vector3& point : points) coordinates.insert(coordinates.end(), point.data(), point.data() + 3);
  Qhull qhull;
  qhT* const qh = qhull.state();
  std::string command = fmt::format("qhull C-{}", kFlat * size_of(points));
  if (points.size() < 4 || qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates.data(), False,
                                        command.data(), nullptr, qhull.silence()) != 0)
    throw FlatPoints();
  Polytope out;
  std::map<int, int> numbers;  // by index of the point: index of the corner
  facetT* facet;
  FORALLfacets {
    Polytope::Face face;
    face.normal = Eigen::Map<const Vector3>(facet->normal);
    face.offset = -facet->offset;
    setT* const round = qh_facet3vertex(qh, facet);
    vertexT *vertex, **vertexp;
    FOREACHvertex_(round) {
      const int point = qh_pointid(qh, vertex->point);
      const auto [place, is_new] = numbers.emplace(point, static_cast<int>(out.corners.size()));
      if (is_new) out.corners.push_back(points[static_cast<std::size_t>(point)]);
      face.corners.push_back(place->second);
    }
    setT* done = round;
    qh_settempfree(qh, &done);
    orient(out.corners, face);
    out.faces.push_back(std::move(face));
  }
  return out;
}

Polytope simple_hull(const std::vector<Vector3>& points, std::size_t most_corners) {
  Polytope whole = convex_hull(points);
  if (whole.corners.size() <= most_corners) return whole;
  const auto farthest = [&whole](const auto& height) {
    return *std::max_element(whole.corners.begin(), whole.corners.end(),
                             [&](const Vector3& one, const Vector3& other) { return height(one) < height(other); });
  };
  std::vector<Vector3> chosen;
  for (const Vector3& direction : {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)})
    chosen.push_back(farthest([&](const Vector3& corner) { return direction.dot(corner); }));
  // If the body is thin in some direction, these four may lie in one plane. So add the extreme corners along the axes.
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0})
      chosen.push_back(farthest([&](const Vector3& corner) { return sign * corner[axis]; }));
  while (true) {
    Polytope simple = convex_hull(chosen);
    if (chosen.size() >= most_corners) return simple;
    chosen.push_back(farthest([&](const Vector3& corner) {
      double height = 0;
      for (const Polytope::Face& face : simple.faces) height = std::max(height, height_over(face, corner));
      return height;
    }));
  }
}

}  // namespace flexarm::meshes
