#include "solver/tree_tangent.h"

#include <algorithm>

#include "math/so3.h"
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
  out.rightCols<3>().noalias() -= tangent.leftCols<3>().lazyProduct(so3::hat(lever));
  return out;
}

/// Rows {f, phi} moved to the master: {f, lever x f + phi}.
template <int Columns>
void move_rows(const Vector3& lever, Eigen::Matrix<double, 6, Columns>& rows) {
  rows.template bottomRows<3>() += so3::hat(lever).lazyProduct(rows.template topRows<3>());
}

}  // namespace

std::vector<TreeTangent::Part> TreeTangent::parts_of(const Model& model, const DegreesOfFreedom& dof) {
  std::vector<std::vector<Part>> outboard(model.nodes.size());  // elements by their first node
  std::size_t pivots = 0, parts_in_all = model.joints.size();
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int kNodes = std::decay_t<decltype(element)>::kNodes;
    Part part;
    part.node_count = kNodes;
    std::copy(element.nodes.begin(), element.nodes.end(), part.nodes.begin());
    part.first_block = element.first_block;
    part.first_pivot = pivots;
    pivots += ElementFront<kNodes>::kEliminated;
    outboard[element.nodes[0]].push_back(part);
    ++parts_in_all;
  });
  std::vector<char> reached(model.nodes.size(), false);
  std::vector<Part> parts, line;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointMap& joint = model.joints[j];
    if (joint.master >= 0 && !reached[joint.master]) return {};
    if (reached[joint.slave]) return {};
    reached[joint.slave] = true;
    parts.emplace_back();
    parts.back().joint = static_cast<int>(j);
    line = outboard[joint.slave];
    while (!line.empty()) {
      const Part part = line.back();
      line.pop_back();
      parts.push_back(part);
      for (int i = 1; i < part.node_count; ++i) {
        const int node = part.nodes[i];
        if (reached[node] || dof.slave_joint[node] >= 0) return {};
        reached[node] = true;
        line.insert(line.end(), outboard[node].begin(), outboard[node].end());
      }
    }
  }
  const bool all_reached = std::all_of(reached.begin(), reached.end(), [](char is_reached) { return is_reached; });
  return all_reached && parts.size() == parts_in_all ? parts : std::vector<Part>();
}

bool TreeTangent::suits(const Model& model, const DegreesOfFreedom& dof) {
  const bool has_slides = std::any_of(model.joints.begin(), model.joints.end(),
                                      [](const JointMap& joint) { return joint.kind == JointMapKind::Slide; });
  return !has_slides && model.closures.empty() && dof.mimics.empty() && !model.joints.empty() &&
         !parts_of(model, dof).empty();
}

TreeTangent::TreeTangent(const Model& model, const DegreesOfFreedom& dof)
    : parts_(parts_of(model, dof)),
      joints_(model.joints.size()),
      diagonals_(36 * dof.size.size()),
      right_hand_sides_(6 * model.nodes.size()) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    first_equation_.push_back(dof.slave_joint[i] >= 0 ? -1 : dof.equation[dof.first[i]]);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    JointFront& front = joints_[j];
    front.slave = model.joints[j].slave;
    front.master = model.joints[j].master;
    front.variable = dof.variable_of_joint(static_cast<int>(j));
    for (int k = 0; k < dof.size[front.variable]; ++k) {
      const int equation = dof.equation[dof.first[front.variable] + k];
      if (equation < 0) continue;
      front.components[front.count] = k;
      front.equations[front.count++] = equation;
    }
  }
  std::size_t blocks = 0, pivots = 0;
  for (const Part& part : parts_) {
    blocks = std::max(blocks, part.first_block + static_cast<std::size_t>(part.node_count * part.node_count));
    if (part.node_count > 0) pivots = std::max<std::size_t>(pivots, part.first_pivot + 6 * (part.node_count - 1));
  }
  elements_.resize(36 * blocks);
  pivots_.resize(pivots);
  for (std::size_t v = 0; v < dof.size.size(); ++v) diagonal_blocks_.push_back(diagonals_.data() + 36 * v);
  for (std::size_t b = 0; b < blocks; ++b) element_blocks_.push_back(elements_.data() + 36 * b);
}

double TreeTangent::cost_of_factors() const {
  return 2.2;  // bench_kernels --benchmark_filter=step_shares, counter "new/kept"
}

void TreeTangent::set_zero() {
  std::fill(diagonals_.begin(), diagonals_.end(), 0.0);
  std::fill(elements_.begin(), elements_.end(), 0.0);
}

void TreeTangent::hold_row(int joint, int component, int first, const ReleasedVector& coefficients) {
  JointFront& front = joints_[joint];
  const int size = static_cast<int>(front.maps.left.cols());
  front.maps.left.col(component).setZero();
  if (front.master >= 0) front.maps.released_master.row(component).setZero();
  Eigen::Map<ReleasedSquare>(diagonal_block(front.variable), size, size).row(component).setZero();
  front.maps.released_released.row(component).setZero();
  front.maps.released_released.row(component).segment(first, coefficients.size()) = coefficients.transpose();
}

// ---------------------------------------------------------------- factors

template <class Pointer, class Values>
std::array<Pointer, 5> TreeTangent::node_blocks(const Part& part, Values& values, int size) const {
  std::array<Pointer, 5> blocks{};
  for (int i = 0; i < part.node_count; ++i) blocks[i] = values.data() + static_cast<std::size_t>(size) * part.nodes[i];
  return blocks;
}

bool TreeTangent::eliminate(const Part& part) {
  const std::array<double*, 5> diagonals = node_blocks<double*>(part, diagonals_, 36);
  return with_front(part.node_count, [&](auto front) {
    return front.eliminate(elements_.data() + 36 * part.first_block, diagonals.data(),
                           pivots_.data() + part.first_pivot);
  });
}

template <int Size>
bool TreeTangent::eliminate_released(JointFront& front) {
  using Square = Eigen::Matrix<double, Size, Size>;
  using Columns = Eigen::Matrix<double, 6, Size>;
  using Rows = Eigen::Matrix<double, Size, 6>;
  const FoldMaps& maps = front.maps;
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
    row.row(k) += maps.released_master.row(front.components[k]);
    moved.col(k) += maps.master_released.col(front.components[k]);
  }
  const Rows elimination = inverse.lazyProduct(row);
  front.elimination.template topRows<Size>() = elimination;
  front.coupling.template leftCols<Size>() = moved;
  move_rows(maps.lever_left, at_master);
  at_master.noalias() -= moved.lazyProduct(elimination);
  add_to_master(front, at_master);
  return true;
}

void TreeTangent::add_to_master(const JointFront& front, const Matrix6& tangent) {
  Eigen::Map<Matrix6>(diagonal_block(front.master)) += tangent + front.maps.master_master;
}

bool TreeTangent::eliminate(JointFront& front) {
  if (front.count == 1) return eliminate_released<1>(front);
  if (front.count > 1) return eliminate_released<6>(front);
  if (front.master < 0) return true;
  Matrix6 at_master = columns_at_master(Eigen::Map<const Matrix6>(diagonal_block(front.slave)), front.maps.lever_right);
  move_rows(front.maps.lever_left, at_master);
  add_to_master(front, at_master);
  return true;
}

bool TreeTangent::factorise() {
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part)
    if (!(part->joint >= 0 ? eliminate(joints_[part->joint]) : eliminate(*part))) return false;
  return true;
}

// ---------------------------------------------------------------- solution

void TreeTangent::forward(const Part& part) {
  const std::array<double*, 5> r = node_blocks<double*>(part, right_hand_sides_, 6);
  with_front(part.node_count, [&](auto front) {
    front.forward(elements_.data() + 36 * part.first_block, pivots_.data() + part.first_pivot, r.data());
  });
}

void TreeTangent::backward(const Part& part) {
  const std::array<double*, 5> r = node_blocks<double*>(part, right_hand_sides_, 6);
  with_front(part.node_count, [&](auto front) { front.backward(elements_.data() + 36 * part.first_block, r.data()); });
}

void TreeTangent::forward(const JointFront& front, Eigen::VectorXd& b) {
  const Eigen::Map<const Vector6> slave(right_hand_sides_.data() + 6 * static_cast<std::size_t>(front.slave));
  const int count = front.count;
  ReleasedVector released(count);
  for (int k = 0; k < count; ++k) released[k] = b[front.equations[k]] + front.left.col(k).dot(slave);
  released = front.inverse.topLeftCorner(count, count).lazyProduct(released).eval();
  for (int k = 0; k < count; ++k) b[front.equations[k]] = released[k];
  if (front.master < 0) return;
  Eigen::Map<Vector6> master(right_hand_sides_.data() + 6 * static_cast<std::size_t>(front.master));
  master += slave;
  master.tail<3>() += front.maps.lever_left.cross(slave.head<3>());
  for (int k = 0; k < count; ++k) master -= released[k] * front.coupling.col(k);
}

void TreeTangent::backward(const JointFront& front, Eigen::VectorXd& b) {
  Eigen::Map<Vector6> slave(right_hand_sides_.data() + 6 * static_cast<std::size_t>(front.slave));
  Vector6 moved = Vector6::Zero();
  if (front.master >= 0) {
    const Eigen::Map<const Vector6> master(right_hand_sides_.data() + 6 * static_cast<std::size_t>(front.master));
    for (int k = 0; k < front.count; ++k) b[front.equations[k]] -= front.elimination.row(k).dot(master);
    moved = master;
    moved.head<3>() += master.tail<3>().cross(front.maps.lever_right);
  }
  for (int k = 0; k < front.count; ++k) moved += b[front.equations[k]] * front.right.col(k);
  slave = moved;
}

bool TreeTangent::solve(Eigen::VectorXd& b) {
  const auto node_values = [&](std::size_t i) { return Eigen::Map<Vector6>(right_hand_sides_.data() + 6 * i); };
  for (std::size_t i = 0; i < first_equation_.size(); ++i)
    if (first_equation_[i] < 0)
      node_values(i).setZero();
    else
      node_values(i) = b.segment<6>(first_equation_[i]);
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part)
    part->joint >= 0 ? forward(joints_[part->joint], b) : forward(*part);
  for (const Part& part : parts_) part.joint >= 0 ? backward(joints_[part.joint], b) : backward(part);
  for (std::size_t i = 0; i < first_equation_.size(); ++i)
    if (first_equation_[i] >= 0) b.segment<6>(first_equation_[i]) = node_values(i);
  return b.allFinite();
}

}  // namespace flexarm
