#include "model/plane_finder.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "model/carried_origin.h"

namespace flexarm {
namespace {

/// Relative tolerance for round-off in numbers that are computed from the scene's.
constexpr double kRoundOff = 1e-12;

/// is_normal_to(): whether a vector is normal to a unit vector; is_along(): whether it is parallel to it. Both up to
/// round-off, relative to the vector's length or to `scale` if that is larger.
bool is_normal_to(const Vector3& unit, const Vector3& vector, double scale = 0) {
  return std::abs(unit.dot(vector)) <= kRoundOff * std::max(vector.norm(), scale);
}
bool is_along(const Vector3& unit, const Vector3& vector, double scale = 0) {
  return (vector - unit.dot(vector) * unit).norm() <= kRoundOff * std::max(vector.norm(), scale);
}

Matrix3 rotation_of(const Model& model, int node) {
  return node >= 0 ? model.nodes[node].rotation : Matrix3::Identity();
}

/// Turns a vector from a joint's master frame into world axes, in the initial configuration. The axes of a Scalar joint
/// are given in that frame.
const Vector3 to_world(const Model& model, const JointMap& joint, const Vector3& in_master) {
  return rotation_of(model, joint.master) * in_master;
}

/// Turns a load's vector into world axes. For a load that follows its node, the node has its initial orientation.
Vector3 to_world(const Model& model, const NodalLoad& load, const Vector3& vector) {
  return load.follows ? Vector3(model.nodes[load.node].rotation * vector) : vector;
}

// ---------------------------------------------------------------- which plane

/// Unit vectors that restrict the plane: `normals` must be along its normal, `directions` must lie in it.
struct Hints {
  std::vector<Vector3> normals, directions;
};

Hints hints_of(const Model& model) {
  Hints hints;
  const auto add = [](std::vector<Vector3>& to, const Vector3& vector) {
    if (const double length = vector.norm(); length > 0) to.push_back(vector / length);
  };
  for (const JointMap& joint : model.joints) {
    if (joint.kind != JointMapKind::Scalar) continue;
    add(hints.normals, to_world(model, joint, joint.rotation));
    add(hints.directions, to_world(model, joint, joint.translation));
  }
  double longest = 0;
  for (const NodePose& node : model.nodes)
    longest = std::max(longest, (node.position - model.nodes[0].position).norm());
  for (const NodePose& node : model.nodes) {
    const Vector3 way = node.position - model.nodes[0].position;
    if (way.norm() > 1e-3 * longest) add(hints.directions, way);
  }
  add(hints.directions, model.gravity);
  for (const NodalLoad& load : model.loads) {
    add(hints.directions, to_world(model, load, load.force));
    add(hints.normals, to_world(model, load, load.moment));
  }
  for (const Vector6& velocity : model.initial_velocity) {
    add(hints.directions, velocity.head<3>());
    add(hints.normals, velocity.tail<3>());
  }
  return hints;
}

/// Normalises a vector. If it equals a coordinate axis up to round-off, returns exactly that axis.
Vector3 tidied(const Vector3& vector) {
  Vector3 unit = vector.normalized();
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0})
      if ((unit - sign * Vector3::Unit(k)).norm() < kRoundOff) return sign * Vector3::Unit(k);
  return unit;
}

/// Returns the only possible normal. If everything lies on one line, returns one of the possible normals.
Vector3 normal_of(const Model& model) {
  const Hints hints = hints_of(model);
  if (!hints.normals.empty()) return tidied(hints.normals.front());
  Vector3 best = Vector3::Zero();
  for (const Vector3& direction : hints.directions)
    if (const Vector3 normal = hints.directions.front().cross(direction); normal.norm() > best.norm()) best = normal;
  if (best.norm() > kRoundOff) return tidied(best);
  const Vector3 line = hints.directions.empty() ? Vector3(Vector3::UnitX()) : hints.directions.front();
  double smallest = 2;
  for (int k = 0; k < 3; ++k) {  // choose the section axis that is most nearly normal to the line
    const Vector3 axis = model.nodes.back().rotation.col(k);
    if (std::abs(line.dot(axis)) >= smallest) continue;
    smallest = std::abs(line.dot(axis));
    best = axis - line.dot(axis) * line;
  }
  return tidied(best);
}

void set_axes(const Vector3& normal, PlaneOfMotion& plane) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
  plane.normal = normal;
  plane.first = (Vector3::Unit(least) - normal[least] * normal).normalized();
  plane.second = normal.cross(plane.first);
}

/// Returns the reference orientation of each node (PlaneOfMotion::frames). Nodes that elements connect share one.
std::vector<Quaternion> frames_of(const Model& model) {
  std::vector<int> like(model.nodes.size());
  std::iota(like.begin(), like.end(), 0);
  const auto first_of = [&](int node) {
    while (like[node] != node) node = like[node] = like[like[node]];
    return node;
  };
  for_each_element(model.beams, [&](const auto& element) {
    for (const int node : element.nodes) like[first_of(node)] = first_of(element.nodes[0]);
  });
  std::vector<Quaternion> frames;
  for (std::size_t i = 0; i < like.size(); ++i)
    frames.push_back(model.nodes[first_of(static_cast<int>(i))].orientation);
  return frames;
}

// ---------------------------------------------------------------- reasons why the motion is not planar

/// Whether a section's stiffness does not couple strains in the plane with strains out of it. `basis`: of strains in
/// the plane; `rest`: of those out of it.
bool is_separable(const Matrix6& stiffness, const Eigen::Matrix<double, 6, 3>& basis,
                  const Eigen::Matrix<double, 6, 3>& rest) {
  const Matrix3 coupling = rest.transpose() * stiffness * basis;
  const Vector3 in = (basis.transpose() * stiffness * basis).diagonal(),
                out = (rest.transpose() * stiffness * rest).diagonal();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(coupling(i, j)) > kRoundOff * std::sqrt(std::abs(out[i] * in[j]))) return false;
  return true;
}

std::string flaw_of_beams(const Model& model, const PlaneOfMotion& plane) {
  bool is_turned = false, is_coupled = false, is_bent = false, is_uneven = false;
  for_each_element(model.beams, [&](const auto& element) {
    const Eigen::Matrix<double, 6, 3> basis = plane.strain_basis(element.nodes[0]);
    Eigen::Matrix<double, 6, 3> rest = Eigen::Matrix<double, 6, 3>::Zero();
    rest.col(0).head<3>() = basis.col(2).tail<3>();
    rest.block<3, 2>(3, 1) = basis.block<3, 2>(0, 0);
    for (const int node : element.nodes) {
      const Quaternion turn = model.nodes[node].orientation * plane.frames[node].conjugate();
      is_turned = is_turned || !is_along(plane.normal, turn.vec(), 1);
    }
    for (int k = 0; k < element.kStiffnessPoints; ++k) {
      const auto& point = element.stiffness_points[k];
      is_bent = is_bent || (rest.transpose() * point.reference_strain).norm() >
                               kRoundOff * std::max(1.0, point.reference_strain.norm());
      is_coupled = is_coupled || !is_separable(point.stiffness, basis, rest) ||
                   !is_separable(damped_stiffness(element, k), basis, rest);
    }
    const Vector3 normal = plane.material_normal(element.nodes[0]);
    for (const auto& point : element.mass_points)
      is_uneven = is_uneven || !is_along(normal, point.inertia * normal, point.inertia.norm());
  });
  if (is_turned || is_bent) return "a beam is bent or twisted out of the plane";
  if (is_uneven) return "no principal axis of a section's inertia is normal to the plane";
  return is_coupled ? "a section couples motions in the plane with others" : "";
}

std::string flaw_of_nodes(const Model& model, const PlaneOfMotion& plane) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!is_normal_to(plane.normal, model.nodes[i].position - model.nodes[0].position, model.length_scale))
      return "nodes of beams or centres of mass are not in one plane";
    const NodalInertia& inertia = model.inertias[i];
    const Vector3 normal = model.nodes[i].rotation.transpose() * plane.normal;
    for (const Matrix3* rotary : {&inertia.rotary, &inertia.beam_rotary, &inertia.rotary_damping})
      if (!is_along(normal, *rotary * normal, rotary->norm()))
        return "no principal axis of a link's inertia is normal to the plane";
  }
  return "";
}

/// Whether nothing acts on a coordinate. Required of free joints, since they have coordinates out of the plane.
bool is_left_alone(const Coordinate& coordinate) {
  return coordinate.damping == 0 && coordinate.friction == 0 && coordinate.friction_coefficient == 0 &&
         !coordinate.limit && coordinate.motion < 0 && coordinate.effort < 0 && coordinate.actuator < 0;
}

std::string flaw_of_joints(const Model& model, const PlaneOfMotion& plane) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.kind == JointMapKind::Slide) return "sliders are computed in three dimensions only";
    if (joint.kind == JointMapKind::Scalar && !(is_along(plane.normal, to_world(model, joint, joint.rotation)) &&
                                                is_normal_to(plane.normal, to_world(model, joint, joint.translation))))
      return fmt::format("joint coordinate '{}' moves out of the plane",
                         model.coordinates[model.first_coordinate[j]].name);
  }
  for (const Coordinate& coordinate : model.coordinates) {
    const JointMapKind kind = model.joints[coordinate.joint].kind;
    if (kind != JointMapKind::Scalar && !is_left_alone(coordinate))
      return fmt::format("something acts on the free joint coordinate '{}'", coordinate.name);
    if (coordinate.mimicked >= 0) return "joints that mimic others are computed in three dimensions only";
  }
  for (const Actuator& actuator : model.actuators)
    if (actuator.gyroscope &&
        !is_along(plane.normal, model.nodes[actuator.gyroscope->node].rotation * actuator.gyroscope->axis))
      return "the axis of a rotor is not normal to the plane";
  if (!model.closures.empty()) return "loops are computed in three dimensions only";
  return model.force_elements.empty() ? ""
                                      : "force elements between points of links are computed in three dimensions only";
}

bool acts_in_plane(const PlaneOfMotion& plane, const Vector3& force, const Vector3& moment, const Vector3& arm,
                   double length) {
  return is_normal_to(plane.normal, force) && is_along(plane.normal, moment) &&
         (force.isZero(0) || is_normal_to(plane.normal, arm, length));
}

std::string flaw_of_loads(const Model& model, const PlaneOfMotion& plane) {
  if (!is_normal_to(plane.normal, model.gravity)) return "gravity is not in the plane";
  for (const NodalLoad& load : model.loads)
    if (!acts_in_plane(plane, to_world(model, load, load.force), to_world(model, load, load.moment),
                       model.nodes[load.node].rotation * load.arm, model.length_scale))
      return "a load acts out of the plane";
  return model.prestrains.empty() ? "" : "prestrains are computed in three dimensions only";
}

/// Largest squared norms of a set of vectors and of their parts out of the plane. The latter must be round-off of the
/// former.
struct Largest {
  double in = 0, out = 0;
  void add(const Vector3& vector, const Vector3& out_of_plane) {
    in = std::max(in, vector.squaredNorm());
    out = std::max(out, out_of_plane.squaredNorm());
  }
  bool is_round_off() const { return out <= kRoundOff * kRoundOff * in; }
};

std::string flaw_of_start(const Model& model, const PlaneOfMotion& plane) {
  Largest velocities, turns;
  for (const Vector6& velocity : model.initial_velocity) {
    const Vector3 v = velocity.head<3>(), w = velocity.tail<3>();
    velocities.add(v, plane.normal.dot(v) * plane.normal);
    turns.add(w, w - plane.normal.dot(w) * plane.normal);
  }
  return velocities.is_round_off() && turns.is_round_off() ? "" : "initial velocities point out of the plane";
}

// ---------------------------------------------------------------- states

bool stands_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state) {
  assert(plane.frames.size() == state.nodes.size());
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const NodeState& node = state.nodes[i];
    if (!is_normal_to(plane.normal, node.position - state.nodes[0].position, model.length_scale)) return false;
    if (!is_along(plane.normal, (node.orientation * plane.frames[i].conjugate()).vec(), 1)) return false;
  }
  return true;
}

/// Kinds of vectors in a state, besides poses, that affect later steps of the energy-momentum family.
enum Quantity { kVelocity, kTurning, kSpin, kStrain, kCurvature, kCount };

/// Whether in-plane motion has vectors of this kind along the normal; else they lie in the plane.
bool is_axial(Quantity quantity) {
  return quantity != kVelocity && quantity != kStrain;
}

/// Calls visit(quantity, normal, vector) for these vectors of a state; `normal` and `vector` are in the same frame.
template <class Visit>
void for_each_vector(const Model& model, const PlaneOfMotion& plane, const State& state, const Visit& visit) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const NodeState& node = state.nodes[i];
    visit(kVelocity, plane.normal, node.velocity);
    visit(kTurning, plane.material_normal(static_cast<int>(i)), node.angular_velocity);
    visit(kSpin, plane.normal, node.mean_spin);
  }
  for_each_element(model.beams, [&](const auto& element) {
    const Vector3 normal = plane.material_normal(element.nodes[0]);
    const auto visit_strain = [&](const Vector6& strain) {
      visit(kStrain, normal, strain.head<3>());
      visit(kCurvature, normal, strain.tail<3>());
    };
    for (int k = 0; k < element.kStiffnessPoints; ++k) {
      const std::size_t point = element.first_stiffness_point + k, branches = model.maxwell_branches;
      for (std::size_t b = 0; b < branches; ++b) visit_strain(state.branch_strains[point * branches + b]);
      if (state.strain_memory.empty()) continue;
      const StrainMemory& memory = state.strain_memory[point];
      for (const Vector6* strain : {&memory.average, &memory.rate, &memory.delayed_rate}) visit_strain(*strain);
    }
  });
}

bool moves_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state) {
  std::array<Largest, kCount> largest;
  for_each_vector(model, plane, state, [&](Quantity quantity, const Vector3& normal, const Vector3& vector) {
    const Vector3 along = normal.dot(vector) * normal;
    largest[quantity].add(vector, is_axial(quantity) ? Vector3(vector - along) : along);
  });
  return std::all_of(largest.begin(), largest.end(), [](const Largest& l) { return l.is_round_off(); });
}

}  // namespace

PlaneSearch find_plane(const Model& model) {
  if (model.nodes.empty()) return {std::nullopt, "nothing moves"};
  PlaneOfMotion plane;
  set_axes(normal_of(model), plane);
  plane.frames = frames_of(model);
  for (const auto& flaw_of : {flaw_of_joints, flaw_of_loads, flaw_of_nodes, flaw_of_beams, flaw_of_start})
    if (std::string flaw = flaw_of(model, plane); !flaw.empty()) return {std::nullopt, std::move(flaw)};
  return {std::move(plane), ""};
}

bool lies_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state) {
  return stands_in_plane(model, plane, state) && moves_in_plane(model, plane, state);
}

bool acts_in_plane(const Model& model, const PlaneOfMotion& plane, const State& state) {
  for (const NodalLoad& wrench : state.wrenches) {
    const NodeState& node = state.nodes[wrench.node];
    const auto world = [&](const Vector3& vector) {
      return wrench.follows ? Vector3(node.orientation * vector) : vector;
    };
    const Vector3 arm = node.orientation * wrench.arm;
    if (!acts_in_plane(plane, world(wrench.force), world(wrench.moment), arm, model.length_scale)) return false;
    const Vector3 way = wrench.pull.target - world_origin(model, state) - node.position;
    if (wrench.pull.acts() &&
        !(is_normal_to(plane.normal, arm, model.length_scale) && is_normal_to(plane.normal, way, model.length_scale)))
      return false;
  }
  for (std::size_t i = 0; i < model.coordinates.size(); ++i)
    if (model.joints[model.coordinates[i].joint].kind != JointMapKind::Scalar && std::isfinite(state.commands[i]) &&
        state.commands[i] != 0)
      return false;
  return true;
}

}  // namespace flexarm
