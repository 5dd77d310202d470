#include "building/beam_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "elements/beam_point.h"
#include "math/quadrature.h"
#include "math/shape_functions.h"

namespace flexarm {
namespace {

/// Displacements of the centre of mass that are round-off of a table of numbers, relative to the section's size.
constexpr double kCentroidTolerance = 1e-6;

/// For each order: number of elements by the frequency rule, and largest turning per element [rad]. See
/// automatic_element_count().
constexpr int kFrequencyElements[] = {0, 45, 9, 5, 3};
constexpr double kTurningPerElement[] = {0, 0.139, 1.05, 1.58, 3.15};

/// More elements than any mesh may have.
constexpr int kTooMany = 1000000000;

/// `count` rounded up to a whole number, at most kTooMany.
int rounded_up(double count) {
  return static_cast<int>(std::min<double>(std::ceil(count), kTooMany));
}

/// Arc length of node i of an element; exactly `to` for the last one.
double at_node(double from, double to, int order, int i) {
  const double xi = node_coordinate(order + 1, i);
  return 0.5 * (1 - xi) * from + 0.5 * (1 + xi) * to;
}

/// Increasing arc lengths of the borders between elements: both ends, the borders of pieces exactly where they are (a
/// kink is looked for there), and attachments that do not coincide with any of these.
std::vector<double> borders(const Centreline& centreline, const std::vector<double>& attachments) {
  std::vector<double> fixed = centreline.piece_ends(), sorted = attachments, all;
  fixed.push_back(0);
  std::sort(fixed.begin(), fixed.end());
  std::sort(sorted.begin(), sorted.end());
  const double tolerance = 1e-9 * centreline.length();
  const auto is_fixed = [&](double s) {
    const auto next = std::lower_bound(fixed.begin(), fixed.end(), s - tolerance);
    return next != fixed.end() && *next <= s + tolerance;
  };
  for (const double s : sorted)
    if (!is_fixed(s) && (all.empty() || s > all.back() + tolerance)) all.push_back(s);
  const auto middle = all.insert(all.end(), fixed.begin(), fixed.end());
  std::inplace_merge(all.begin(), middle, all.end());
  return all;
}

/// Distributes `count` elements over intervals in proportion to `demand`, at least one each (largest remainder).
std::vector<int> distribute(int count, const std::vector<double>& demand) {
  std::vector<int> elements(demand.size(), 1);
  if (!(std::accumulate(demand.begin(), demand.end(), 0.0) > 0)) return elements;
  const auto is_less_needy = [&](std::size_t a, std::size_t b) {
    const double of_a = demand[a] / elements[a], of_b = demand[b] / elements[b];
    return of_a < of_b || (of_a == of_b && a > b);
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(is_less_needy)> intervals(is_less_needy);
  for (std::size_t i = 0; i < demand.size(); ++i) intervals.push(i);
  for (int rest = count - static_cast<int>(demand.size()); rest > 0; --rest) {
    const std::size_t neediest = intervals.top();
    intervals.pop();
    ++elements[neediest];
    intervals.push(neediest);
  }
  return elements;
}

/// Input numbers that are valid one by one may make a section too stiff, too weak or too heavy to compute with.
void require_measurable(const SectionProperties& section, double length) {
  const auto is_measurable = [](double value) { return value > 0 && std::isfinite(value); };
  const Vector6 diagonal = section.stiffness.diagonal();
  if (!std::all_of(diagonal.data(), diagonal.data() + 6, is_measurable) || !section.stiffness.allFinite() ||
      !section.inertia.allFinite() || !is_measurable(section.mass) || !is_measurable(section.mass * length))
    throw std::invalid_argument(fmt::format(
        "its section's stiffness and mass must be positive finite numbers (EA = {}, GA = {} and {}, GJ = {}, EI = {} "
        "and {}, mass per length = {})",
        diagonal[0], diagonal[1], diagonal[2], diagonal[3], diagonal[4], diagonal[5], section.mass));
}

/// Number of elements for each interval between borders, if the beam leaves it to flexarm.
std::vector<int> automatic_element_counts(int order, const Centreline& centreline, const std::vector<double>& border,
                                          const std::vector<double>& length) {
  const int straight = automatic_element_count(order, 0);
  std::vector<int> counts;
  for (std::size_t k = 0; k < length.size(); ++k) {
    const int share = rounded_up(straight * length[k] / centreline.length() - 1e-9);
    const double turning = centreline.turning(border[k], border[k + 1]);
    counts.push_back(std::max({1, share, rounded_up(turning / kTurningPerElement[order])}));
  }
  return counts;
}

/// @throws std::invalid_argument if `count` is more than `most`
void require_room(double count, int most) {
  if (count > most)
    throw std::invalid_argument(fmt::format("its mesh would have {}{} elements, but at most {} are possible here",
                                            count < kTooMany ? "" : "more than ", std::min<double>(count, kTooMany),
                                            most));
}

/// Number of elements for each interval between borders.
std::vector<int> element_counts(const scene::BeamDescription& beam, const Centreline& centreline,
                                const std::vector<double>& border, const std::vector<double>& length, int most) {
  if (beam.elements) {
    require_room(*beam.elements, most);
    return distribute(*beam.elements, length);
  }
  std::vector<int> counts = automatic_element_counts(beam.order, centreline, border, length);
  require_room(std::accumulate(counts.begin(), counts.end(), 0.0), most);
  return counts;
}

}  // namespace

int automatic_element_count(int order, double turning) {
  return std::max(kFrequencyElements[order], rounded_up(turning / kTurningPerElement[order]));
}

double turning_per_element(int order) {
  return kTurningPerElement[order];
}

int BeamMesh::node_at(double arc_length) const {
  // Arc lengths ascend. Of the two nodes of a kink, and of two nodes that are equally near, the first one is taken.
  const auto first_from = [&](double s) {
    return std::lower_bound(nodes.begin(), nodes.end(), s,
                            [](const MeshNode& node, double value) { return node.arc_length < value; });
  };
  auto best = first_from(arc_length);
  if (best != nodes.begin()) {
    const auto before = first_from(std::prev(best)->arc_length);
    const double distance = arc_length - before->arc_length;
    if (best == nodes.end() || !(best->arc_length - arc_length < distance * (1 - 1e-12))) best = before;
  }
  return static_cast<int>(best - nodes.begin());
}

BeamMesh mesh_beam(const scene::BeamDescription& beam, const Centreline& centreline,
                   const std::vector<double>& attachments, int most) {
  BeamMesh mesh;
  mesh.section = SectionLine(beam.section);
  const SectionProperties first = mesh.section.at(0);
  mesh.centroid = first.center_of_mass;
  require_measurable(first, centreline.length());
  for (const double s : mesh.section.stations()) {
    const SectionProperties section = mesh.section.at(s);
    require_measurable(section, centreline.length());
    if ((section.center_of_mass - mesh.centroid).norm() > kCentroidTolerance * section.radius)
      throw std::invalid_argument(
          fmt::format("its centre of mass must be in the same place in all sections: it is y = {}, z = {} at the "
                      "first station, but at {} m it is y = {}, z = {}",
                      mesh.centroid[1], mesh.centroid[2], s, section.center_of_mass[1], section.center_of_mass[2]));
  }
  mesh.order = beam.order;

  const std::vector<double> border = borders(centreline, attachments);
  std::vector<double> length;
  for (std::size_t k = 0; k + 1 < border.size(); ++k) length.push_back(border[k + 1] - border[k]);
  const std::vector<int> counts = element_counts(beam, centreline, border, length, most);

  const auto add_node = [&](double s, bool before, int welded_to) {
    Pose pose = centreline.at(s, before);
    pose.position += pose.orientation * mesh.centroid;
    if (!mesh.nodes.empty())
      pose.orientation = so3::nearer_of_two(pose.orientation, mesh.nodes.back().pose.orientation);
    mesh.nodes.push_back({s, pose, welded_to});
    return static_cast<int>(mesh.nodes.size()) - 1;
  };
  std::set<std::pair<int, int>> halved;
  for (const scene::HalvedPart& part : beam.halved) halved.emplace(part.element, part.part);
  int last = add_node(0, false, -1), given = 0;
  const std::function<void(double, double, int)> add_part = [&](double from, double to, int part) {
    if (halved.count({given, part}) > 0) {
      const double middle = at_node(from, to, 2, 1);
      add_part(from, middle, 2 * part);
      add_part(middle, to, 2 * part + 1);
      return;
    }
    MeshElement element;
    element.nodes.push_back(last);
    for (int i = 1; i <= beam.order; ++i)
      element.nodes.push_back(last = add_node(at_node(from, to, beam.order, i), true, -1));
    element.end = to;
    element.part = {given, part};
    mesh.elements.push_back(element);
  };
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (k > 0 && centreline.is_kink(border[k])) last = add_node(border[k], false, last);
    for (int e = 0; e < counts[k]; ++e) {
      // The last element ends exactly at the interval's end: slightly beyond a kink, the section has another frame.
      const double from = border[k] + length[k] * e / counts[k];
      const double to = e + 1 < counts[k] ? border[k] + length[k] * (e + 1) / counts[k] : border[k + 1];
      add_part(from, to, 1);
      ++given;
    }
  }
  require_room(static_cast<double>(mesh.elements.size()), most);
  return mesh;
}

template <int Nodes>
BeamElement<Nodes> beam_element(const BeamMesh& mesh, const MeshElement& element, const scene::BeamDescription& beam) {
  BeamElement<Nodes> out;
  out.stiffness_damping = beam.stiffness_proportional_damping;
  out.damping_scale = beam.damping_shares.cwiseSqrt();
  out.mass_damping = beam.mass_proportional_damping;
  out.maxwell.reserve(beam.maxwell.size());
  for (const scene::MaxwellElement& branch : beam.maxwell)
    out.maxwell.push_back({branch.modulus_ratio, branch.relaxation_time});

  std::array<Vector3, Nodes> centroid, reference;
  NodalValues<Nodes> arc_length;
  std::array<Quaternion, Nodes> orientation;
  for (int i = 0; i < Nodes; ++i) {
    const Pose& pose = mesh.nodes[element.nodes[i]].pose;
    centroid[i] = pose.position;
    reference[i] = pose.position - pose.orientation * mesh.centroid;
    orientation[i] = pose.orientation;
    arc_length[i] = mesh.nodes[element.nodes[i]].arc_length;
  }
  const LocalRotations<Nodes> local(orientation);
  // Stiffness and inertia are per length of the reference line, so weights and derivatives are in its arc length, too.
  const auto point = [&](double xi, double weight, NodalValues<Nodes>& shape, NodalValues<Nodes>& derivative,
                         double& out_weight) {
    const ShapeFunctions<Nodes> functions = lagrange<Nodes>(xi);
    const double jacobian = interpolate<Nodes>(functions.derivatives, reference).norm();
    shape = functions.values;
    derivative = functions.derivatives / jacobian;
    out_weight = weight * jacobian;
  };
  using Stiffness = GaussLegendre<Nodes - 1>;
  using Mass = GaussLegendre<Nodes>;
  for (int k = 0; k < Nodes - 1; ++k) {
    auto& p = out.stiffness_points[k];
    point(Stiffness::points[k], Stiffness::weights[k], p.shape, p.derivative, p.weight);
    p.stiffness = referred_to_center_of_mass(mesh.section.at(p.shape.dot(arc_length))).stiffness;
    p.reference_strain = point_kinematics(local.evaluate(p.shape, p.derivative),
                                          interpolate<Nodes>(p.derivative, centroid), Vector6::Zero())
                             .strain;
  }
  out.mass.setZero();
  for (int k = 0; k < Nodes; ++k) {
    auto& p = out.mass_points[k];
    point(Mass::points[k], Mass::weights[k], p.shape, p.derivative, p.weight);
    const SectionProperties section = mesh.section.at(p.shape.dot(arc_length));
    p.inertia = section.inertia;
    out.mass += section.mass * p.weight * p.shape * p.shape.transpose();
  }
  return out;
}

template BeamElement<2> beam_element<2>(const BeamMesh&, const MeshElement&, const scene::BeamDescription&);
template BeamElement<3> beam_element<3>(const BeamMesh&, const MeshElement&, const scene::BeamDescription&);
template BeamElement<4> beam_element<4>(const BeamMesh&, const MeshElement&, const scene::BeamDescription&);
template BeamElement<5> beam_element<5>(const BeamMesh&, const MeshElement&, const scene::BeamDescription&);

}  // namespace flexarm
