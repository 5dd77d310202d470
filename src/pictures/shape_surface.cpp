#include "pictures/shape_surface.h"

#include <cmath>
#include <type_traits>
#include <variant>

#include "math/pi.h"

namespace flexarm::pictures {
namespace {

constexpr int kSides = 32, kBands = 20;

Vector3 around(int side, int sides) {
  const double angle = 2 * kPi * side / sides;
  return {std::cos(angle), std::sin(angle), 0};
}

/// Adds a grid of `rows` times `columns` vertices, of which the rows go upwards and the columns counter-clockwise as
/// seen from above. `vertex(row, column)` is at that place of the grid.
template <class Vertex>
void add_grid(int rows, int columns, const Vertex& vertex, SurfaceMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size());
  const auto index = [&](int row, int column) { return first + row * columns + column; };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      mesh.vertices.push_back(vertex(row, column));
      if (row == 0 || column == 0) continue;
      const int corner = index(row, column), left = index(row, column - 1);
      const int below = index(row - 1, column), opposite = index(row - 1, column - 1);
      mesh.triangles.push_back({opposite, below, corner});
      mesh.triangles.push_back({opposite, corner, left});
    }
}

}  // namespace

SurfaceMesh box_surface(const scene::BoxShape& box) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Vector3 normal = sign * Vector3::Unit(axis), across = Vector3::Unit((axis + 1) % 3);
      const Vector3 up = normal.cross(across);
      add_grid(
          2, 2,
          [&](int row, int column) {
            const Vector3 corner = normal + (2 * column - 1) * across + (2 * row - 1) * up;
            return SurfaceMesh::Vertex{0.5 * box.size.cwiseProduct(corner), normal};
          },
          mesh);
    }
  return mesh;
}

SurfaceMesh cylinder_surface(const scene::CylinderShape& cylinder, int sides) {
  SurfaceMesh mesh;
  const Vector3 top = 0.5 * cylinder.length * Vector3::UnitZ();
  add_grid(
      2, sides + 1,
      [&](int row, int column) {
        return SurfaceMesh::Vertex{cylinder.radius * around(column, sides) + (2 * row - 1) * top,
                                   around(column, sides)};
      },
      mesh);
  for (const int sign : {-1, 1}) {
    const int centre = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back({sign * top, sign * Vector3::UnitZ()});
    for (int side = 0; side <= sides; ++side) {
      mesh.vertices.push_back({cylinder.radius * around(sign * side, sides) + sign * top, sign * Vector3::UnitZ()});
      if (side > 0) mesh.triangles.push_back({centre, centre + side, centre + side + 1});
    }
  }
  return mesh;
}

SurfaceMesh sphere_surface(const scene::SphereShape& sphere, int sides, int bands) {
  SurfaceMesh mesh;
  add_grid(
      bands + 1, sides + 1,
      [&](int row, int column) {
        const double latitude = kPi * (static_cast<double>(row) / bands - 0.5);
        const Vector3 normal = std::cos(latitude) * around(column, sides) + std::sin(latitude) * Vector3::UnitZ();
        return SurfaceMesh::Vertex{sphere.radius * normal, normal};
      },
      mesh);
  return mesh;
}

SurfaceMesh surface_of_shape(const PictureShape& shape, const std::vector<PictureMesh>& meshes) {
  struct {
    const std::vector<PictureMesh>& meshes;
    SurfaceMesh operator()(const scene::BoxShape& box) const { return box_surface(box); }
    SurfaceMesh operator()(const scene::CylinderShape& cylinder) const { return cylinder_surface(cylinder, kSides); }
    SurfaceMesh operator()(const scene::SphereShape& sphere) const { return sphere_surface(sphere, kSides, kBands); }
    SurfaceMesh operator()(std::size_t mesh) const { return meshes[mesh].surface; }
  } const surface{meshes};
  return std::visit(surface, shape.shape);
}

Eigen::AlignedBox3d box_around(const PictureShape& shape, const std::vector<PictureMesh>& meshes) {
  Eigen::AlignedBox3d box;
  const auto add_half = [&](const Vector3& half) { box.extend(half).extend(-half); };
  std::visit(
      [&](const auto& given) {
        using Shape = std::decay_t<decltype(given)>;
        if constexpr (std::is_same_v<Shape, scene::BoxShape>) add_half(0.5 * given.size);
        if constexpr (std::is_same_v<Shape, scene::SphereShape>) add_half(Vector3::Constant(given.radius));
        if constexpr (std::is_same_v<Shape, scene::CylinderShape>)
          add_half({given.radius, given.radius, 0.5 * given.length});
        if constexpr (std::is_same_v<Shape, std::size_t>)
          for (const auto& vertex : meshes[given].surface.vertices) box.extend(vertex.position);
      },
      shape.shape);
  return box;
}

}  // namespace flexarm::pictures
