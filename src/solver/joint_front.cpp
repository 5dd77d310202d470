#include "solver/joint_front.h"

#include <Eigen/LU>

#include "math/simd.h"

namespace flexarm {
namespace {

/// Columns of K with respect to the master, over a rigid lever arm: d{r, spin} = {dr_m + spin_m x lever, spin_m}.
Matrix6 columns_at_master(const Matrix6& tangent, const Vector3& lever) {
  Matrix6 out = tangent;
  out.col(3) += lever.y() * tangent.col(2) - lever.z() * tangent.col(1);
  out.col(4) += lever.z() * tangent.col(0) - lever.x() * tangent.col(2);
  out.col(5) += lever.x() * tangent.col(1) - lever.y() * tangent.col(0);
  return out;
}

/// Moves rows {f, phi} to the master: {f, lever x f + phi}.
template <int Columns>
void move_rows(const Vector3& lever, Eigen::Matrix<double, 6, Columns>& rows) {
  for (int k = 0; k < Columns; ++k) rows.col(k).template tail<3>() += lever.cross(rows.col(k).template head<3>());
}

/// Adds the remainder of a joint to the diagonal block `to` of its master.
void add_to_master(const Matrix6& tangent, const FoldMaps& maps, double* to) {
  Eigen::Map<Matrix6> master(to);
  master += tangent;
  master.bottomRightCorner<3, 3>() += maps.moment_spin;
}

}  // namespace

JointFront::JointFront(const JointMap& joint, int variable, const DegreesOfFreedom& dof)
    : slave_(joint.slave), master_(joint.master), variable_(variable) {
  for (int k = 0; k < dof.size[variable]; ++k) {
    const int scalar = dof.first[variable] + k;
    if (dof.equation[scalar] < 0) continue;
    components_[count_] = k;
    scalars_[count_++] = scalar;
  }
}

template <int Size>
bool JointFront::eliminate_released(const FoldMaps& maps, double* const* blocks) {
  using Square = Eigen::Matrix<double, Size, Size>;
  using Columns = Eigen::Matrix<double, 6, Size>;
  using Rows = Eigen::Matrix<double, Size, 6>;
  const Eigen::Map<const Matrix6> tangent(blocks[slave_]);
  const int size = static_cast<int>(maps.left.cols());
  const Eigen::Map<const ReleasedSquare> own(blocks[variable_], size, size);
  Columns left = Columns::Zero(), right = Columns::Zero();
  Square pivot = Square::Identity();
  for (int k = 0; k < count_; ++k) {
    left.col(k) = maps.left.col(components_[k]);
    right.col(k) = maps.right.col(components_[k]);
    for (int i = 0; i < count_; ++i)
      pivot(i, k) = maps.released_released(components_[i], components_[k]) + own(components_[i], components_[k]);
  }
  left_.template leftCols<Size>() = left;
  right_.template leftCols<Size>() = right;
  Columns moved = tangent.lazyProduct(right);
  pivot += left.transpose().lazyProduct(moved);
  const Square inverse = pivot.inverse();
  if (!inverse.allFinite()) return false;
  inverse_.template topLeftCorner<Size, Size>() = inverse;
  if (master_ < 0) return true;

  Matrix6 at_master = columns_at_master(tangent, maps.lever_right);
  Rows row = left.transpose().lazyProduct(at_master);
  move_rows(maps.lever_left, moved);
  for (int k = 0; k < count_; ++k) {
    row.row(k).template tail<3>() += maps.released_spin.row(components_[k]);
    moved.col(k).template tail<3>() += maps.moment_released.col(components_[k]);
  }
  const Rows elimination = inverse.lazyProduct(row);
  elimination_.template topRows<Size>() = elimination;
  coupling_.template leftCols<Size>() = moved;
  move_rows(maps.lever_left, at_master);
  at_master.noalias() -= moved.lazyProduct(elimination);
  add_to_master(at_master, maps, blocks[master_]);
  return true;
}

bool JointFront::eliminate(const FoldMaps& maps, double* const* blocks) {
  if (count_ == 1) {
    bool done = false;
    simd::run([&] { done = eliminate_released<1>(maps, blocks); });
    return done;
  }
  if (count_ > 1) return eliminate_released<6>(maps, blocks);
  if (master_ < 0) return true;
  Matrix6 at_master = columns_at_master(Eigen::Map<const Matrix6>(blocks[slave_]), maps.lever_right);
  move_rows(maps.lever_left, at_master);
  add_to_master(at_master, maps, blocks[master_]);
  return true;
}

void JointFront::forward(const FoldMaps& maps, double* values) const {
  const Eigen::Map<const Vector6> slave(values + 6 * static_cast<std::size_t>(slave_));
  std::array<double, 6> rows, released{};
  for (int k = 0; k < count_; ++k) rows[k] = values[scalars_[k]] + left_.col(k).dot(slave);
  for (int i = 0; i < count_; ++i) {
    for (int k = 0; k < count_; ++k) released[i] += inverse_(i, k) * rows[k];
    values[scalars_[i]] = released[i];
  }
  if (master_ < 0) return;
  Eigen::Map<Vector6> master(values + 6 * static_cast<std::size_t>(master_));
  master += slave;
  master.tail<3>() += maps.lever_left.cross(slave.head<3>());
  for (int k = 0; k < count_; ++k) master -= released[k] * coupling_.col(k);
}

void JointFront::backward(const FoldMaps& maps, double* values) const {
  Eigen::Map<Vector6> slave(values + 6 * static_cast<std::size_t>(slave_));
  Vector6 moved = Vector6::Zero();
  if (master_ >= 0) {
    const Eigen::Map<const Vector6> master(values + 6 * static_cast<std::size_t>(master_));
    for (int k = 0; k < count_; ++k) values[scalars_[k]] -= elimination_.row(k).dot(master);
    moved = master;
    moved.head<3>() += master.tail<3>().cross(maps.lever_right);
  }
  for (int k = 0; k < count_; ++k) moved += values[scalars_[k]] * right_.col(k);
  slave = moved;
}

}  // namespace flexarm
