#include "solver/tree_tangent.h"

#include <algorithm>

#include "math/simd.h"
#include "solver/element_front.h"

namespace flexarm {
namespace {

/// Calls visit(ElementFront<Nodes>()) for the number of nodes at hand.
template <class Visitor>
auto with_front(int node_count, Visitor&& visit) {
  switch (node_count) {
    case 2:
      return visit(ElementFront<2>());
    case 3:
      return visit(ElementFront<3>());
    case 4:
      return visit(ElementFront<4>());
    default:
      return visit(ElementFront<5>());
  }
}

/// K with the columns that a rigid arm to the master gives: d{r, spin} = {dr_m + spin_m x lever, spin_m}.
Matrix6 columns_at_master(const Matrix6& tangent, const Vector3& lever) {
  Matrix6 out = tangent;
  out.col(3) += lever.y() * tangent.col(2) - lever.z() * tangent.col(1);
  out.col(4) += lever.z() * tangent.col(0) - lever.x() * tangent.col(2);
  out.col(5) += lever.x() * tangent.col(1) - lever.y() * tangent.col(0);
  return out;
}

/// Rows {f, phi} moved to the master: {f, lever x f + phi}.
template <int Columns>
void move_rows(const Vector3& lever, Eigen::Matrix<double, 6, Columns>& rows) {
  for (int k = 0; k < Columns; ++k) rows.col(k).template tail<3>() += lever.cross(rows.col(k).template head<3>());
}

/// What a joint leaves at its master, whose block on the diagonal is `to`.
void add_to_master(const Matrix6& tangent, const FoldMaps& maps, double* to) {
  Eigen::Map<Matrix6> master(to);
  master += tangent;
  master.bottomRightCorner<3, 3>() += maps.moment_spin;
}

}  // namespace

bool TreeTangent::suits(const Model& model, const DegreesOfFreedom& dof) {
  return TreeOrder(model, dof).is_complete();
}

TreeTangent::TreeTangent(const Model& model, const DegreesOfFreedom& dof)
    : model_(model),
      dof_(dof),
      blocks_(model, dof),
      order_(model, dof),
      bordered_(model, dof, order_, blocks_),
      joints_(model.joints.size()),
      values_(dof.scalar_count) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    JointFront& front = joints_[j];
    front.slave = model.joints[j].slave;
    front.master = model.joints[j].master;
    front.variable = dof.variable_of_joint(static_cast<int>(j));
    for (int k = 0; k < dof.size[front.variable]; ++k) {
      const int scalar = dof.first[front.variable] + k;
      if (dof.equation[scalar] < 0) continue;
      front.components[front.count] = k;
      front.scalars[front.count++] = scalar;
    }
  }
  std::size_t pivots = 0;
  for (const TreePart& part : order_.parts()) {
    first_pivot_.push_back(pivots);
    if (part.node_count > 0) pivots += 6 * (part.node_count - 1);
  }
  pivots_.resize(pivots);
  keeps_elements_apart_ = true;
  for (std::size_t v = 0; v < dof.size.size(); ++v) diagonal_blocks_.push_back(blocks_.diagonal(static_cast<int>(v)));
  for (std::size_t at = 0; at < blocks_.elements.size(); at += 36) element_blocks_.push_back(&blocks_.elements[at]);
}

double TreeTangent::cost_of_factors() const {
  // bench_kernels --benchmark_filter=step_shares, counter "new/kept"; with borders what makes least work (tree.md 4)
  const std::vector<TreePart>& parts = order_.parts();
  return std::any_of(parts.begin(), parts.end(), [](const TreePart& part) { return part.has_border; }) ? 3 : 2.2;
}

void TreeTangent::set_zero() {
  for (std::size_t v = 0; v < dof_.size.size(); ++v) std::fill_n(diagonal_blocks_[v], dof_.size[v] * dof_.size[v], 0.0);
  for (Eigen::MatrixXd& closure : blocks_.closures) closure.setZero();
  blocks_.held.clear();
}

void TreeTangent::add_closure(int closure, int index, double multiplier, const ClosureMaps& maps) {
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

void TreeTangent::add_coupling(int closure, const Eigen::Matrix<double, 12, 12>& blocks) {
  blocks_.closures[closure].topLeftCorner<12, 12>() += blocks;
}

/// Is left to the elimination, but for where sliders are.
void TreeTangent::fold(int joint) {
  if (model_.joints[joint].kind != JointMapKind::Slide) return;
  const SlideMaps& maps = blocks_.slide_maps[joint];
  order_.set_window(joint, {maps.first, maps.first + maps.count});
}

void TreeTangent::hold_row(int joint, int component, int first, const ReleasedVector& coefficients) {
  blocks_.held.push_back({joint, component, first, coefficients});
}

/// In the maps and blocks of joints without a border; the others replace rows in their fronts.
void TreeTangent::hold_rows() {
  for (const auto& [joint, component, first, coefficients] : blocks_.held) {
    const JointFront& front = joints_[joint];
    if (order_.parts()[order_.completion(front.variable)].has_border) continue;
    FoldMaps& maps = blocks_.maps[joint];
    const int size = static_cast<int>(maps.left.cols());
    maps.left.col(component).setZero();
    if (front.master >= 0) maps.released_spin.row(component).setZero();
    Eigen::Map<ReleasedSquare>(diagonal_block(front.variable), size, size).row(component).setZero();
    maps.released_released.row(component).setZero();
    maps.released_released.row(component).segment(first, coefficients.size()) = coefficients.transpose();
  }
}

// ---------------------------------------------------------------- factors

std::array<double*, 5> TreeTangent::node_values(const TreePart& part, std::vector<double>& values, int size) const {
  std::array<double*, 5> blocks{};
  for (int i = 0; i < part.node_count; ++i) blocks[i] = values.data() + static_cast<std::size_t>(size) * part.nodes[i];
  return blocks;
}

bool TreeTangent::eliminate_element(int p) {
  const TreePart& part = order_.parts()[p];
  const std::array<double*, 5> diagonals = node_values(part, blocks_.diagonals, 36);
  return with_front(part.node_count, [&](auto front) {
    return front.eliminate(blocks_.elements.data() + 36 * part.first_block, diagonals.data(),
                           pivots_.data() + first_pivot_[p]);
  });
}

template <int Size>
bool TreeTangent::eliminate_released(int joint) {
  using Square = Eigen::Matrix<double, Size, Size>;
  using Columns = Eigen::Matrix<double, 6, Size>;
  using Rows = Eigen::Matrix<double, Size, 6>;
  JointFront& front = joints_[joint];
  const FoldMaps& maps = blocks_.maps[joint];
  const Eigen::Map<const Matrix6> tangent(diagonal_block(front.slave));
  const int size = static_cast<int>(maps.left.cols());
  const Eigen::Map<const ReleasedSquare> own(diagonal_block(front.variable), size, size);
  Columns left = Columns::Zero(), right = Columns::Zero();
  Square pivot = Square::Identity();
  for (int k = 0; k < front.count; ++k) {
    left.col(k) = maps.left.col(front.components[k]);
    right.col(k) = maps.right.col(front.components[k]);
    for (int i = 0; i < front.count; ++i)
      pivot(i, k) = maps.released_released(front.components[i], front.components[k]) +
                    own(front.components[i], front.components[k]);
  }
  front.left.template leftCols<Size>() = left;
  front.right.template leftCols<Size>() = right;
  Columns moved = tangent.lazyProduct(right);
  pivot += left.transpose().lazyProduct(moved);
  const Square inverse = pivot.inverse();
  if (!inverse.allFinite()) return false;
  front.inverse.template topLeftCorner<Size, Size>() = inverse;
  if (front.master < 0) return true;

  Matrix6 at_master = columns_at_master(tangent, maps.lever_right);
  Rows row = left.transpose().lazyProduct(at_master);
  move_rows(maps.lever_left, moved);
  for (int k = 0; k < front.count; ++k) {
    row.row(k).template tail<3>() += maps.released_spin.row(front.components[k]);
    moved.col(k).template tail<3>() += maps.moment_released.col(front.components[k]);
  }
  const Rows elimination = inverse.lazyProduct(row);
  front.elimination.template topRows<Size>() = elimination;
  front.coupling.template leftCols<Size>() = moved;
  move_rows(maps.lever_left, at_master);
  at_master.noalias() -= moved.lazyProduct(elimination);
  add_to_master(at_master, maps, diagonal_block(front.master));
  return true;
}

bool TreeTangent::eliminate_joint(int joint) {
  const JointFront& front = joints_[joint];
  if (front.count == 1) {
    bool done = false;
    simd::run([&] { done = eliminate_released<1>(joint); });
    return done;
  }
  if (front.count > 1) return eliminate_released<6>(joint);
  if (front.master < 0) return true;
  const FoldMaps& maps = blocks_.maps[joint];
  Matrix6 at_master = columns_at_master(Eigen::Map<const Matrix6>(diagonal_block(front.slave)), maps.lever_right);
  move_rows(maps.lever_left, at_master);
  add_to_master(at_master, maps, diagonal_block(front.master));
  return true;
}

bool TreeTangent::factorise() {
  order_.update();
  hold_rows();
  bordered_.begin();
  const std::vector<TreePart>& parts = order_.parts();
  for (int p = 0; p < static_cast<int>(parts.size()); ++p)
    if (!(parts[p].has_border   ? bordered_.eliminate(p)
          : parts[p].joint >= 0 ? eliminate_joint(parts[p].joint)
                                : eliminate_element(p))) {
      singular_variable_ =
          parts[p].joint >= 0 ? dof_.variable_of_joint(parts[p].joint) : parts[p].nodes[parts[p].node_count - 1];
      return false;
    }
  return true;
}

// ---------------------------------------------------------------- solution

void TreeTangent::forward_element(int p) {
  const TreePart& part = order_.parts()[p];
  const std::array<double*, 5> r = node_values(part, values_, 6);
  with_front(part.node_count, [&](auto front) {
    front.forward(blocks_.elements.data() + 36 * part.first_block, pivots_.data() + first_pivot_[p], r.data());
  });
}

void TreeTangent::backward_element(int p) {
  const TreePart& part = order_.parts()[p];
  const std::array<double*, 5> r = node_values(part, values_, 6);
  with_front(part.node_count,
             [&](auto front) { front.backward(blocks_.elements.data() + 36 * part.first_block, r.data()); });
}

void TreeTangent::forward_joint(int joint) {
  const JointFront& front = joints_[joint];
  const Eigen::Map<const Vector6> slave(values_.data() + 6 * static_cast<std::size_t>(front.slave));
  const int count = front.count;
  std::array<double, 6> rows, released{};
  for (int k = 0; k < count; ++k) rows[k] = values_[front.scalars[k]] + front.left.col(k).dot(slave);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < count; ++k) released[i] += front.inverse(i, k) * rows[k];
    values_[front.scalars[i]] = released[i];
  }
  if (front.master < 0) return;
  Eigen::Map<Vector6> master(values_.data() + 6 * static_cast<std::size_t>(front.master));
  master += slave;
  master.tail<3>() += blocks_.maps[joint].lever_left.cross(slave.head<3>());
  for (int k = 0; k < count; ++k) master -= released[k] * front.coupling.col(k);
}

void TreeTangent::backward_joint(int joint) {
  const JointFront& front = joints_[joint];
  Eigen::Map<Vector6> slave(values_.data() + 6 * static_cast<std::size_t>(front.slave));
  Vector6 moved = Vector6::Zero();
  if (front.master >= 0) {
    const Eigen::Map<const Vector6> master(values_.data() + 6 * static_cast<std::size_t>(front.master));
    for (int k = 0; k < front.count; ++k) values_[front.scalars[k]] -= front.elimination.row(k).dot(master);
    moved = master;
    moved.head<3>() += master.tail<3>().cross(blocks_.maps[joint].lever_right);
  }
  for (int k = 0; k < front.count; ++k) moved += values_[front.scalars[k]] * front.right.col(k);
  slave = moved;
}

bool TreeTangent::solve(Eigen::VectorXd& b) {
  const std::vector<TreePart>& parts = order_.parts();
  const int part_count = static_cast<int>(parts.size());
  for (int scalar = 0; scalar < dof_.scalar_count; ++scalar) {
    const int equation = dof_.equation[scalar];
    values_[scalar] = equation >= 0 ? b[equation] : 0.0;
  }
  for (int p = 0; p < part_count; ++p)
    parts[p].has_border   ? bordered_.forward(p, b, values_)
    : parts[p].joint >= 0 ? forward_joint(parts[p].joint)
                          : forward_element(p);
  for (int p = part_count - 1; p >= 0; --p)
    parts[p].has_border   ? bordered_.backward(p, values_)
    : parts[p].joint >= 0 ? backward_joint(parts[p].joint)
                          : backward_element(p);
  for (int scalar = 0; scalar < dof_.scalar_count; ++scalar)
    if (dof_.equation[scalar] >= 0) b[dof_.equation[scalar]] = values_[scalar];
  return b.allFinite();
}

}  // namespace flexarm
