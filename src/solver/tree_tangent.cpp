#include "solver/tree_tangent.h"

#include <algorithm>
#include <cassert>

namespace flexarm {
bool TreeTangent::suits(const Model& model, const DegreesOfFreedom& dof) {
  return TreeOrder(model, dof).is_complete();
}

TreeTangent::TreeTangent(const Model& model, const DegreesOfFreedom& dof)
    : model_(model),
      order_(model, dof),
      dof_(order_.dof()),
      blocks_(model, dof_),
      elements_(order_),
      bordered_(model, dof_, order_, blocks_),
      values_(dof_.scalar_count) {
  joints_.reserve(model.joints.size());
  for (const JointMap& joint : model.joints)
    joints_.emplace_back(joint, dof_.variable_of_joint(static_cast<int>(joints_.size())), dof_);
  keeps_elements_apart_ = true;
  for (std::size_t v = 0; v < dof_.size.size(); ++v) diagonal_blocks_.push_back(blocks_.diagonal(static_cast<int>(v)));
  for (std::size_t at = 0; at < blocks_.elements.size(); at += 36) element_blocks_.push_back(&blocks_.elements[at]);
}

double TreeTangent::cost_of_factors() const {
  // Measured: bench_kernels --benchmark_filter=step_shares, counter "new/kept". With borders, this value minimises the
  // work (docs/notes/tree.md 4).
  const std::vector<TreePart>& parts = order_.parts();
  return std::any_of(parts.begin(), parts.end(), [](const TreePart& part) { return part.has_border; }) ? 3.8 : 2.2;
}

void TreeTangent::set_zero() {
  for (std::size_t v = 0; v < dof_.size.size(); ++v) std::fill_n(diagonal_blocks_[v], dof_.size[v] * dof_.size[v], 0.0);
  for (Eigen::MatrixXd& closure : blocks_.closures) closure.setZero();
  // Most couplings couple fewer nodes than they may.
  for (std::size_t k = 0; k < blocks_.couplings.size(); ++k) {
    blocks_.pieces[k].tangent.set_zero();
    if (blocks_.couplings[k].size() == 0) continue;
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(order_.coupled_nodes(static_cast<int>(k)).size());
    blocks_.couplings[k].topLeftCorner(size, size).setZero();
  }
  blocks_.held.clear();
}

void TreeTangent::add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) {
  assert(index >= 0 && index < dof_.size[dof_.variable_of_closure(closure)]);
  Eigen::MatrixXd& values = blocks_.closures[closure];
  const int own = 12 + index;
  values.block<6, 6>(0, 0) += multiplier * maps.child_child;
  values.block<6, 6>(0, 6) += multiplier * maps.child_parent;
  values.block<6, 6>(6, 0) += multiplier * maps.parent_child;
  values.block<6, 6>(6, 6) += multiplier * maps.parent_parent;
  values.col(own).segment<6>(0) += maps.left.child;
  values.col(own).segment<6>(6) += maps.left.parent;
  values.row(own).segment<6>(0) += maps.right.child;
  values.row(own).segment<6>(6) += maps.right.parent;
}

/// Blocks of a node with itself go to the node's diagonal block, so that the elimination need not handle them.
void TreeTangent::add_coupling(int index, const Eigen::Ref<const Eigen::MatrixXd>& blocks) {
  const std::vector<int>& nodes = order_.coupled_nodes(index);
  assert(blocks.cols() == blocks.rows() && blocks.rows() == 6 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    add_to_node(nodes[i], blocks.block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(i)));
  blocks_.couplings[index].topLeftCorner(blocks.rows(), blocks.cols()) += blocks;
}

void TreeTangent::add_coupling(int index, const PieceTangent& tangent) {
  const std::vector<int>& nodes = order_.coupled_nodes(index);
  const std::vector<std::array<int, 2>>& pairs = model_.force_elements[index]->pieces().pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    for (int i = 0; i < 2; ++i)
      if (pairs[p][i] >= 0)
        add_to_node(nodes[pairs[p][i]], tangent.blocks.block<6, 6>(6 * i, static_cast<Eigen::Index>(12 * p) + 6 * i));
  PieceTangent& pieces = blocks_.pieces[index].tangent;
  pieces.blocks = tangent.blocks;
  pieces.left = -tangent.left;
  pieces.right = tangent.right;
  pieces.inner = tangent.inner;
}

/// The elimination folds; here only the windows of sliders are set.
void TreeTangent::fold(int joint) {
  if (model_.joints[joint].kind != JointMapKind::Slide) return;
  const SlideMaps& maps = blocks_.slide_maps[joint];
  order_.set_window(joint, {maps.first, maps.first + maps.count});
}

void TreeTangent::hold_row(int joint, int component, int first, const ReleasedVector& coefficients) {
  blocks_.held.push_back({joint, component, first, coefficients});
}

/// Replaces rows in the maps and blocks of joints without a border. For other joints, the fronts replace them.
void TreeTangent::hold_rows() {
  for (const auto& [joint, component, first, coefficients] : blocks_.held) {
    const JointFront& front = joints_[joint];
    if (order_.parts()[order_.completion(front.variable())].has_border) continue;
    flexarm::hold_row(blocks_.maps[joint], diagonal_block(front.variable()), front.has_master(), component, first,
                      coefficients);
  }
}

// ---------------------------------------------------------------- factors

/// Condenses the elements that a part adds to its front.
void TreeTangent::condense(const TreePart& part, double* values) {
  for (const int element : part.elements)
    elements_.set_condensed(element, condensation_->prepare(element, blocks_, values));
}

/// `b`: null, or a right-hand side, already in `values_`, which gets its forward elimination as well.
bool TreeTangent::eliminate(const Eigen::VectorXd* b) {
  order_.update();
  hold_rows();
  bordered_.begin();
  if (condensation_) condensation_->begin();
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    const int j = parts[p].joint;
    if (condensation_) condense(parts[p], b ? values_.data() : nullptr);
    const bool is_element = !parts[p].has_border && j < 0;  // it handles the right-hand side in the same call
    const bool done = parts[p].has_border ? bordered_.eliminate(p)
                      : is_element        ? elements_.eliminate(p, blocks_.elements.data(), blocks_.diagonals.data(),
                                                         b ? values_.data() : nullptr)
                                          : joints_[j].eliminate(blocks_.maps[j], diagonal_blocks_.data());
    if (!done) {
      singular_variable_ = j >= 0 ? dof_.variable_of_joint(j) : parts[p].nodes[parts[p].node_count - 1];
      return false;
    }
    if (b && !is_element) forward(p, *b);
  }
  return true;
}

bool TreeTangent::factorise_and_solve(Eigen::VectorXd& b) {
  set_right_hand_side(b);
  return eliminate(&b) && substitute_back(b);
}

// ---------------------------------------------------------------- solution

void TreeTangent::set_right_hand_side(const Eigen::VectorXd& b) {
  assert(b.size() == dof_.unknowns);
  std::fill(values_.begin(), values_.end(), 0.0);
  for (const auto& [scalar, equation, count] : dof_.runs)
    std::copy_n(b.data() + equation, count, values_.data() + scalar);
}

void TreeTangent::forward(int p, const Eigen::VectorXd& b) {
  const TreePart& part = order_.parts()[p];
  part.has_border   ? bordered_.forward(p, b, values_)
  : part.joint >= 0 ? joints_[part.joint].forward(blocks_.maps[part.joint], values_.data())
                    : elements_.forward(p, blocks_.elements.data(), values_.data());
}

bool TreeTangent::substitute_back(Eigen::VectorXd& b) {
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = static_cast<int>(parts.size()) - 1; p >= 0; --p)
    parts[p].has_border   ? bordered_.backward(p, values_)
    : parts[p].joint >= 0 ? joints_[parts[p].joint].backward(blocks_.maps[parts[p].joint], values_.data())
                          : elements_.backward(p, blocks_.elements.data(), values_.data());
  if (condensation_) condensation_->backward(values_.data());
  for (const auto& [scalar, equation, count] : dof_.runs)
    std::copy_n(values_.data() + scalar, count, b.data() + equation);
  return b.allFinite();
}

bool TreeTangent::solve(Eigen::VectorXd& b) {
  set_right_hand_side(b);
  if (condensation_) condensation_->forward(values_.data());
  for (int p = 0; p < static_cast<int>(order_.parts().size()); ++p) forward(p, b);
  return substitute_back(b);
}

}  // namespace flexarm
