#include "simulation/carried_state.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/LU>

#include "joints/joint_kinematics.h"
#include "model/carried_origin.h"
#include "simulation/observables.h"

namespace flexarm {
namespace {

template <class Value>
void take(const std::vector<Value>& from, int old, std::vector<Value>& to, std::size_t own) {
  if (old >= 0 && static_cast<std::size_t>(old) < from.size() && own < to.size()) to[own] = from[old];
}

/// Copies the means of all items that have an old index, with `width` numbers for each item.
void take_means(const StepMeans& from, const std::vector<int>& old_of, std::size_t width, StepMeans& to) {
  to.count = from.count;
  to.durations = from.durations;
  for (std::size_t i = 0; i < old_of.size(); ++i)
    for (std::size_t k = 0; k < width && old_of[i] >= 0; ++k) {
      to.impulse[width * i + k] = from.impulse[width * old_of[i] + k];
      for (std::size_t m = 0; m < to.means.size(); ++m)
        to.means[m][width * i + k] = from.means[m][width * old_of[i] + k];
    }
}

class Carrier {
 public:
  Carrier(const ModelOfScene& before, const State& state, const ModelOfScene& after,
          const std::set<std::string>& touched)
      : old_(before.model), state_(state), new_(after.model), same_(before, after) {
    origin_ = new_.floats ? Vector3(world_origin(old_, state_) - new_.origin) : new_.initial_origin;
    find_touched(touched);
  }

  State carry(const std::function<void(State&)>& begin) {
    Model placed = new_;
    place(placed);
    State out = initial_state(placed, state_.time);
    overlay(out);
    begin(out);
    overlay(out);
    return out;
  }

 private:
  // ---------------------------------------------------------------- trees in which nodes were attached or detached

  int top_of(int node) const {
    while (node >= 0 && new_.node_parents[node] >= 0) node = new_.node_parents[node];
    return node;
  }

  void find_touched(const std::set<std::string>& touched) {
    std::set<int> tops;
    for (const LinkFrame& link : new_.links)
      if (touched.count(link.name) > 0 && link.frame.node >= 0) tops.insert(top_of(link.frame.node));
    for (std::size_t i = 0; i < same_.nodes.size(); ++i)
      is_touched_.push_back(tops.count(top_of(static_cast<int>(i))) > 0);
    for_each_element(new_.beams, [&](const auto& element) {
      for (int p = 0; p < element.kMassPoints; ++p)
        if (is_touched_[element.nodes[0]]) touched_points_.insert(element.first_mass_point + p);
    });
  }

  // ---------------------------------------------------------------- positions and velocities

  /// The translation from positions in the old state to positions in the new one, since their origins differ.
  Vector3 shift() const { return world_origin(old_, state_) - (new_.origin + origin_); }

  void place(Model& placed) const {
    placed.initial_origin = origin_;
    const Vector3 of_new = new_.initial_origin - origin_, of_old = shift();
    for (std::size_t i = 0; i < same_.nodes.size(); ++i) {
      placed.nodes[i].position += of_new;
      if (same_.nodes[i] < 0) continue;
      placed.nodes[i] = node_pose(state_.nodes[same_.nodes[i]]);
      placed.nodes[i].position += of_old;
      placed.initial_velocity[i] = spatial_velocity(state_.nodes[same_.nodes[i]]);
    }
    for (std::size_t i = 0; i < same_.links.size(); ++i) place_body(i, placed);
    for (int j = 0; j < static_cast<int>(new_.joints.size()); ++j) {
      const JointMap& joint = new_.joints[j];
      if (joint.kind != JointMapKind::Rigid || same_.nodes[joint.slave] >= 0) continue;
      placed.nodes[joint.slave] = slave_pose(placed, j, placed.nodes, placed.initial_released[j]);
      placed.initial_velocity[joint.slave] =
          slave_velocity(placed, j, placed.nodes, placed.initial_released[j], placed.initial_velocity)
              .with(ReleasedVector(0));
    }
    move_bodies(placed);
    release(placed);
  }

  /// The node that carries the mass of a rigid link; -1: the world. If the link's frame is on a node of a beam, the
  /// mass may be at another node, rigidly joined to that one.
  static int body_node(const Model& model, const LinkFrame& link) {
    for (const JointMap& joint : model.joints)
      if (joint.kind == JointMapKind::Rigid && link.frame.node >= 0 && joint.master == link.frame.node &&
          model.inertias[joint.slave].mass > 0)
        return joint.slave;
    return link.frame.node;
  }

  /// Sets the velocities of bodies from the momenta of the old bodies, not from the joints: a scheme may let a centre
  /// of mass deviate a little from the joint that holds it.
  void move_bodies(Model& placed) const {
    std::map<int, std::set<int>> parts;  // for each new node, the old nodes whose bodies it unites
    for (std::size_t i = 0; i < same_.links.size(); ++i) {
      if (same_.links[i] < 0 || new_.links[i].beam) continue;
      const int now = body_node(new_, new_.links[i]), then = body_node(old_, old_.links[same_.links[i]]);
      if (now >= 0 && then >= 0 && same_.nodes[now] < 0 && new_.inertias[now].mass > 0 && old_.inertias[then].mass > 0)
        parts[now].insert(then);
    }
    for (const auto& [node, bodies] : parts) {
      const Vector3 place = placed.nodes[node].position - shift();
      double mass = 0;
      Vector3 momentum = Vector3::Zero(), spin = Vector3::Zero();
      Matrix3 inertia = Matrix3::Zero();
      for (const int body : bodies) {
        const NodeState& own = state_.nodes[body];
        const NodalInertia& part = old_.inertias[body];
        const Matrix3 turn = own.orientation.toRotationMatrix(), rotary = turn * part.rotary * turn.transpose();
        const Vector3 arm = own.position - place, turning = own.orientation * own.angular_velocity;
        // If there is one old body, its velocity is taken at the new node's place, since the new body may be a part of
        // it. If there are several, their momenta are added.
        const Vector3 velocity = bodies.size() > 1 ? own.velocity : Vector3(own.velocity - turning.cross(arm));
        mass += part.mass;
        momentum += part.mass * velocity;
        spin += rotary * turning;
        inertia += rotary;
        if (bodies.size() == 1) continue;
        spin += part.mass * arm.cross(velocity);
        inertia += part.mass * (arm.squaredNorm() * Matrix3::Identity() - arm * arm.transpose());
      }
      Vector6& velocity = placed.initial_velocity[node];
      velocity.head<3>() = momentum / mass;
      const Eigen::FullPivLU<Matrix3> solver(inertia);
      if (bodies.size() == 1)
        velocity.tail<3>() = spatial_velocity(state_.nodes[*bodies.begin()]).tail<3>();
      else if (solver.isInvertible())
        velocity.tail<3>() = solver.solve(spin);
    }
  }

  /// Places the node of a rigid link whose node is now at another place of its body.
  void place_body(std::size_t link, Model& placed) const {
    const Attachment& now = new_.links[link].frame;
    if (same_.links[link] < 0 || now.node < 0 || same_.nodes[now.node] >= 0 || new_.links[link].beam) return;
    const Attachment& then = old_.links[same_.links[link]].frame;
    Pose frame = attached_pose(state_, then);
    frame.position += then.node < 0 ? Vector3(old_.origin - (new_.origin + origin_)) : shift();
    const Pose pose = frame * now.offset.inverse();
    NodePose& node = placed.nodes[now.node];
    node = {pose.position, pose.orientation, pose.orientation.toRotationMatrix()};
    Vector6& velocity = placed.initial_velocity[now.node];
    velocity.setZero();
    if (then.node < 0) return;
    velocity = spatial_velocity(state_.nodes[then.node]);
    const Vector3 arm = node.position - shift() - state_.nodes[then.node].position;
    velocity.head<3>() += Vector3(velocity.tail<3>()).cross(arm);
  }

  void release(Model& placed) const {
    std::vector<bool> is_known(new_.joints.size_with_held(), false);
    for (std::size_t c = 0; c < same_.coordinates.size(); ++c) {
      if (same_.coordinates[c] < 0) continue;
      const int joint = new_.coordinates[c].joint, then = old_.coordinates[same_.coordinates[c]].joint;
      if (is_known[joint]) continue;
      is_known[joint] = true;
      const JointMap &map = new_.joints[joint], &other = old_.joints[then];
      Released& released = placed.initial_released[joint];
      released = state_.released[then];
      if (map.kind != JointMapKind::Free || map.master >= 0) continue;
      const Vector3 way =
          old_.origin + state_.origin + other.origin.position - (new_.origin + origin_ + map.origin.position);
      released.displacement += map.origin.orientation.conjugate() * way;
    }
    for (std::size_t j = 0; j < new_.joints.size(); ++j) {
      const JointMap& joint = new_.joints[j];
      if (is_known[j] || joint.kind != JointMapKind::Free || joint.master >= 0) continue;
      const NodePose& slave = placed.nodes[joint.slave];
      const Quaternion back = joint.origin.orientation.conjugate();
      placed.initial_released[j].displacement = back * (moved_origin(joint, slave) - joint.origin.position);
      placed.initial_released[j].rotation =
          (back * slave.orientation * joint.slave_orientation.conjugate()).normalized();
    }
  }

  // ---------------------------------------------------------------- what a state remembers

  void overlay(State& out) const {
    out.time = state_.time;
    out.steps = state_.steps;
    out.work = state_.work;
    out.dissipated = state_.dissipated;
    out.halving_level = state_.halving_level;
    out.good_steps = state_.good_steps;
    overlay_nodes(out);
    overlay_points(out);
    overlay_coordinates(out);
    overlay_sensors(out);
    overlay_force_memory(out);
    out.wrenches.clear();
    for (const NodalLoad& wrench : state_.wrenches) add_wrench(wrench, out);
  }

  /// Whether it is known for all nodes what joints transmitted to them in the last step. It is not known in a tree to
  /// which something was attached or from which something was detached, but nothing is transmitted to a free body.
  bool knows_reactions() const {
    std::vector<int> sizes(same_.nodes.size(), 0);
    for (std::size_t i = 0; i < sizes.size(); ++i) ++sizes[top_of(static_cast<int>(i))];
    std::vector<bool> is_held(same_.nodes.size(), false);
    for (const JointMap& joint : new_.joints)
      if (joint.kind != JointMapKind::Free || joint.master >= 0) is_held[joint.slave] = true;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const bool is_free_body = sizes[i] == 1 && !is_held[i];
      if (!is_free_body && (same_.nodes[i] < 0 || is_touched_[i])) return false;
    }
    return !state_.study.reactions.empty();
  }

  void overlay_nodes(State& out) const {
    if (knows_reactions()) out.study.reactions.assign(same_.nodes.size(), Vector6::Zero());
    const std::size_t points = new_.mass_point_count, old_points = old_.mass_point_count;
    for (std::size_t i = 0; i < same_.nodes.size(); ++i) {
      const int old = same_.nodes[i];
      if (old < 0) continue;
      const NodeState found = out.nodes[i];
      out.nodes[i] = state_.nodes[old];
      out.nodes[i].position += shift();
      take(state_.study.total_rotations, old, out.study.total_rotations, i);
      take(state_.study.reactions, old, out.study.reactions, i);
      if (is_touched_[i]) {
        out.nodes[i].mean_spin = found.mean_spin;
        out.nodes[i].acceleration = found.acceleration;
        out.nodes[i].angular_acceleration = found.angular_acceleration;
      } else {
        take(state_.study.forces, old, out.study.forces, i);
        if (!out.study.momentum_rates.empty() && !state_.study.momentum_rates.empty())
          out.study.momentum_rates[points + i] = state_.study.momentum_rates[old_points + old];
      }
    }
  }

  void overlay_points(State& out) const {
    const int branches = std::min(old_.maxwell_branches, new_.maxwell_branches);
    for (std::size_t i = 0; i < same_.stiffness_points.size(); ++i) {
      for (int b = 0; b < branches && same_.stiffness_points[i] >= 0; ++b)
        take(state_.branch_strains, same_.stiffness_points[i] * old_.maxwell_branches + b, out.branch_strains,
             i * new_.maxwell_branches + b);
      take(state_.study.strain_rates, same_.stiffness_points[i], out.study.strain_rates, i);
      take(state_.strain_memory, same_.stiffness_points[i], out.strain_memory, i);
      take(state_.study.stiffness_rotations, same_.stiffness_points[i], out.study.stiffness_rotations, i);
    }
    for (std::size_t i = 0; i < same_.mass_points.size(); ++i) {
      if (same_.mass_points[i] < 0) continue;
      const Vector3 found = out.study.mass_points[i].angular_acceleration;
      out.study.mass_points[i] = state_.study.mass_points[same_.mass_points[i]];
      take(state_.study.mass_rotations, same_.mass_points[i], out.study.mass_rotations, i);
      if (touched_points_.count(static_cast<int>(i)) > 0)
        out.study.mass_points[i].angular_acceleration = found;
      else if (!out.study.momentum_rates.empty() && !state_.study.momentum_rates.empty())
        out.study.momentum_rates[i] = state_.study.momentum_rates[same_.mass_points[i]];
    }
  }

  void overlay_coordinates(State& out) const {
    for (std::size_t c = 0; c < same_.coordinates.size(); ++c) {
      take(state_.commands, same_.coordinates[c], out.commands, c);
      take(state_.efforts, same_.coordinates[c], out.efforts, c);
      take(state_.rests, same_.coordinates[c], out.rests, c);
    }
    take_means(state_.drives, same_.coordinates, 1, out.drives);
    for (std::size_t i = 0; i < new_.actuators.size(); ++i) {
      const int coordinate = same_.coordinates[new_.actuators[i].coordinate];
      const int old = coordinate < 0 ? -1 : old_.coordinates[coordinate].actuator;
      if (old < 0 || state_.actuators[old].servo.outputs.size() != out.actuators[i].servo.outputs.size()) continue;
      out.actuators[i] = state_.actuators[old];
    }
  }

  void overlay_sensors(State& out) const {
    std::vector<int> reactions(new_.reactions.size(), -1);
    for (std::size_t i = 0; i < same_.sensors.size(); ++i) {
      if (same_.sensors[i] < 0) continue;
      take(state_.samples, same_.sensors[i], out.samples, i);
      const int own = new_.sensors[i].reaction, old = old_.sensors[same_.sensors[i]].reaction;
      if (own >= 0 && old >= 0) reactions[own] = old;
    }
    take_means(state_.transmitted, reactions, 6, out.transmitted);
    for (std::size_t i = 0; i < reactions.size(); ++i)
      for (int k = 0; k < 6 && reactions[i] >= 0; ++k)
        out.last_transmitted[6 * i + k] = state_.last_transmitted[6 * reactions[i] + k];
  }

  /// An element before the edit, and its memory.
  struct OldElement {
    const ForceElement* element;
    const double* memory;
    bool is_taken = false;  ///< a new element continues it
  };
  /// Kind, name and links of a force element. Several elements may agree in these.
  using ElementKey = std::tuple<std::string, std::string, std::vector<std::string>>;
  static ElementKey key_of(const ForceElement& element) { return {element.kind(), element.name(), element.links()}; }

  /// Whether both act on the same nodes. `may_move`: frames of nodes may have moved in their bodies.
  bool agree(const std::vector<int>& own, const std::vector<int>& old, bool may_move) const {
    return std::equal(own.begin(), own.end(), old.begin(), old.end(),
                      [&](int a, int b) { return same_.nodes[a] == b || (may_move && same_.nodes[a] < 0); });
  }

  void overlay_force_memory(State& out) const {
    std::map<ElementKey, std::vector<OldElement>> known;
    const double* old_memory = state_.force_memory.data();
    for (const auto& element : old_.force_elements) {
      known[key_of(*element)].push_back({element.get(), old_memory});
      old_memory += element->memory_size();
    }
    double* memory = out.force_memory.data();
    for (const auto& element : new_.force_elements) {
      std::vector<OldElement>& candidates = known[key_of(*element)];
      const auto found = std::find_if(candidates.begin(), candidates.end(), [&](const OldElement& old) {
        if (old.is_taken || old.element->memory_size() != element->memory_size()) return false;
        return !element->name().empty() || agree(element->reach(), old.element->reach(), true);
      });
      if (found != candidates.end()) {
        found->is_taken = true;
        // The memory may contain positions in frames of nodes, so all nodes have to correspond.
        if (agree(element->reach(), found->element->reach(), false))
          std::copy_n(found->memory, element->memory_size(), memory);
        element->carry(*found->element, found->memory, out, memory);
      }
      memory += element->memory_size();
    }
  }

  void add_wrench(NodalLoad wrench, State& out) const {
    const auto link = std::find(same_.links.begin(), same_.links.end(), wrench.link);
    if (wrench.link < 0 || link == same_.links.end()) return;
    const LinkFrame &now = new_.links[link - same_.links.begin()], &then = old_.links[wrench.link];
    if (now.frame.node < 0) return;  // the link is fixed to the world in the new model
    wrench.link = static_cast<int>(link - same_.links.begin());
    if (now.beam) {
      wrench.node += now.frame.node - then.frame.node;
    } else {
      const Pose change = now.frame.offset * then.frame.offset.inverse();
      wrench.node = now.frame.node;
      wrench.arm = change * wrench.arm;
      if (wrench.follows) {
        wrench.force = change.orientation * wrench.force;
        wrench.moment = change.orientation * wrench.moment;
      }
    }
    out.wrenches.push_back(wrench);
  }

  const Model& old_;
  const State& state_;
  const Model& new_;
  ModelCorrespondence same_;
  std::vector<bool> is_touched_;  // per node: whether its tree contains a touched link
  std::set<int> touched_points_;  // mass points of elements in those trees
  Vector3 origin_;                // State::origin
};

}  // namespace

State carried_state(const ModelOfScene& before, const State& state, const ModelOfScene& after,
                    const std::set<std::string>& touched, const std::function<void(State&)>& begin) {
  return Carrier(before, state, after, touched).carry(begin);
}

}  // namespace flexarm
