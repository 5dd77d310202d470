#include "flexarm/simulation/driven_ends.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "building/section.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// An end has no inertia to speak of below this part of what the joint moves, if it is also too fast for the step
/// [rad].
constexpr double kSmallPart = 1e-2, kFast = 1;

/// An end of a beam.
struct BeamEnd {
  std::size_t link;
  double arc_length, element_length;  // of the last element there [m]
};

std::optional<BeamEnd> beam_end(const Model& model, int node) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const LinkFrame& link = model.links[i];
    if (!link.beam || node < 0 || (link.frame.node != node && link.beam->tip.node != node)) continue;
    const std::vector<double>& ends = link.beam->element_ends;
    const bool is_start = link.frame.node == node;
    const double before = ends.size() > 1 ? ends[ends.size() - 2] : 0;
    return is_start ? BeamEnd{i, 0, ends.front()} : BeamEnd{i, ends.back(), ends.back() - before};
  }
  return std::nullopt;
}

/// About an axis through a node, in world axes, of what is lumped at the node or rigidly fixed to it [kg m^2].
double own_inertia(const Model& model, int node, const Vector3& axis) {
  const auto about = [&](int at) {
    const NodalInertia& inertia = model.inertias[at];
    const Vector3 own = model.nodes[at].rotation.transpose() * axis;
    const Vector3 arm = axis.cross(model.nodes[at].position - model.nodes[node].position);
    return own.dot((inertia.rotary + inertia.beam_rotary) * own) + inertia.mass * arm.squaredNorm();
  };
  double sum = about(node);
  for (const JointMap& joint : model.joints)
    if (joint.kind == JointMapKind::Rigid && joint.master == node) sum += about(joint.slave);
  return sum;
}

/// Nodes that a joint moves: its slave and what is joined to that by elements and further joints.
std::vector<bool> moved_nodes(const Model& model, const JointMap& joint) {
  std::vector<bool> moves(model.nodes.size(), false);
  moves[joint.slave] = true;
  for (bool grows = true; grows;) {
    grows = false;
    const auto add = [&](int node) {
      grows = grows || !moves[node];
      moves[node] = true;
    };
    for_each_element(model.beams, [&](const auto& element) {
      if (std::any_of(element.nodes.begin(), element.nodes.end(), [&](int node) { return moves[node]; }))
        std::for_each(element.nodes.begin(), element.nodes.end(), add);
    });
    for (const JointMap& other : model.joints)
      if (other.master >= 0 && moves[other.master]) add(other.slave);
  }
  return moves;
}

/// About an axis at a joint, of all that the joint moves [kg m^2].
double moved_inertia(const Model& model, const JointMap& joint, const Vector3& axis) {
  const Vector3 origin = moved_origin(joint, model.nodes[joint.slave]);
  const std::vector<bool> moves = moved_nodes(model, joint);
  double sum = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!moves[i]) continue;
    const NodalInertia& inertia = model.inertias[i];
    const Vector3 own = model.nodes[i].rotation.transpose() * axis;
    sum += inertia.total_mass * axis.cross(model.nodes[i].position - origin).squaredNorm() +
           own.dot((inertia.rotary + inertia.beam_rotary) * own);
  }
  return sum;
}

bool is_driven(const Model& model, const Coordinate& coordinate) {
  if (coordinate.motion >= 0 || coordinate.mimicked >= 0) return false;
  if (coordinate.effort >= 0) return true;
  if (coordinate.actuator < 0) return false;
  const Actuator& actuator = model.actuators[coordinate.actuator];
  return actuator.servo || actuator.drive.inertia > 0 || actuator.drive.gear;
}

}  // namespace

std::vector<std::string> warnings_of_driven_ends(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  std::vector<std::string> warnings;
  for (const Coordinate& coordinate : model.coordinates) {
    const JointMap& joint = model.joints[coordinate.joint];
    if (!is_driven(model, coordinate) || joint.kind != JointMapKind::Scalar || joint.rotation.isZero(0)) continue;
    Vector3 axis = joint.rotation.normalized();
    if (joint.master >= 0) axis = model.nodes[joint.master].rotation * axis;
    for (const int node : {joint.slave, joint.master}) {
      const std::optional<BeamEnd> end = beam_end(model, node);
      if (!end) continue;
      const Vector3 own = model.nodes[node].rotation.transpose() * axis;
      const SectionLine section(simulation.scene().links[end->link].beam->section);
      const Matrix6 stiffness = section.at(end->arc_length).stiffness;
      const double bending = 4 / end->element_length * own.dot(stiffness.bottomRightCorner<3, 3>() * own);
      const double inertia = own_inertia(model, node, axis) + (node == joint.slave ? armature(model, coordinate) : 0.0);
      const double turn = std::sqrt(bending / inertia) * simulation.step_size();
      if (!(turn > kFast)) continue;
      const double moved = moved_inertia(model, joint, axis) + armature(model, coordinate);
      if (inertia > kSmallPart * moved) continue;
      warnings.push_back(
          fmt::format("joint '{}' is driven where beam '{}' ends with {:.2g} kg m^2 of its own, beside {:.2g} kg m^2 "
                      "that the joint moves: its fastest motion turns by {:.2g} rad in a step of {} s (1 is well "
                      "resolved); <hub> puts the inertia of the drive's housing or flange there, <drive "
                      "rotor_inertia> that of the motor",
                      coordinate.name, model.links[end->link].name, inertia, moved, turn, simulation.step_size()));
    }
  }
  return warnings;
}

}  // namespace flexarm
