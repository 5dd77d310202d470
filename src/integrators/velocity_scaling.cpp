#include "integrators/velocity_scaling.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "building/model_builder.h"
#include "integrators/energies.h"
#include "joints/joint_map.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// A larger change of the velocities in one step is a sign that the step is too long.
constexpr double kLargestChange = 0.02;
/// Kinetic energy, relative to the whole energy, below which there is nothing to scale.
constexpr double kNothingMoves = 1e-8;
/// Way of a mean node in a step, relative to the size of the mechanism, below which a motion is only starting: what its
/// first steps owe is nothing to the energy that is to come.
constexpr double kStarting = 1e-5;

}  // namespace

VelocityScaling::VelocityScaling(const Model& model, const Scheme& scheme)
    : model_(model), scheme_(scheme), tree_of_node_(model.nodes.size(), -1) {
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.motion >= 0)
      throw ModelError("<integrator>: scheme 'em_scaled' cannot scale the velocity that <motion> of joint '" +
                       coordinate.name + "' prescribes; scheme 'em' closes the energy without scaling");
  for (const JointMap& joint : model.joints)
    if (joint.leaving >= 0)
      throw ModelError(
          "<integrator>: scheme 'em_scaled' is not made for a slide with on_end=\"free\", whose trees change; scheme "
          "'em' closes the energy without scaling");
  if (!model.closures.empty())
    throw ModelError("<integrator>: scheme 'em_scaled' cannot scale the velocities of the rigid loop of '" +
                     model.closures.front().name + "'; scheme 'em' closes the energy without scaling");
  mass_ = mass_of(model);
  std::vector<std::vector<int>> neighbours(model.nodes.size());  // in elements
  for_each_element(model.beams, [&](const auto& element) {
    for (std::size_t i = 1; i < element.nodes.size(); ++i) {
      neighbours[element.nodes[i - 1]].push_back(element.nodes[i]);
      neighbours[element.nodes[i]].push_back(element.nodes[i - 1]);
    }
  });
  for (std::size_t j = 0; j < model.joints.size(); ++j) {  // root to leaf
    const JointMap& joint = model.joints[j];
    const int tree = joint.master < 0 ? static_cast<int>(trees_.size()) : tree_of_node_[joint.master];
    if (joint.master < 0) trees_.emplace_back();
    const int held = tree_of_node_[joint.slave];  // already: through its beam, the joint closes a loop
    if (held >= 0 && held != tree)
      throw ModelError(
          "<integrator>: scheme 'em_scaled' cannot scale the velocities of a loop that is closed through the world; "
          "scheme 'em' closes the energy without scaling");
    if (tree >= 0) {
      tree_of_node_[joint.slave] = tree;
      // A joint with several coordinates is a chain through nodes that hold no mass.
      Tree& whole = trees_[tree];
      const bool continues = !whole.chain.empty() && model.joints[whole.chain.back()].slave == joint.master &&
                             model.inertias[joint.master].total_mass == 0 &&
                             whole.coordinates + released_count(joint.kind) <= 6;
      if (joint.master < 0 || continues) {
        whole.chain.push_back(static_cast<int>(j));
        whole.coordinates += released_count(joint.kind);
      }
    }
    // All of a beam belongs to the tree of its near end.
    std::vector<int> reached = {joint.slave};
    while (tree >= 0 && !reached.empty()) {
      const int node = reached.back();
      reached.pop_back();
      for (const int other : neighbours[node])
        if (tree_of_node_[other] < 0) {
          tree_of_node_[other] = tree;
          reached.push_back(other);
        }
    }
  }
}

void VelocityScaling::project(const State& state) {
  for (Tree& tree : trees_) {
    tree.inertia.setZero();
    tree.momentum.setZero();
  }
  const auto add_mass = [&](Tree& tree, double mass, const NodeState& a, const NodeState& b) {
    const Matrix3 arm_a = so3::hat(a.position), arm_b = so3::hat(b.position);
    tree.inertia.topLeftCorner<3, 3>().diagonal().array() += mass;
    tree.inertia.topRightCorner<3, 3>() -= mass * arm_b;
    tree.inertia.bottomLeftCorner<3, 3>() += mass * arm_a;
    tree.inertia.bottomRightCorner<3, 3>() -= mass * arm_a * arm_b;
    tree.momentum.head<3>() += mass * b.velocity;
    tree.momentum.tail<3>() += mass * a.position.cross(b.velocity);
  };
  for_each_element(model_.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    Tree& tree = trees_[tree_of_node_[element.nodes[0]]];
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        add_mass(tree, element.mass(i, j), state.nodes[element.nodes[i]], state.nodes[element.nodes[j]]);
  });
  for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
    const NodeState& node = state.nodes[i];
    Tree& tree = trees_[tree_of_node_[i]];
    add_mass(tree, model_.inertias[i].mass, node, node);
    const Matrix3 rotation = node.orientation.toRotationMatrix();
    const Matrix3 J = model_.inertias[i].rotary + model_.inertias[i].beam_rotary;
    tree.inertia.bottomRightCorner<3, 3>() += rotation * J * rotation.transpose();
    tree.momentum.tail<3>() += rotation * (J * node.angular_velocity);
  }
  for (Tree& tree : trees_) {
    Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> twists(6, tree.coordinates);
    int column = 0;
    for (const int index : tree.chain) {
      const JointMap& joint = model_.joints[index];
      const NodePose master = joint.master < 0 ? NodePose() : node_pose(state.nodes[joint.master]);
      const NodePose slave = node_pose(state.nodes[joint.slave]);
      FoldMaps maps;
      variational_maps(joint, {master, slave, state.released[index]}, Vector6::Zero(), maps);
      for (int k = 0; k < maps.right.cols(); ++k, ++column) {  // of the slave's origin, then of the world's
        twists.col(column) = maps.right.col(k);
        twists.col(column).head<3>() += state.nodes[joint.slave].position.cross(Vector3(maps.right.col(k).tail<3>()));
      }
    }
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> A = twists.transpose() * tree.inertia * twists;
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> b = twists.transpose() * tree.momentum;
    tree.motion.setZero();
    if (b.size() > 0) tree.motion = twists * A.ldlt().solve(b).eval();
  }
}

bool VelocityScaling::apply(const State& begin, State& state) {
  assert(begin.nodes.size() == state.nodes.size() && state.nodes.size() == model_.nodes.size());
  const Energies before = energies(model_, scheme_, begin), after = energies(model_, scheme_, state);
  const double target =
      before.total() + begin.energy_defect + (after.work - before.work) - (after.dissipated - before.dissipated);
  const double missing = target - after.total();
  project(state);
  double rigid = 0;
  for (const Tree& tree : trees_) rigid += 0.5 * tree.motion.dot(tree.inertia * tree.motion);
  const double relative = after.kinetic - rigid;
  state.energy_defect = missing;
  if (relative <= kNothingMoves * (after.kinetic + after.strain)) return true;
  const double square = 1 + missing / relative;
  const double start_speed = kStarting * model_.length_scale / (state.time - begin.time);
  const bool is_starting = after.kinetic < 0.5 * mass_ * start_speed * start_speed;
  if (is_starting && std::abs(square - 1) > kLargestChange) return true;
  if (!(square > 0) || std::abs(std::sqrt(square) - 1) > kLargestChange) return false;
  const double factor = std::sqrt(square);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    const Vector6& motion = trees_[tree_of_node_[i]].motion;
    const Vector3 spin = motion.tail<3>(), velocity = motion.head<3>() + spin.cross(node.position);
    const Vector3 material = node.orientation.conjugate() * spin;
    node.velocity = velocity + factor * (node.velocity - velocity);
    node.angular_velocity = material + factor * (node.angular_velocity - material);
  }
  state.energy_defect = 0;
  return true;
}

}  // namespace flexarm
