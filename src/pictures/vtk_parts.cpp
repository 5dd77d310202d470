#include "pictures/vtk_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pictures/recording.h"
#include "pictures/shape_surface.h"
#include "simulation/inside.h"
#include "simulation/observables.h"

namespace flexarm::pictures {
namespace {

/// ParaView connects the sections of a beam by straight lines.
constexpr int kFewestSectionsOfLine = 33;

void put(const Vector3& vector, std::vector<double>& values) {
  values.insert(values.end(), vector.data(), vector.data() + 3);
}

void put_in_floats(const Vector3& vector, std::vector<float>& values) {
  for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(vector[i]));
}

/// Velocities {v, w} of points of a beam, world axes.
std::vector<Vector6> velocities_of(const Simulation& simulation, std::size_t link,
                                   const std::vector<BeamPoint>& points) {
  const Model& model = model_of(simulation);
  const LinkFrame& frame = model.links[link];
  const Pose to_link = simulation.link_pose(link).inverse();
  std::vector<Vector6> velocities;
  for (const BeamPoint& point : points) {
    ProbePoint place;
    place.link = static_cast<int>(link);
    if (frame.beam) {
      const auto [element, xi] = element_at(*frame.beam, std::min(point.arc_length, frame.beam->length));
      place.element = element;
      place.xi = xi;
      place.offset.position = -frame.beam->centroid;
    } else {
      place.attachment = {frame.frame.node, frame.frame.offset * (to_link * point.pose)};
    }
    const ProbeState state = probe_state(model, state_of(simulation), node_velocities_of(simulation), place);
    velocities.emplace_back() << state.velocity, state.angular_velocity;
  }
  return velocities;
}

// ---------------------------------------------------------------- beams

class VtkBeams : public VtkPart {
 public:
  explicit VtkBeams(const Simulation& simulation)
      : VtkPart("beams"), names_(vtk_array("link_names", simulation.link_names())) {
    const std::vector<scene::LinkDescription>& links = simulation.scene().links;
    for (std::size_t i = 0; i < links.size(); ++i)
      if (links[i].beam) add_beam(simulation, i);
  }

  VtkPolyData show(const Simulation& simulation) override {
    values_ = {};
    VtkCells lines;
    std::vector<std::int32_t> links;
    for (const Beam& beam : beams_) {
      const std::size_t first = lines.points.size();
      points_.clear();
      simulation.beam_points(beam.link, beam.between, points_);
      add_points(simulation, beam);
      for (std::size_t k = 0; k < points_.size(); ++k) lines.points.push_back(static_cast<std::int64_t>(first + k));
      lines.ends.push_back(static_cast<std::int64_t>(lines.points.size()));
      links.push_back(static_cast<std::int32_t>(beam.link));
    }
    VtkPolyData data;
    data.point_count = lines.points.size();
    data.points = vtk_array("points", values_.position, 3);
    data.lines = vtk_cells(lines);
    data.line_count = links.size();
    data.field_data = {names_};
    data.point_data = point_data();
    data.cell_data = {vtk_array("link", links)};
    data.roles = "Scalars=\"edge_strain\"";
    return data;
  }

 private:
  struct Beam {
    std::size_t link;
    int between;  ///< sections between neighbouring nodes
    double radius;
  };
  /// Numbers of all points.
  struct Values {
    std::vector<double> position, arc_length, radius, edge_strain, strain, curvature, force, moment, force_in_world,
        moment_in_world, velocity, angular_velocity;
    std::array<std::vector<double>, 3> axes;
  };

  void add_beam(const Simulation& simulation, std::size_t link) {
    points_.clear();
    simulation.beam_points(link, 0, points_);
    const int intervals = static_cast<int>(points_.size()) - 1;
    if (intervals < 1) return;
    const int between = (kFewestSectionsOfLine - 2) / intervals;
    beams_.push_back({link, between, simulation.beam_radius(link)});
  }

  void add_points(const Simulation& simulation, const Beam& beam) {
    const std::vector<Vector6> velocities = velocities_of(simulation, beam.link, points_);
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const BeamPoint& point = points_[k];
      const Matrix3 axes = point.pose.orientation.toRotationMatrix();
      const Vector3 force = point.resultant.head<3>(), moment = point.resultant.tail<3>();
      put(point.pose.position, values_.position);
      values_.arc_length.push_back(point.arc_length);
      values_.radius.push_back(beam.radius);
      values_.edge_strain.push_back(edge_strain(point, beam.radius));
      put(point.strain.head<3>(), values_.strain);
      put(point.strain.tail<3>(), values_.curvature);
      put(force, values_.force);
      put(moment, values_.moment);
      put(axes * force, values_.force_in_world);
      put(axes * moment, values_.moment_in_world);
      put(velocities[k].head<3>(), values_.velocity);
      put(velocities[k].tail<3>(), values_.angular_velocity);
      for (int axis = 0; axis < 3; ++axis) put(axes.col(axis), values_.axes[axis]);
    }
  }

  std::vector<std::string> point_data() const {
    return {vtk_array("edge_strain", values_.edge_strain),
            vtk_array("arc_length", values_.arc_length),
            vtk_array("radius", values_.radius),
            vtk_array("strain", values_.strain, 3, {"axial", "shear y", "shear z"}),
            vtk_array("curvature", values_.curvature, 3, {"torsion", "bending y", "bending z"}),
            vtk_array("force", values_.force, 3, {"axial", "shear y", "shear z"}),
            vtk_array("moment", values_.moment, 3, {"torsion", "bending y", "bending z"}),
            vtk_array("force_in_world", values_.force_in_world, 3),
            vtk_array("moment_in_world", values_.moment_in_world, 3),
            vtk_array("velocity", values_.velocity, 3),
            vtk_array("angular_velocity", values_.angular_velocity, 3),
            vtk_array("section_x", values_.axes[0], 3),
            vtk_array("section_y", values_.axes[1], 3),
            vtk_array("section_z", values_.axes[2], 3)};
  }

  std::string names_;
  std::vector<Beam> beams_;
  std::vector<BeamPoint> points_;  // scratch: of one beam
  Values values_;                  // scratch
};

// ---------------------------------------------------------------- bodies

/// Surfaces of rigid links, and lines and balls of mass in the place of links without shapes.
class VtkBodies : public VtkPart {
 public:
  VtkBodies(const Simulation& simulation, const Picture& picture)
      : VtkPart("bodies"), names_(vtk_array("link_names", simulation.link_names())) {
    // Lines first, since VTK numbers them first.
    for (std::size_t i = 0; i < picture.links.size(); ++i)
      if (picture.links[i].beam < 0 && picture.links[i].shapes.empty()) add_lines(i, picture.links[i].stick);
    for (std::size_t i = 0; i < picture.links.size(); ++i) {
      const PictureLink& link = picture.links[i];
      if (link.beam >= 0) continue;
      for (const PictureShape& shape : link.shapes) add_surface(i, shape, picture.meshes);
      if (link.mass)
        add_surface(i,
                    {Pose{link.mass->at, Quaternion::Identity()},
                     scene::SphereShape{shown_radius(*link.mass, picture.extent.radius)},
                     {}},
                    picture.meshes);
    }
    constant_.point_count = points_.size();
    constant_.lines = vtk_cells(lines_);
    constant_.line_count = lines_.ends.size();
    constant_.polygons = vtk_cells(triangles_);
    constant_.polygon_count = triangles_.ends.size();
    constant_.field_data = {names_};
    constant_.cell_data = {vtk_array("link", links_), vtk_array("color", colors_, 4)};
  }

  VtkPolyData show(const Simulation& simulation) override {
    std::vector<float> positions, normals;
    for (const Point& point : points_) {
      const Pose pose = simulation.link_pose(point.link);
      put_in_floats(pose * point.position, positions);
      put_in_floats(pose.orientation * point.normal, normals);
    }
    VtkPolyData data = constant_;
    data.points = vtk_array("points", positions, 3);
    data.point_data = {vtk_array("Normals", normals, 3)};
    data.roles = "Normals=\"Normals\"";
    return data;
  }

 private:
  struct Point {
    std::size_t link;
    Vector3 position, normal;  ///< in the link's frame
  };
  static constexpr scene::Color kPlain = {0.75, 0.75, 0.75, 1};

  void add_cell(std::size_t link, const scene::Color& color, VtkCells& cells) {
    cells.ends.push_back(static_cast<std::int64_t>(cells.points.size()));
    links_.push_back(static_cast<std::int32_t>(link));
    for (const double part : color)
      colors_.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0))));
  }

  void add_lines(std::size_t link, const std::vector<Vector3>& ends) {
    for (const Vector3& end : ends) {
      for (const Vector3& point : {Vector3(Vector3::Zero()), end}) {
        lines_.points.push_back(static_cast<std::int64_t>(points_.size()));
        points_.push_back({link, point, Vector3::UnitZ()});
      }
      add_cell(link, kPlain, lines_);
    }
  }

  void add_surface(std::size_t link, const PictureShape& shape, const std::vector<PictureMesh>& meshes) {
    const meshes::SurfaceMesh surface = surface_of_shape(shape, meshes);
    const std::size_t first = points_.size();
    for (const auto& vertex : surface.vertices)
      points_.push_back({link, shape.pose * vertex.position, shape.pose.orientation * vertex.normal});
    for (const auto& triangle : surface.triangles) {
      for (const int vertex : triangle)
        triangles_.points.push_back(static_cast<std::int64_t>(first + static_cast<std::size_t>(vertex)));
      add_cell(link, shape.color.value_or(kPlain), triangles_);
    }
  }

  std::string names_;
  std::vector<Point> points_;
  VtkCells lines_, triangles_;
  std::vector<std::int32_t> links_;   // per cell
  std::vector<std::uint8_t> colors_;  // per cell
  VtkPolyData constant_;              // all but the points
};

// ---------------------------------------------------------------- springs and tendons

/// The lines along which springs between points and tendons act.
class VtkLines : public VtkPart {
 public:
  explicit VtkLines(const Picture& picture) : VtkPart("lines"), lines_(picture.lines) {
    std::vector<std::string> names, kinds;
    for (const PictureLine& line : lines_) {
      names.push_back(line.name);
      kinds.push_back(line.kind);
    }
    names_ = {vtk_array("line_names", names), vtk_array("line_kinds", kinds)};
  }

  VtkPolyData show(const Simulation& simulation) override {
    std::vector<double> positions, lengths, tensions, last_tensions;
    std::vector<std::int32_t> indices;
    VtkCells cells;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      simulation.line_points(lines_[i].element, points_);
      for (const Vector3& point : points_) {
        cells.points.push_back(static_cast<std::int64_t>(cells.points.size()));
        put(point, positions);
      }
      cells.ends.push_back(static_cast<std::int64_t>(cells.points.size()));
      indices.push_back(static_cast<std::int32_t>(i));
      outputs_.clear();
      put_out_force(simulation, lines_[i].element, outputs_);  // length, tension at the first point, at the last one
      lengths.push_back(outputs_.at(0));
      tensions.push_back(outputs_.at(1));
      last_tensions.push_back(outputs_.back());
    }
    VtkPolyData data;
    data.point_count = cells.points.size();
    data.points = vtk_array("points", positions, 3);
    data.lines = vtk_cells(cells);
    data.line_count = lines_.size();
    data.field_data = names_;
    data.cell_data = {vtk_array("line", indices), vtk_array("length", lengths), vtk_array("tension", tensions),
                      vtk_array("last_tension", last_tensions)};
    return data;
  }

 private:
  std::vector<PictureLine> lines_;
  std::vector<std::string> names_;
  std::vector<Vector3> points_;  // scratch
  std::vector<double> outputs_;  // scratch
};

// ---------------------------------------------------------------- wrenches

/// Forces and moments at points: efforts, loads, reactions, contacts.
class VtkWrenches : public VtkPart {
 public:
  VtkWrenches() : VtkPart("wrenches"), kinds_(vtk_array("kind_names", {kArrowNames.begin(), kArrowNames.end()})) {}

  VtkPolyData show(const Simulation& simulation) override {
    find_arrows(simulation, arrows_);
    std::vector<double> positions, forces, moments;
    std::vector<std::int32_t> kinds;
    VtkCells vertices;
    for (std::size_t kind = 0; kind < kArrowKinds; ++kind)
      for (const ActingWrench& arrow : arrows_[kind]) {
        put(arrow.position, positions);
        put(arrow.wrench.force, forces);
        put(arrow.wrench.moment, moments);
        vertices.points.push_back(static_cast<std::int64_t>(kinds.size()));
        kinds.push_back(static_cast<std::int32_t>(kind));
        vertices.ends.push_back(static_cast<std::int64_t>(kinds.size()));
      }
    VtkPolyData data;
    data.point_count = data.vertex_count = kinds.size();
    data.points = vtk_array("points", positions, 3);
    data.vertices = vtk_cells(vertices);
    data.field_data = {kinds_};
    data.point_data = {vtk_array("kind", kinds), vtk_array("force", forces, 3), vtk_array("moment", moments, 3)};
    return data;
  }

 private:
  std::string kinds_;
  Arrows arrows_;
};

}  // namespace

std::vector<std::unique_ptr<VtkPart>> vtk_parts(const Simulation& simulation, const Picture& picture) {
  std::vector<std::unique_ptr<VtkPart>> parts;
  parts.push_back(std::make_unique<VtkBeams>(simulation));
  parts.push_back(std::make_unique<VtkBodies>(simulation, picture));
  parts.push_back(std::make_unique<VtkLines>(picture));
  parts.push_back(std::make_unique<VtkWrenches>());
  return parts;
}

}  // namespace flexarm::pictures
