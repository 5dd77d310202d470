#include "simulation/mesh_change.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <set>
#include <vector>

#include "elements/halved_beam.h"
#include "joints/joint_kinematics.h"
#include "simulation/beam_sections.h"
#include "simulation/kept_momenta.h"

namespace flexarm {
namespace {

/// Halving places sections of a line elsewhere by more than this part of the line's length, or not at all.
constexpr double kUnmoved = 1e-15;

class MeshChange {
 public:
  MeshChange(const Model& before, const State& state, const Model& after, const Scheme& scheme)
      : old_(before), state_(state), new_(after), scheme_(scheme), old_nodes_(after.nodes.size(), -1) {
    out_ = sized_for(after, state);
  }

  State carried() {
    take_beams();
    take_other_nodes();
    place_nodes_of_chains();
    move_what_slides();
    keep_momenta(new_, scheme_, free_nodes(), momenta(old_, scheme_, state_), out_);
    for (NodalLoad& wrench : out_.wrenches)
      wrench.node = static_cast<int>(std::find(old_nodes_.begin(), old_nodes_.end(), wrench.node) - old_nodes_.begin());
    out_.history = {};
    out_.good_steps = 0;
    const double change = energies(new_, scheme_, out_).total() - energies(old_, scheme_, state_).total();
    (change > 0 ? out_.work : out_.dissipated) += std::abs(change);
    return std::move(out_);
  }

 private:
  using Element = BeamElement<3>;
  static const Element& element(const Model& model, const BeamLink& beam, int index) {
    return std::get<BeamGroup<3>>(model.beams).elements[beam.elements[index]];
  }

  // ---------------------------------------------------------------- which nodes and elements are the same

  void take_beams() {
    for (std::size_t link = 0; link < new_.links.size(); ++link) {
      if (!new_.links[link].beam) continue;
      const BeamLink &then = *old_.links[link].beam, &now = *new_.links[link].beam;
      for (int i = 0, j = 0; j < static_cast<int>(now.elements.size()); ++i, ++j) {
        const ElementPart &old = then.parts[i], &own = now.parts[j];
        assert(old.element == own.element);
        if (old.part == own.part)
          take_element(then, i, now, j);
        else if (own.part == 2 * old.part)
          halve(then, i, now, j), ++j;
        else
          join(then, i, now, j), ++i;
      }
    }
  }

  void take_element(const BeamLink& then, int i, const BeamLink& now, int j) {
    visit_element(new_, now, j, [&](const auto& own) {
      using Own = std::decay_t<decltype(own)>;
      const Own& old = std::get<BeamGroup<Own::kNodes>>(old_.beams).elements[then.elements[i]];
      for (int k = 0; k < Own::kNodes; ++k) old_nodes_[own.nodes[k]] = old.nodes[k];
      for (int k = 0; k < Own::kStiffnessPoints; ++k) {
        const int to = own.first_stiffness_point + k, from = old.first_stiffness_point + k;
        take_point(out_.strain_memory, state_.strain_memory, to, from);
        for (int b = 0; b < branches_; ++b)
          out_.branch_strains[branches_ * to + b] = state_.branch_strains[branches_ * from + b];
      }
      for (int k = 0; k < Own::kMassPoints; ++k)
        out_.study.mass_points[own.first_mass_point + k] = state_.study.mass_points[old.first_mass_point + k];
    });
  }

  template <class Point>
  static void take_point(std::vector<Point>& to, const std::vector<Point>& from, int own, int old) {
    if (!from.empty()) to[own] = from[old];
  }

  /// Values at the stiffness points are extended over the whole old element, or over each half.
  void halve(const BeamLink& then, int i, const BeamLink& now, int j) {
    const Element& old = element(old_, then, i);
    chains_.push_back({{&element(new_, now, j), &element(new_, now, j + 1)}, &old});
    for (const int side : {0, 1}) {
      const Element& own = element(new_, now, j + side);
      old_nodes_[own.nodes[0]] = old.nodes[side];
      old_nodes_[own.nodes[2]] = old.nodes[side + 1];
      for (int k = 0; k < Element::kStiffnessPoints; ++k)
        extend(old, side - 0.5 + 0.5 * GaussLegendre<2>::points[k], own.first_stiffness_point + k);
      changed_.insert(own.nodes.begin(), own.nodes.end());
    }
  }

  void join(const BeamLink& then, int i, const BeamLink& now, int j) {
    const Element& own = element(new_, now, j);
    chains_.push_back({{&own}, nullptr});
    for (const int side : {0, 1}) {
      const Element& old = element(old_, then, i + side);
      old_nodes_[own.nodes[side]] = old.nodes[0];
      old_nodes_[own.nodes[side + 1]] = old.nodes[2];
      extend(old, 2 * GaussLegendre<2>::points[side] + (side == 0 ? 1 : -1), own.first_stiffness_point + side);
    }
    changed_.insert(own.nodes.begin(), own.nodes.end());
  }

  void extend(const Element& old, double xi, int own) {
    const std::array<double, 2> weights = extension_weights<3>(xi);
    for (int b = 0; b < branches_; ++b) {
      Vector6 sum = Vector6::Zero();
      for (int k = 0; k < 2; ++k)
        sum += weights[k] * state_.branch_strains[branches_ * (old.first_stiffness_point + k) + b];
      out_.branch_strains[branches_ * own + b] = sum;
    }
    if (state_.strain_memory.empty()) return;
    StrainMemory sum;
    for (int k = 0; k < 2; ++k) {
      const StrainMemory& memory = state_.strain_memory[old.first_stiffness_point + k];
      sum.average += weights[k] * memory.average;
      sum.rate += weights[k] * memory.rate;
      sum.delayed_rate += weights[k] * memory.delayed_rate;
    }
    out_.strain_memory[own] = sum;
  }

  /// Nodes that belong to no beam follow each other in the same order in both models.
  void take_other_nodes() {
    const auto others = [](const Model& model) {
      std::vector<bool> is_of_beam(model.nodes.size(), false);
      for_each_element(model.beams, [&](const auto& element) {
        for (const int node : element.nodes) is_of_beam[node] = true;
      });
      std::vector<int> nodes;
      for (std::size_t i = 0; i < is_of_beam.size(); ++i)
        if (!is_of_beam[i]) nodes.push_back(static_cast<int>(i));
      return nodes;
    };
    const std::vector<int> old = others(old_), own = others(new_);
    assert(old.size() == own.size());
    for (std::size_t i = 0; i < own.size(); ++i) old_nodes_[own[i]] = old[i];
    for (std::size_t i = 0; i < old_nodes_.size(); ++i) {
      if (old_nodes_[i] < 0) continue;
      out_.nodes[i] = state_.nodes[old_nodes_[i]];
      if (!state_.study.reactions.empty()) out_.study.reactions[i] = state_.study.reactions[old_nodes_[i]];
    }
  }

  // ---------------------------------------------------------------- positions and velocities

  /// The elements that take the place of others. Only the ends of the chain keep their positions.
  struct Chain {
    ElementChain elements;
    const Element* halved;  ///< the old element of which they are halves; null: they were two
  };

  void place_nodes_of_chains() {
    for (const Chain& chain : chains_) {
      std::vector<int> indices(1, chain.elements.front()->nodes[0]);
      for (const Element* one : chain.elements) indices.insert(indices.end(), one->nodes.begin() + 1, one->nodes.end());
      std::vector<NodeState> nodes;
      nodes.reserve(indices.size());
      for (const int index : indices) nodes.push_back(out_.nodes[index]);
      if (chain.halved) {
        const auto& old = chain.halved->nodes;
        const ElementNodeStates whole = {state_.nodes[old[0]], state_.nodes[old[1]], state_.nodes[old[2]]};
        nodes[1] = interpolated_node(whole, -0.5);
        nodes[3] = interpolated_node(whole, 0.5);
      }
      settle_between(chain.elements, prestrain_at(new_, chain.elements[0]->prestrain, state_.time), nodes);
      for (std::size_t i = 0; i < nodes.size(); ++i) out_.nodes[indices[i]] = nodes[i];
    }
  }

  /// Moves sections that slide on a changed line to their new places, with everything that they carry. Velocities stay.
  void move_what_slides() {
    for (std::size_t j = 0; j < new_.joints.size(); ++j) {
      const JointMap& joint = new_.joints[j];
      if (joint.kind != JointMapKind::Slide) continue;
      const std::vector<int>& line = new_.slide_lines[joint.line].nodes;
      if (std::none_of(line.begin(), line.end(), [&](int node) { return changed_.count(node) > 0; })) continue;
      std::vector<NodePose> poses;
      poses.reserve(out_.nodes.size());
      for (const NodeState& node : out_.nodes) poses.push_back(node_pose(node));
      const NodePose place = slave_pose(new_, static_cast<int>(j), poses, out_.released[j]);
      const NodeState found = out_.nodes[joint.slave];
      const Quaternion turn = (place.orientation * found.orientation.conjugate()).normalized();
      if ((place.position - found.position).norm() <= kUnmoved * new_.length_scale && turn.vec().norm() <= kUnmoved)
        continue;
      for (std::size_t i = 0; i < out_.nodes.size(); ++i)
        if (is_carried(static_cast<int>(i), joint.slave)) move(found.position, place.position, turn, out_.nodes[i]);
    }
  }

  bool is_carried(int node, int by) const {
    while (node >= 0 && node != by) node = new_.node_parents[node];
    return node == by;
  }

  static void move(const Vector3& from, const Vector3& to, const Quaternion& turn, NodeState& node) {
    const Vector3 spin = node.orientation * node.angular_velocity;
    node.position = to + turn * (node.position - from);
    node.orientation = so3::nearer_of_two(Quaternion((turn * node.orientation).normalized()), node.orientation);
    node.angular_velocity = node.orientation.conjugate() * spin;
  }

  /// The nodes of changed elements whose velocities no joint determines or passes on.
  std::vector<int> free_nodes() const {
    std::set<int> held;
    for (const JointMap& joint : new_.joints) {
      held.insert(joint.slave);
      if (joint.kind != JointMapKind::Slide) held.insert(joint.master);
    }
    for (const LoopClosure& closure : new_.closures) held.insert({closure.parent, closure.child});
    std::vector<int> nodes;
    std::set_difference(changed_.begin(), changed_.end(), held.begin(), held.end(), std::back_inserter(nodes));
    return nodes;
  }

  const Model& old_;
  const State& state_;
  const Model& new_;
  const Scheme& scheme_;
  State out_;
  const int branches_ = new_.maxwell_branches;  // per stiffness point
  std::vector<int> old_nodes_;                  // per node: the old one, or -1
  std::vector<Chain> chains_;
  std::set<int> changed_;  // nodes of elements that were halved or joined
};

}  // namespace

State on_changed_mesh(const Model& before, const State& state, const Model& after, const Scheme& scheme) {
  return MeshChange(before, state, after, scheme).carried();
}

State sized_for(const Model& model, State state) {
  state.halved = model.halved;
  state.nodes.resize(model.nodes.size());
  state.study.mass_points.resize(model.mass_point_count);
  state.study.strain_rates.assign(model.stiffness_point_count, Vector6::Zero());
  state.branch_strains.assign(model.stiffness_point_count * model.maxwell_branches, Vector6::Zero());
  if (!state.strain_memory.empty()) state.strain_memory.assign(model.stiffness_point_count, {});
  if (!state.study.reactions.empty()) state.study.reactions.assign(model.nodes.size(), Vector6::Zero());
  return state;
}

}  // namespace flexarm
