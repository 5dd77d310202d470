#include "simulation/observables.h"

#include <algorithm>
#include <limits>

#include "elements/element_configuration.h"
#include "joints/joint_kinematics.h"
#include "joints/servo_step.h"
#include "math/pi.h"
#include "math/shape_functions.h"
#include "math/so3.h"
#include "model/carried_origin.h"
#include "simulation/beam_sections.h"

namespace flexarm {
namespace {

/// Pose of a section at the parent coordinate xi; nodes are on the mass centroid.
template <int Nodes>
Pose section_pose(const std::array<Vector3, Nodes>& positions, const LocalRotations<Nodes>& local, double xi) {
  const ShapeFunctions<Nodes> functions = lagrange<Nodes>(xi);
  const Matrix3 rotation = local.evaluate(functions.values, functions.derivatives).rotation;
  return {interpolate<Nodes>(functions.values, positions), Quaternion(rotation).normalized()};
}

/// Value at xi of the polynomial through the values at the stiffness points.
template <int Nodes>
Vector6 extended(const std::array<Vector6, Nodes - 1>& values, double xi) {
  const std::array<double, Nodes - 1> weights = extension_weights<Nodes>(xi);
  Vector6 sum = Vector6::Zero();
  for (int a = 0; a < Nodes - 1; ++a) sum += weights[a] * values[a];
  return sum;
}

/// Converts strain and resultant from the mass centroid, which is at c in the section, to the reference line. With
/// r = r_c - Lambda c it follows that Gamma = Gamma_c + c x K, and, since the virtual work is the same, N = N_c,
/// M = M_c + c x N.
void set_stress(const Vector6& strain, const Vector6& resultant, const Vector3& centroid, BeamPoint& point) {
  point.strain = strain;
  point.strain.head<3>() += centroid.cross(strain.tail<3>());
  point.resultant = resultant;
  point.resultant.tail<3>() += centroid.cross(point.resultant.head<3>());
}

/// The quantities that all points of an element share.
template <int Nodes>
struct DeformedElement {
  DeformedElement(const Model& model, const BeamElement<Nodes>& element, const State& state)
      : nodes(element, state), local(nodes.orientation) {
    const Vector6 prestrain = prestrain_at(model, element.prestrain, state.time);
    for (int k = 0; k < Nodes - 1; ++k) {
      strains[k] = centroid_strain(element, nodes, local, state, k);
      Vector6 elastic = strains[k] - prestrain;
      const Vector6* branch = branch_strains(model, state, element.first_stiffness_point + k);
      for (const MaxwellBranch& maxwell : element.maxwell) elastic += maxwell.modulus_ratio * *branch++;
      resultants[k] = element.stiffness_points[k].stiffness * elastic;
    }
  }

  /// Strain and resultant at xi, without the pose. `centroid`: its place in the section. `begin`, `end`: arc lengths of
  /// the element's ends [m].
  BeamPoint stress(double xi, const Vector3& centroid, double begin, double end) const {
    BeamPoint point;
    point.arc_length = begin + 0.5 * (1 + xi) * (end - begin);
    set_stress(extended<Nodes>(strains, xi), extended<Nodes>(resultants, xi), centroid, point);
    return point;
  }
  BeamPoint point(double xi, const Vector3& centroid, double begin, double end) const {
    BeamPoint point = stress(xi, centroid, begin, end);
    point.pose = section_pose<Nodes>(nodes.position, local, xi);
    point.pose.position = point.pose * Vector3(-centroid);
    return point;
  }

  ElementConfiguration<Nodes> nodes;
  LocalRotations<Nodes> local;
  std::array<Vector6, Nodes - 1> strains, resultants;
};

/// Calls `visit(deformed element, xi, arc length of the element's beginning, of its end)` for every node of the scene's
/// elements, and for `between` points inside each pair of neighbouring nodes. These points are the same however
/// elements are halved now.
template <class Visit>
void visit_points(const Model& model, const State& state, const BeamLink& beam, int between, const Visit& visit) {
  for (std::size_t first = 0, behind = 0; first < beam.elements.size(); first = behind) {
    while (behind < beam.parts.size() && beam.parts[behind].element == beam.parts[first].element) ++behind;
    const auto begin_of = [&](std::size_t e) { return e == 0 ? 0.0 : beam.element_ends[e - 1]; };
    const double begin = begin_of(first), end = beam.element_ends[behind - 1];
    const int nodes = beam.order + 1, steps = beam.order * (between + 1);
    int k = first == 0 ? 0 : 1;  // the number of the next point
    for (std::size_t e = first; e < behind; ++e)
      visit_element(model, beam, static_cast<int>(e), [&](const auto& element) {
        constexpr int N = std::decay_t<decltype(element)>::kNodes;
        const DeformedElement<N> deformed(model, element, state);
        const double from = begin_of(e), to = beam.element_ends[e];
        for (; k <= steps; ++k) {
          const int pair = std::min(k / (between + 1), N - 2);
          const double left = node_coordinate(nodes, pair), right = node_coordinate(nodes, pair + 1);
          double xi = left + (right - left) * (k - pair * (between + 1)) / (between + 1);
          if (behind - first > 1) {  // from the whole element to its part
            const double at = begin + 0.5 * (1 + xi) * (end - begin);
            if (e + 1 < behind && at > to + 1e-12 * (end - begin)) return;
            xi = 2 * (at - from) / (to - from) - 1;
          }
          visit(deformed, xi, from, to);
        }
      });
  }
}

}  // namespace

void beam_points(const Model& model, const State& state, const BeamLink& beam, int between,
                 std::vector<BeamPoint>& points) {
  visit_points(model, state, beam, between, [&](const auto& element, double xi, double begin, double end) {
    points.push_back(element.point(xi, beam.centroid, begin, end));
  });
}

void rigid_points(const RigidLine& line, const Pose& link, std::vector<BeamPoint>& points) {
  for (std::size_t i = 0; i < line.sections.size(); ++i) {
    BeamPoint& point = points.emplace_back();
    point.arc_length = line.arc_lengths[i];
    point.pose = link * line.sections[i];
    point.resultant.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

std::vector<Pose> undeformed_sections(const Model& model, const LinkFrame& link, int between) {
  const State state = initial_state(model);
  const Pose to_link = attached_pose(state, link.frame).inverse();
  std::vector<Pose> sections;
  visit_points(model, state, *link.beam, between, [&](const auto& element, double xi, double begin, double end) {
    sections.push_back(to_link * element.point(xi, link.beam->centroid, begin, end).pose);
  });
  return sections;
}

EdgeStrain largest_edge_strain(const Model& model, const State& state, const BeamLink& beam) {
  EdgeStrain largest;
  visit_points(model, state, beam, 0, [&](const auto& element, double xi, double begin, double end) {
    const BeamPoint point = element.stress(xi, beam.centroid, begin, end);
    if (const double strain = edge_strain(point, beam.radius); strain > largest.amount)
      largest = {strain, point.arc_length};
  });
  return largest;
}

namespace {

/// The sum of the bends between neighbouring nodes of an element; 0 if it cannot be more than `limit` [rad].
template <class Element>
double element_bending(const Model& model, const State& state, const Element& element, double limit) {
  std::array<Quaternion, Element::kNodes - 1> now, undeformed;
  double bound = 0;
  for (int k = 0; k + 1 < Element::kNodes; ++k) {
    const int first = element.nodes[k], second = element.nodes[k + 1];
    now[k] = state.nodes[first].orientation.conjugate() * state.nodes[second].orientation;
    undeformed[k] = model.nodes[first].orientation.conjugate() * model.nodes[second].orientation;
    const Quaternion turn = undeformed[k].conjugate() * now[k];
    bound += turn.w() > 0 ? kPi * turn.vec().norm() : 2 * kPi;  // phi <= pi sin(phi / 2) up to pi
  }
  if (bound <= limit) return 0;
  double angle = 0;
  for (int k = 0; k + 1 < Element::kNodes; ++k)
    angle += (so3::unfolded_log(now[k]) - so3::unfolded_log(undeformed[k])).template tail<2>().norm();
  return angle;
}

}  // namespace

ElementBending most_bent_element(const Model& model, const State& state, const BeamLink& beam, double limit) {
  ElementBending most{limit, 0};
  for (std::size_t e = 0; e < beam.elements.size(); ++e)
    visit_element(model, beam, static_cast<int>(e), [&](const auto& element) {
      const double angle = element_bending(model, state, element, most.angle);
      if (angle > most.angle) most = {angle, e};
    });
  return most.angle > limit ? most : ElementBending();
}

BeamPoint section_point(const Model& model, const State& state, const BeamLink& beam, int element, double xi) {
  const double begin = element == 0 ? 0.0 : beam.element_ends[element - 1], end = beam.element_ends[element];
  BeamPoint point;
  visit_element(model, beam, element, [&](const auto& data) {
    constexpr int N = std::decay_t<decltype(data)>::kNodes;
    point = DeformedElement<N>(model, data, state).point(xi, beam.centroid, begin, end);
  });
  return point;
}

double fibre_strain(const Model& model, const State& state, const ProbePoint& point) {
  const BeamLink& beam = *model.links[point.link].beam;
  const Vector6 strain = section_point(model, state, beam, point.element, point.xi).strain;
  // The sensor's offset is from the mass centroid, the strain is about the reference line.
  const Vector3 beside = beam.centroid + point.offset.position;
  return strain[0] + strain.tail<3>().cross(beside)[0];
}

Pose attached_pose(const State& state, const Attachment& attachment) {
  if (attachment.node < 0) return attachment.offset;
  const NodeState& node = state.nodes[attachment.node];
  return Pose{node.position, node.orientation} * attachment.offset;
}

Pose probe_pose(const Model& model, const State& state, const ProbePoint& probe) {
  if (probe.element < 0) return attached_pose(state, probe.attachment);
  Pose pose;
  visit_element(model, *model.links[probe.link].beam, probe.element, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    pose = section_pose<N>(nodes.position, LocalRotations<N>(nodes.orientation), probe.xi) * probe.offset;
  });
  return pose;
}

Vector3 probe_origin(const Model& model, const State& state, const ProbePoint& probe) {
  const bool is_on_world = probe.element < 0 && probe.attachment.node < 0;
  return is_on_world ? model.origin : world_origin(model, state);
}

Pose pose_in_world(const Model& model, const State& state, const ProbePoint& probe) {
  Pose pose = probe_pose(model, state, probe);
  pose.position += probe_origin(model, state, probe);
  return pose;
}

ProbeState probe_state(const Model& model, const State& state, const std::vector<Vector6>& velocities,
                       const ProbePoint& probe) {
  ProbeState out;
  if (probe.element < 0) {
    out.pose = attached_pose(state, probe.attachment);
    if (probe.attachment.node < 0) return out;
    const Vector6& node = velocities[probe.attachment.node];
    const Vector3 arm = out.pose.position - state.nodes[probe.attachment.node].position;
    out.angular_velocity = node.tail<3>();
    out.velocity = node.head<3>() + out.angular_velocity.cross(arm);
    return out;
  }
  visit_element(model, *model.links[probe.link].beam, probe.element, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotations<N> local(nodes.orientation);
    const Pose section = section_pose<N>(nodes.position, local, probe.xi);
    out.pose = section * probe.offset;
    const ShapeFunctions<N> functions = lagrange<N>(probe.xi);
    GeneralisedShapeFunctions<N> generalised;
    LocalRotationVariation<N>(local).evaluate(functions.values, functions.derivatives, generalised);
    for (int i = 0; i < N; ++i) {
      const Vector6& node = velocities[element.nodes[i]];
      out.velocity += functions.values[i] * node.head<3>();
      out.angular_velocity += generalised.values[i] * node.tail<3>();
    }
    out.velocity += out.angular_velocity.cross(out.pose.position - section.position);
  });
  return out;
}

State initial_state(const Model& model, double time) {
  State state;
  state.time = time;
  state.nodes.resize(model.nodes.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    node.position = model.nodes[i].position;
    node.orientation = model.nodes[i].orientation;
    node.velocity = model.initial_velocity[i].head<3>();
    node.angular_velocity = node.orientation.conjugate() * Vector3(model.initial_velocity[i].tail<3>());
  }
  state.origin = model.initial_origin;
  state.halved = model.halved;
  state.released = model.initial_released;
  state.study.mass_points.resize(model.mass_point_count);
  state.study.strain_rates.assign(model.stiffness_point_count, Vector6::Zero());
  state.branch_strains.assign(static_cast<std::size_t>(model.stiffness_point_count) * model.maxwell_branches,
                              Vector6::Zero());
  state.commands.assign(model.coordinates.size(), std::numeric_limits<double>::quiet_NaN());
  state.efforts.assign(model.coordinates.size(), 0.0);
  state.drives.resize(model.coordinates.size());
  state.transmitted.resize(6 * model.reactions.size());
  state.last_transmitted.assign(6 * model.reactions.size(), 0.0);
  state.samples.resize(model.sensors.size());
  std::size_t memory = 0;
  for (const auto& element : model.force_elements) memory += element->memory_size();
  state.force_memory.assign(memory, 0.0);
  double* own_memory = state.force_memory.data();
  std::vector<double> functions;
  for (const auto& element : model.force_elements) {
    functions.clear();
    for (const int history : element->functions()) functions.push_back(model.histories[history](state.time));
    element->start(state, functions.data(), own_memory);
    own_memory += element->memory_size();
  }
  state.rests.assign(model.coordinates.size(), 0.0);
  for (const Actuator& actuator : model.actuators) {
    const Coordinate& coordinate = model.coordinates[actuator.coordinate];
    const Released& released = model.initial_released[coordinate.joint];
    const ReleasedVector rates = released_rates(model, coordinate.joint, model.nodes, released, model.initial_velocity);
    ActuatorState& own = state.actuators.emplace_back();
    own.angle = released.displacement[coordinate.component % 3];
    own.rate = rates[coordinate.component];
    if (actuator.servo) {
      own.servo.outputs.assign(outputs_of(*actuator.servo), 0.0);
      own.servo.delayed_rate = -own.rate;
      own.servo.measured = own.angle - actuator.servo->sample_time * own.rate;
    }
    if (actuator.gyroscope) {
      const auto& [node, axis, inertia, ratio] = *actuator.gyroscope;
      own.rate += axis.dot(state.nodes[node].angular_velocity) / ratio;
    }
  }
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    const ElementConfiguration<N> nodes(element, state);
    const LocalRotationVariation<N> local{LocalRotations<N>(nodes.orientation)};
    for (int k = 0; k < N; ++k) {
      const auto& point = element.mass_points[k];
      GeneralisedShapeFunctions<N> generalised;
      const Matrix3 rotation = local.evaluate(point.shape, point.derivative, generalised).rotation;
      Vector3 spin = Vector3::Zero();
      for (int i = 0; i < N; ++i)
        spin += generalised.values[i] * model.initial_velocity[element.nodes[i]].template tail<3>();
      state.study.mass_points[element.first_mass_point + k].angular_velocity = rotation.transpose() * spin;
    }
  });
  return state;
}

}  // namespace flexarm
