#include "pictures/picture.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>

#include "pictures/shape_surface.h"
#include "pictures/surface_meshes.h"
#include "scene/joint_kinds.h"

namespace flexarm::pictures {
namespace {

/// A beam has at least so many sections. Between them the page draws cubic curves.
constexpr int kFewestSections = 7;

/// Whether the joint's axis is a direction of the link that it carries, whatever its position.
bool has_axis(scene::JointKind kind) {
  return scene::traits_of(kind).axes == 1 && kind != scene::JointKind::Slide;
}

/// The box of even density with this inertia, if a body can have it.
std::optional<PictureShape> equal_box(const scene::RigidInertia& inertia) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(inertia.inertia);
  Matrix3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  const Vector3 moments = solver.eigenvalues();
  // A moment is m (b^2 + c^2) / 12 of the other two edges.
  const Vector3 squares = 6 / inertia.mass * (Vector3::Constant(moments.sum()) - 2 * moments);
  if (!(inertia.mass > 0) || !squares.allFinite() || !(squares.minCoeff() > 0)) return std::nullopt;
  return PictureShape{{inertia.center_of_mass, Quaternion(axes)}, scene::BoxShape{squares.cwiseSqrt()}, {}};
}

class PictureMaker {
 public:
  PictureMaker(const Simulation& simulation, const std::vector<ResultColumn>& columns)
      : simulation_(simulation), scene_(simulation.scene()) {
    picture_.name = scene_.name;
    picture_.gravity = scene_.gravity;
    picture_.probes = scene_.probes;
    picture_.grounds = scene_.grounds;
    picture_.columns = columns;
    for (std::size_t i = 0; i < scene_.links.size(); ++i) links_[scene_.links[i].name] = static_cast<int>(i);
  }

  Picture make() {
    for (std::size_t i = 0; i < scene_.links.size(); ++i) add_link(i);
    for (const scene::JointDescription& joint : scene_.joints) add_joint(joint);
    add_sticks();
    replace_lost_meshes();
    complete_bare_links();
    for (std::size_t i = 0; i < scene_.force_elements.size(); ++i)
      if (const std::size_t points = simulation_.most_line_points(i); points > 1)
        picture_.lines.push_back({scene_.force_elements[i]->kind(), scene_.force_elements[i]->name, i, points});
    picture_.extent = scene_extent(simulation_, shown_points());
    return std::move(picture_);
  }

 private:
  void add_link(std::size_t index) {
    const scene::LinkDescription& link = scene_.links[index];
    picture_.links.push_back({link.name});
    picture_.links.back().is_fixed = is_fixed(simulation_, index);
    add_beam(index);
    for (const scene::VisualDescription& visual : link.visuals) {
      const std::string failure = add_shape(visual, picture_.links.back());
      if (!failure.empty()) lost_meshes_.push_back({index, std::get<scene::MeshShape>(visual.shape).url, failure});
    }
  }

  /// Notes which meshes are missing. What stands for a rigid link without any other shape: shapes that touch others, or
  /// a box with the same inertia.
  void replace_lost_meshes() {
    std::vector<std::string> substitutes(picture_.links.size());
    for (const LostMesh& lost : lost_meshes_) {
      PictureLink& link = picture_.links[lost.link];
      std::string& substitute = substitutes[lost.link];
      if (link.beam < 0 && link.shapes.empty()) substitute = add_substitute(lost.link);
      picture_.notes.push_back(fmt::format("link '{}': the mesh '{}' is not shown{}: {}", link.name, lost.url,
                                           substitute.empty() ? "" : ", but " + substitute, lost.failure));
    }
  }

  /// Returns what it is.
  std::string add_substitute(std::size_t index) {
    const scene::LinkDescription& link = scene_.links[index];
    PictureLink& shown = picture_.links[index];
    for (const scene::VisualDescription& shape : link.collisions) add_shape(shape, shown);
    if (!shown.shapes.empty()) return "its <collision>";
    if (const auto box = link.inertial ? equal_box(*link.inertial) : std::nullopt) {
      shown.shapes.push_back(*box);
      return "a box with its mass and inertia";
    }
    constexpr double kPartOfDistance = 0.15, kSmall = 0.02;  // of the nearest child; without one [m]
    double distance = std::numeric_limits<double>::infinity();
    for (const Vector3& point : shown.stick)
      if (point.norm() > 0) distance = std::min(distance, point.norm());
    const double radius = std::isfinite(distance) ? kPartOfDistance * distance : kSmall;
    const Vector3 place = link.inertial ? link.inertial->center_of_mass : Vector3::Zero();
    shown.shapes.push_back({{place, Quaternion::Identity()}, scene::SphereShape{radius}, {}});
    return "a sphere";
  }

  void add_beam(std::size_t index) {
    std::vector<BeamPoint> points;
    const auto count = [&](int between) {
      points.clear();
      simulation_.beam_points(index, between, points);
      return static_cast<int>(points.size());
    };
    if (!scene_.links[index].beam) return;
    const int intervals = count(0) - 1;
    if (intervals < 1) return;
    const int between = std::max(0, (kFewestSections - 2) / intervals);
    count(between);
    picture_.links.back().beam = static_cast<int>(picture_.beams.size());
    PictureBeam beam{
        index, {}, simulation_.undeformed_sections(index, between), simulation_.beam_radius(index), between};
    for (const BeamPoint& point : points) beam.arc_lengths.push_back(point.arc_length);
    beam.tube = tube_radius(*scene_.links[index].beam, beam);
    picture_.beams.push_back(std::move(beam));
  }

  /// The radius of a section that is only known by its stiffness is that of a circle with the same stiffness, and may
  /// be large. Such a beam is drawn slender.
  static double tube_radius(const scene::BeamDescription& given, const PictureBeam& beam) {
    constexpr double kSlender = 1.0 / 60;
    const bool has_shape = !std::holds_alternative<scene::DirectSection>(given.section) &&
                           !std::holds_alternative<scene::MatrixSection>(given.section);
    return has_shape ? beam.radius : std::min(beam.radius, kSlender * beam.arc_lengths.back());
  }

  /// Returns why a shape cannot be shown; empty: it is.
  std::string add_shape(const scene::VisualDescription& visual, PictureLink& link) {
    if (scene::is_point(visual)) return "";
    PictureShape shape{visual.origin, {}, visual.color};
    try {
      std::visit(
          [&](const auto& given) {
            if constexpr (std::is_same_v<std::decay_t<decltype(given)>, scene::MeshShape>)
              shape.shape = mesh_index(given);
            else
              shape.shape = given;
          },
          visual.shape);
      link.shapes.push_back(std::move(shape));
      return {};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  std::size_t mesh_index(const scene::MeshShape& mesh) {
    const auto same = [&](const PictureMesh& known) { return known.name == mesh.url && known.scale == mesh.scale; };
    auto known = std::find_if(picture_.meshes.begin(), picture_.meshes.end(), same);
    if (known == picture_.meshes.end())
      known = picture_.meshes.insert(known, {mesh.url, mesh.scale, surface_of_mesh(mesh, scene_.file)});
    return static_cast<std::size_t>(known - picture_.meshes.begin());
  }

  void add_joint(const scene::JointDescription& joint) {
    const int parent = links_.at(joint.parent), child = links_.at(joint.child);
    picture_.links[child].parent = parent;
    if (joint.is_hidden) return;
    PictureJoint shown{joint.name, scene::traits_of(joint.kind).name, static_cast<std::size_t>(child), {}, {}};
    if (has_axis(joint.kind)) shown.axis = joint.axis;
    for (std::size_t i = 0; i < picture_.columns.size(); ++i)
      if (is_of(joint, picture_.columns[i].name)) shown.columns.push_back(i);
    picture_.joints.push_back(std::move(shown));
  }

  void add_sticks() {
    std::vector<std::vector<Vector3>> places = carried_places(simulation_);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (picture_.links[i].beam < 0) picture_.links[i].stick = std::move(places[i]);
  }

  void complete_bare_links() {
    for (std::size_t i = 0; i < picture_.links.size(); ++i) {
      PictureLink& link = picture_.links[i];
      if (link.beam >= 0 || !link.shapes.empty()) continue;
      // Shapes that touch others stand for those that are missing. A mesh among them that cannot be read is told
      // elsewhere, if it has contact.
      for (const scene::VisualDescription& shape : scene_.links[i].collisions) add_shape(shape, link);
      if (!link.shapes.empty()) continue;
      link.mass = mass_ball(scene_.links[i]);
      if (link.mass) link.stick.push_back(link.mass->at);
    }
  }

  /// Probes, and corners of boxes around shapes, in the frames of their links.
  std::vector<std::vector<Vector3>> shown_points() const {
    std::vector<std::vector<Vector3>> points(picture_.links.size());
    for (const scene::Probe& probe : scene_.probes) points[links_.at(probe.link)].push_back(probe.at);
    for (std::size_t link = 0; link < points.size(); ++link)
      for (const PictureShape& shape : picture_.links[link].shapes) {
        const Eigen::AlignedBox3d box = box_around(shape, picture_.meshes);
        for (int corner = 0; corner < 8; ++corner)
          points[link].push_back(shape.pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      }
    return points;
  }

  static bool is_of(const scene::JointDescription& joint, const std::string& column) {
    const auto& suffixes = scene::coordinate_suffixes(joint);
    return std::any_of(suffixes.begin(), suffixes.end(), [&](const std::string& suffix) {
      const std::string prefix = "joint/" + joint.name + suffix + "/";
      return column.compare(0, prefix.size(), prefix) == 0 && column.find('/', prefix.size()) == std::string::npos;
    });
  }

  const Simulation& simulation_;
  const scene::SceneDescription& scene_;
  struct LostMesh {
    std::size_t link;
    std::string url, failure;
  };
  std::map<std::string, int> links_;
  std::vector<LostMesh> lost_meshes_;
  Picture picture_;
};

}  // namespace

Picture picture_of(const Simulation& simulation, const std::vector<ResultColumn>& columns) {
  return PictureMaker(simulation, columns).make();
}

}  // namespace flexarm::pictures
