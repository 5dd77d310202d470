#include "simulation/joint_state.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "joints/kinematics.h"
#include "math/pi.h"
#include "math/so3.h"
#include "model/carried_origin.h"
#include "simulation/entry.h"
#include "simulation/loop_velocities.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

/// Largest gap of a closed loop over the size of the mechanism, and largest angle [rad]: the same as at the start of a
/// scene.
constexpr double kClosed = 1e-6;
/// Largest rate at which velocities may open a loop, relative to the fastest motion.
constexpr double kStaysClosed = 1e-6;

/// Positions and velocities of a mechanism.
struct Motion {
  std::vector<NodePose> poses;        // per node
  std::vector<Vector6> velocities;    // per node, spatial {v, w}
  std::vector<Released> released;     // per joint
  std::vector<ReleasedVector> rates;  // per joint
};

Motion motion_of(const Model& model, const State& state) {
  Motion motion;
  for (const NodeState& node : state.nodes) {
    motion.poses.push_back(node_pose(node));
    motion.velocities.push_back(spatial_velocity(node));
  }
  motion.released = state.released;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j)
    motion.rates.push_back(released_rates(model, j, motion.poses, motion.released[j], motion.velocities));
  return motion;
}

[[noreturn]] void refuse(const Coordinate& coordinate, const std::string& why) {
  throw std::invalid_argument("joint coordinate '" + coordinate.name + "' " + why);
}

void check(const Model& model, const Coordinate& coordinate, const CoordinateState& wanted) {
  if (coordinate.motion >= 0) refuse(coordinate, "cannot be set: its motion is prescribed");
  if (coordinate.mimicked >= 0)
    refuse(coordinate, "cannot be set: it follows '" + model.coordinates[coordinate.mimicked].name + "'; set that");
  for (const std::optional<double>& number : {wanted.position, wanted.velocity})
    if (number && !std::isfinite(*number)) refuse(coordinate, "needs finite numbers");
  if (!wanted.position) return;
  const JointMap& joint = model.joints[coordinate.joint];
  const auto require = [&](bool is_inside, const char* what, double least, double most) {
    if (!is_inside)
      refuse(coordinate, fmt::format("cannot be set to {}: {} {} to {}", *wanted.position, what, least, most));
  };
  if (coordinate.limit)
    require(*wanted.position >= coordinate.limit->lower && *wanted.position <= coordinate.limit->upper,
            "its limits are", coordinate.limit->lower, coordinate.limit->upper);
  if (joint.kind == JointMapKind::Slide) {
    const SlideLine& line = model.slide_lines[joint.line];
    require(*wanted.position >= line.begin() && *wanted.position <= line.end(), "its line goes from", line.begin(),
            line.end());
  }
}

/// Sets the given positions and velocities, and those of the mimic coordinates that follow.
void set_coordinates(const Model& model, const State& state, const std::vector<CoordinateState>& coordinates,
                     Motion& motion) {
  std::set<std::size_t> named;
  for (const CoordinateState& wanted : coordinates) {
    const Coordinate& coordinate = entry(model.coordinates, wanted.coordinate, "joint coordinate");
    if (!named.insert(wanted.coordinate).second) refuse(coordinate, "is named twice");
    check(model, coordinate, wanted);
    Released& released = motion.released[coordinate.joint];
    const int component = coordinate.component % 3;
    if (wanted.velocity) motion.rates[coordinate.joint][coordinate.component] = *wanted.velocity;
    if (!wanted.position) continue;
    if (coordinate.is_angle) {
      Vector3 rotation = so3::log(released.rotation);
      rotation[component] = *wanted.position;
      released.rotation = so3::exp_quaternion(rotation);
    } else {
      const JointMap& joint = model.joints[coordinate.joint];
      released.displacement[component] = *wanted.position - carried_translation(joint, state)[component];
    }
  }
  place_followers(model, motion.released);
  set_follower_rates(model, motion.released, motion.rates);
}

Vector6 carried_velocity(const NodePose& parent, const Vector6& velocity, const Vector3& point) {
  Vector6 carried = velocity;
  carried.head<3>() += velocity.tail<3>().cross(point - parent.position);
  return carried;
}

/// Makes nodes follow the joints, from the root to the leaves. A node that no joint places keeps its pose and velocity
/// relative to its parent.
class Follower {
 public:
  Follower(const Model& model, const DegreesOfFreedom& dof, const Motion& before, Motion& after)
      : model_(model), dof_(dof), before_(before), after_(after) {}

  void follow() {
    follow_tree();
    for (int joint = 0; joint < static_cast<int>(model_.joints.size()); ++joint)
      if (closes_loop(joint)) close(joint);
  }

  /// The same, but loops may stay open.
  void follow_tree() {
    for (int node = 0; node < dof_.node_count; ++node) {
      const int joint = dof_.slave_joint[node];
      if (joint >= 0 && !closes_loop(joint))
        follow_joint(joint);
      else
        follow_parent(node);
    }
  }

 private:
  /// Whether the joint closes a loop, so that its slave already follows another node.
  bool closes_loop(int joint) const {
    return model_.node_parents[model_.joints[joint].slave] != model_.joints[joint].master;
  }
  void follow_joint(int joint) {
    const int slave = model_.joints[joint].slave;
    after_.poses[slave] = slave_pose(model_, joint, after_.poses, after_.released[joint]);
    set_velocity(joint);
  }
  void set_velocity(int joint) {
    after_.velocities[model_.joints[joint].slave] =
        slave_velocity(model_, joint, after_.poses, after_.released[joint], after_.velocities)
            .with(after_.rates[joint]);
  }
  void follow_parent(int node) {
    const int parent = model_.node_parents[node];
    if (parent < 0) return;  // it hangs on the world
    const NodePose &from = before_.poses[parent], &to = after_.poses[parent], &old = before_.poses[node];
    const Quaternion turn = to.orientation * from.orientation.conjugate();
    NodePose& pose = after_.poses[node];
    pose.position = to.position + turn * (old.position - from.position);
    pose.orientation = (turn * old.orientation).normalized();
    pose.rotation = pose.orientation.toRotationMatrix();
    const Vector6 relative =
        before_.velocities[node] - carried_velocity(from, before_.velocities[parent], old.position);
    Vector6& velocity = after_.velocities[node];
    velocity = carried_velocity(to, after_.velocities[parent], pose.position);
    velocity.head<3>() += turn * Vector3(relative.head<3>());
    velocity.tail<3>() += turn * Vector3(relative.tail<3>());
  }
  /// Moves the slave of a joint that closes a loop to the pose that the joint gives, which must differ by round-off
  /// only.
  void close(int joint) {
    NodePose& hanging = after_.poses[model_.joints[joint].slave];
    const NodePose held = slave_pose(model_, joint, after_.poses, after_.released[joint]);
    const double gap = (held.position - hanging.position).norm();
    const double angle = so3::log(held.orientation * hanging.orientation.conjugate()).norm();
    if (gap > kClosed * model_.length_scale || angle > kClosed)
      throw std::invalid_argument(fmt::format(
          "a loop opens, by {:.3g} m and {:.3g} rad at the joint that closes it: give the positions of all its joints, "
          "those of the loop joint as well",
          gap, angle));
    hanging = held;
    set_velocity(joint);
  }

  const Model& model_;
  const DegreesOfFreedom& dof_;
  const Motion& before_;
  Motion& after_;
};

/// Removes the velocities with which loops open. A scheme's own velocities open loops a little, and let slaves deviate
/// a little from their joints (joints.md 3.2). That must not become an error for a caller who sets other coordinates.
void close_velocities(const Model& model, const DegreesOfFreedom& dof, const State& state, Motion& motion) {
  const VelocityChange change = closing_change(model, dof, state, motion.velocities);
  for (std::size_t i = 0; i < change.nodes.size(); ++i) motion.velocities[i] += change.nodes[i];
  for (std::size_t j = 0; j < change.rates.size(); ++j) motion.rates[j] += change.rates[j];
}

/// @throws std::invalid_argument if a loop of rigid links is open.
void check_positions(const Model& model, const Motion& motion) {
  for_each_constraint(model, Constraints::All, [&](const LoopClosure& closure, const ClosureConstraint& constraint) {
    const double value = closure_value(closure, constraint, closure_poses(closure, motion.poses));
    const bool is_gap = constraint.kind == ClosureConstraint::Kind::Gap;
    if (std::abs(value) > kClosed * constraint_scale(model, constraint))
      throw std::invalid_argument(
          fmt::format("the loop that joint '{}' closes opens, by {:.3g} {}: give the positions of all its joints",
                      closure.name, value, is_gap ? "m" : "rad"));
  });
}

/// @throws std::invalid_argument if the velocities open a loop.
void check_velocities(const Model& model, const Motion& motion) {
  const LoopOpening opening = opening_of(model, motion.poses, motion.velocities);
  if (opening.rate > kStaysClosed * opening.fastest)
    throw std::invalid_argument("the velocities open the loop that joint '" + model.closures[opening.closure].name +
                                "' closes: give those of all its joints");
}

/// Moves rotors and controllers along with their coordinates, so that twists of gears and memories of controllers stay.
ActuatorState carried(const Model& model, const Actuator& actuator, ActuatorState own, const Motion& before,
                      const Motion& after) {
  const Coordinate& coordinate = model.coordinates[actuator.coordinate];
  const int j = coordinate.joint, k = coordinate.component;
  const double way = after.released[j].displacement[k] - before.released[j].displacement[k];
  const double rate = after.rates[j][k] - before.rates[j][k];
  own.angle += way;
  own.rate += rate;
  if (actuator.servo) {
    own.servo.measured += way - actuator.servo->sample_time * rate;
    own.servo.delayed_rate -= rate;
  }
  if (actuator.gyroscope) {
    const auto& [node, axis, inertia, ratio] = *actuator.gyroscope;
    const auto spin = [node = node, &axis = axis](const Motion& motion) {
      return (motion.poses[node].rotation * axis).dot(motion.velocities[node].tail<3>());
    };
    own.rate += (spin(after) - spin(before)) / ratio;
  }
  return own;
}

/// The released motions of a part of the way from one configuration to another.
std::vector<Released> part_of_way(const std::vector<Released>& from, const std::vector<Released>& to, double part) {
  std::vector<Released> out = from;
  for (std::size_t j = 0; j < out.size(); ++j) {
    out[j].displacement += part * (to[j].displacement - from[j].displacement);
    out[j].rotation = from[j].rotation.slerp(part, to[j].rotation);
  }
  return out;
}

/// Upper bound of the angle by which two links turn relative to each other between both configurations [rad].
double turn_between(const Model& model, const std::vector<Released>& from, const std::vector<Released>& to) {
  double turn = 0;
  for (std::size_t j = 0; j < from.size(); ++j)
    turn += from[j].rotation.angularDistance(to[j].rotation) +
            model.joints[j].rotation.norm() * std::abs(to[j].displacement[0] - from[j].displacement[0]);
  return turn;
}

/// Continues the memories of force elements along the way between both configurations, in small parts, so that drums
/// wind up whole turns. `out`: on input with the memories of elements that begin anew at `after`.
void carry_memories(const Model& model, const DegreesOfFreedom& dof, const State& state, const Motion& before,
                    const Motion& after, State& out) {
  if (model.force_elements.empty()) return;
  const int parts = 1 + static_cast<int>(turn_between(model, before.released, after.released) / (0.5 * kPi));
  std::vector<double> memory = state.force_memory;
  State on_way = out;
  Motion now = before;
  for (int i = 1; i <= parts; ++i) {
    if (i < parts) {
      const Motion last = now;
      now.released = part_of_way(before.released, after.released, static_cast<double>(i) / parts);
      Follower(model, dof, last, now).follow_tree();
    } else {
      now = after;
    }
    for (std::size_t n = 0; n < now.poses.size(); ++n) {
      on_way.nodes[n].position = now.poses[n].position;
      on_way.nodes[n].orientation = now.poses[n].orientation;
    }
    on_way.force_memory = out.force_memory;
    std::size_t begin = 0;
    for (const auto& element : model.force_elements) {
      element->carry(*element, memory.data() + begin, on_way, on_way.force_memory.data() + begin);
      begin += element->memory_size();
    }
    memory = on_way.force_memory;
  }
  out.force_memory = memory;
}

}  // namespace

State with_joint_state(const Model& model, const DegreesOfFreedom& dof, const State& state,
                       const std::vector<CoordinateState>& coordinates) {
  const Motion before = motion_of(model, state);
  Motion closed = before;
  Follower(model, dof, before, closed).follow();
  close_velocities(model, dof, state, closed);
  Motion after = closed;
  if (!coordinates.empty()) {
    set_coordinates(model, state, coordinates, after);
    Follower(model, dof, closed, after).follow();
  }
  check_positions(model, after);
  if (!coordinates.empty()) check_velocities(model, after);

  // Make a state as if the mechanism had been built in this configuration.
  Model placed = model;
  placed.nodes = after.poses;
  placed.initial_released = after.released;
  placed.initial_velocity = after.velocities;
  placed.initial_origin = state.origin;
  State out = initial_state(placed, state.time);
  carry_memories(model, dof, state, before, after, out);
  out.steps = state.steps;
  out.left_lines = state.left_lines;
  out.study.strain_rates = state.study.strain_rates;
  out.branch_strains = state.branch_strains;
  out.study.total_rotations = state.study.total_rotations;
  out.commands = state.commands;
  out.wrenches = state.wrenches;
  out.efforts = state.efforts;
  out.samples = state.samples;
  out.work = state.work;
  out.dissipated = state.dissipated;
  for (std::size_t i = 0; i < out.actuators.size(); ++i)
    out.actuators[i] = carried(model, model.actuators[i], state.actuators[i], before, after);
  return out;
}

}  // namespace flexarm
