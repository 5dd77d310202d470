#include "building/rigid_lines.h"

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>

#include "building/scene_plan.h"
#include "flexarm/model/model_error.h"
#include "math/local_rotation.h"
#include "model/beam_element.h"
#include "scene/flexible_link.h"

namespace flexarm {
namespace {

Matrix3 about_origin(const Matrix3& second_moment) {
  return second_moment.trace() * Matrix3::Identity() - second_moment;
}

/// Mass, first moment and inertia about the origin of the link, in its axes.
struct MassSum {
  double mass = 0;
  Vector3 moment = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();

  void add(double more, const Vector3& place, const Matrix3& about_place) {
    mass += more;
    moment += more * place;
    inertia += about_origin(more * place * place.transpose()) + about_place;
  }
  scene::RigidInertia about_center(const scene::SourceLocation& location) const {
    const Vector3 center = moment / mass;
    return {mass, center, inertia - about_origin(mass * center * center.transpose()), location};
  }
};

/// The resultant of a force per length of one, in any direction: its size, and where it acts.
struct Resultant {
  double length = 0;                 ///< [m]
  Vector3 moment = Vector3::Zero();  ///< first moment of the reference line about the link's origin, int r ds [m^2]
};

/// Sums over the elements of a line's mesh.
class LineSums {
 public:
  LineSums(const scene::BeamDescription& beam, const BeamMesh& mesh) : beam_(beam), mesh_(mesh) {}

  /// Mass and inertia of the line, without hubs.
  MassSum line_mass() const {
    MassSum sum;
    for_each([&](const auto& element, const auto& nodes, double, double) { add(element, nodes, sum); });
    return sum;
  }

  void add_hubs(MassSum& sum) const {
    for (const scene::HubDescription& hub : beam_.hubs) {
      const bool is_start = hub.end == scene::HubDescription::End::Start;
      const Pose& node = is_start ? mesh_.nodes.front().pose : mesh_.nodes.back().pose;
      sum.add(hub.mass, node * Vector3(-mesh_.centroid), hub.inertia.asDiagonal());
    }
  }

  Resultant resultant(double from, double to) const {
    Resultant sum;
    for_each([&](const auto& element, const auto& nodes, double begin, double end) {
      if (0.5 * (begin + end) < from || 0.5 * (begin + end) > to) return;
      for (const auto& point : element.mass_points) {
        sum.length += point.weight;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          sum.moment += point.weight * point.shape[i] * (nodes[i] * Vector3(-mesh_.centroid));
      }
    });
    return sum;
  }

 private:
  /// Calls `visit(element, poses of its nodes, arc length at its beginning, at its end)` for each element.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const BeamGroups orders;
    for_each_group(orders, [&](const auto& group) {
      constexpr int kNodes = std::decay_t<decltype(group)>::kNodes;
      if (mesh_.order + 1 != kNodes) return;
      double begin = 0;
      for (const MeshElement& element : mesh_.elements) {
        std::array<Pose, kNodes> nodes;
        for (int i = 0; i < kNodes; ++i) nodes[i] = mesh_.nodes[element.nodes[i]].pose;
        visit(beam_element<kNodes>(mesh_, element, beam_), nodes, begin, element.end);
        begin = element.end;
      }
    });
  }

  /// Uses the element's mass matrix, so that the integration is the same as in motion.
  template <int Nodes, class Poses>
  static void add(const BeamElement<Nodes>& element, const Poses& nodes, MassSum& sum) {
    Eigen::Matrix<double, 3, Nodes> places;
    std::array<Quaternion, Nodes> orientations;
    for (int i = 0; i < Nodes; ++i) {
      places.col(i) = nodes[i].position;
      orientations[i] = nodes[i].orientation;
    }
    sum.mass += element.mass.sum();
    sum.moment += places * element.mass.rowwise().sum();
    sum.inertia += about_origin(places * element.mass * places.transpose());
    const LocalRotations<Nodes> local(orientations);
    for (const auto& point : element.mass_points) {
      const Matrix3 section = local.evaluate(point.shape, point.derivative).rotation;
      sum.inertia += point.weight * section * point.inertia * section.transpose();
    }
  }

  const scene::BeamDescription& beam_;
  const BeamMesh& mesh_;
};

RigidLine rigid_line(const BeamMesh& mesh, double mass) {
  RigidLine line;
  line.mass = mass;
  line.radius = mesh.section.largest_radius();
  for (const MeshNode& node : mesh.nodes) {
    if (node.welded_to >= 0) continue;  // the same place with another section
    line.arc_lengths.push_back(node.arc_length);
    line.sections.push_back({node.pose * Vector3(-mesh.centroid), node.pose.orientation});
  }
  return line;
}

/// Refuses properties of the beam itself that make no sense without elements.
void require_rigid(const scene::LinkDescription& link) {
  const scene::BeamDescription& beam = *link.beam;
  const std::string where = at(beam.location, "<beam> of link '" + link.name + "'");
  const auto is_given = [](const std::optional<TimeFunction>& strain) { return strain.has_value(); };
  if (std::any_of(beam.prestrain.begin(), beam.prestrain.end(), is_given))
    throw ModelError(where + "with elements=\"0\" it is rigid, and <prestrain> would bend it");
  if (beam.mass_proportional_damping > 0)
    throw ModelError(where + "with elements=\"0\" it is rigid, and mass-proportional <damping> acts upon elements");
  if (link.drag) throw ModelError(where + "with elements=\"0\" it is rigid, and <drag> acts upon elements");
}

/// Refuses whatever needs sections that bend.
void require_no_sections(const scene::SceneDescription& scene) {
  const auto require_flexible = [&](const scene::SourceLocation& location, const std::string& element,
                                    const std::string& name) {
    const auto link = std::find_if(scene.links.begin(), scene.links.end(),
                                   [&](const scene::LinkDescription& each) { return each.name == name; });
    if (link != scene.links.end() && link->beam && !is_flexible(*link))
      throw ModelError(at(location, element) + "the <beam> of link '" + name + "' is rigid: it has elements=\"0\"");
  };
  for (const scene::JointDescription& joint : scene.joints)
    if (joint.slide) require_flexible(joint.slide->location, "<slide> of joint '" + joint.name + "'", joint.parent);
  for (const scene::Sensor& sensor : scene.sensors)
    if (scene::traits_of(sensor.kind).place == scene::SensedPlace::Section)
      require_flexible(sensor.location, "<sensor> '" + sensor.name + "'", sensor.link);
}

/// Makes one link rigid, and turns loads that are distributed along it into loads at points. Returns the link's line.
RigidLine stiffen(scene::LinkDescription& link, scene::SceneDescription& scene) {
  require_rigid(link);
  scene::BeamDescription beam = *link.beam;
  beam.elements.reset();
  link.beam = beam;
  auto& loads = scene.distributed_loads;
  const auto first = std::stable_partition(loads.begin(), loads.end(),
                                           [&](const scene::DistributedLoad& load) { return load.link != link.name; });
  const Centreline centreline = centreline_of(link);
  std::vector<double> borders;
  for (auto load = first; load != loads.end(); ++load)
    for (const double end : ends_of(*load, centreline)) borders.push_back(end);
  const BeamMesh mesh = mesh_of(link, centreline, borders);
  const LineSums sums(beam, mesh);
  for (auto load = first; load != loads.end(); ++load) {
    const Resultant sum = sums.resultant(load->from.value_or(0.0), load->to.value_or(centreline.length()));
    if (sum.length == 0) continue;
    scene.loads.push_back({link.name, sum.moment / sum.length, sum.length * load->force, Vector3::Zero(), load->frame,
                           load->history, load->location});
  }
  loads.erase(first, loads.end());
  MassSum mass = sums.line_mass();
  RigidLine line = rigid_line(mesh, mass.mass);
  sums.add_hubs(mass);
  link.inertial = mass.about_center(beam.location);
  link.beam.reset();
  return line;
}

}  // namespace

RigidLines::RigidLines(const scene::SceneDescription& original) : scene(original), lines(original.links.size()) {
  require_no_sections(original);
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (scene::LinkDescription& link = scene.links[i]; link.beam && !is_flexible(link)) lines[i] = stiffen(link, scene);
}

}  // namespace flexarm
