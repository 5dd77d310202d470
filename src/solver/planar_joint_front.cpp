#include "solver/planar_joint_front.h"

#include <cmath>

namespace flexarm {
namespace {

/// Columns with respect to the master: {dr_m + spin_m n x lever, spin_m}.
Matrix3 columns_at_master(const Matrix3& tangent, const Vector2& lever) {
  Matrix3 out = tangent;
  out.col(2) += lever.x() * tangent.col(1) - lever.y() * tangent.col(0);
  return out;
}

/// Moves rows to the master: {f, phi + lever x f}.
template <class Rows>
void move_rows(const Vector2& lever, Rows& rows) {
  rows.row(2) += lever.x() * rows.row(1) - lever.y() * rows.row(0);
}

double scale_of(double a, double b) {
  const double scale = std::abs(a) + std::abs(b);
  return scale > 0 ? scale : 1.0;
}

}  // namespace

PlanarJointFront::InSpace::InSpace(const JointMap& joint, int variable, const DegreesOfFreedom& dof)
    : front(joint, variable, dof),
      first(dof.first[variable]),
      count(dof.size[variable]),
      blocks(dof.size.size(), nullptr),
      values(dof.scalar_count) {}

PlanarJointFront::PlanarJointFront(const JointMap& joint, int variable, const DegreesOfFreedom& dof,
                                   const PlaneOfMotion& plane)
    : plane_(&plane), slave_(joint.slave), master_(joint.master), variable_(variable) {
  if (dof.size[variable] > 1) space_.emplace(joint, variable, dof);
  if (dof.size[variable] == 1 && dof.equation[dof.first[variable]] >= 0) scalar_ = dof.first[variable];
}

void PlanarJointFront::project(const FoldMaps& maps) {
  lever_left_ = plane_->in_plane(maps.lever_left);
  lever_right_ = plane_->in_plane(maps.lever_right);
  if (scalar_ < 0) return;
  left_ = plane_->projected(maps.left.col(0));
  right_ = plane_->projected(maps.right.col(0));
}

bool PlanarJointFront::eliminate(const FoldMaps& maps, double* const* blocks) {
  project(maps);
  if (space_) return eliminate_in_space(maps, blocks);
  const Matrix3 tangent = PlanarBlock(blocks[slave_]);
  Vector3 moved = Vector3::Zero();
  if (scalar_ >= 0) {
    moved = tangent * right_;
    inverse_ = 1 / (maps.released_released(0, 0) + blocks[variable_][0] + left_.dot(moved));
    if (!std::isfinite(inverse_)) return false;
  }
  if (master_ < 0) return true;
  const Vector3& normal = plane_->normal;
  Matrix3 at_master = columns_at_master(tangent, lever_right_);
  if (scalar_ >= 0) {
    Eigen::RowVector3d row = left_.transpose() * at_master;
    row[2] += maps.released_spin.row(0).dot(normal);
    elimination_ = inverse_ * row.transpose();
    move_rows(lever_left_, moved);
    moved[2] += normal.dot(maps.moment_released.col(0));
    coupling_ = moved;
  }
  move_rows(lever_left_, at_master);
  if (scalar_ >= 0) at_master -= coupling_ * elimination_.transpose();
  at_master(2, 2) += normal.dot(maps.moment_spin * normal);
  PlanarBlock(blocks[master_]) += at_master;
  return true;
}

bool PlanarJointFront::eliminate_in_space(const FoldMaps& maps, double* const* blocks) {
  InSpace& space = *space_;
  const Matrix3 tangent = PlanarBlock(blocks[slave_]);
  Eigen::Matrix<double, 6, 3> axes;
  for (int c = 0; c < 3; ++c) axes.col(c) = plane_->expanded(Vector3(Vector3::Unit(c)));
  const Matrix3 along = plane_->normal * plane_->normal.transpose();
  space.slave = axes * tangent * axes.transpose();
  space.slave.topLeftCorner<3, 3>() += scale_of(tangent(0, 0), tangent(1, 1)) * along;
  space.slave.bottomRightCorner<3, 3>() += scale_of(tangent(2, 2), 0) * (Matrix3::Identity() - along);
  space.master.setZero();
  space.blocks[slave_] = space.slave.data();
  space.blocks[variable_] = blocks[variable_];
  if (master_ >= 0) space.blocks[master_] = space.master.data();
  if (!space.front.eliminate(maps, space.blocks.data())) return false;
  if (master_ >= 0) PlanarBlock(blocks[master_]) += axes.transpose() * space.master * axes;
  return true;
}

void PlanarJointFront::forward(const FoldMaps& maps, double* nodes, double* scalars) {
  const Eigen::Map<const Vector3> slave(nodes + 4 * static_cast<std::size_t>(slave_));
  double released = 0;
  if (space_) {
    double* values = space_->values.data();
    Eigen::Map<Vector6>(values + 6 * static_cast<std::size_t>(slave_)) = plane_->expanded(slave);
    if (master_ >= 0) Eigen::Map<Vector6>(values + 6 * static_cast<std::size_t>(master_)).setZero();
    space_->take(scalars);
    space_->front.forward(maps, values);
    if (master_ >= 0)
      Eigen::Map<Vector3>(nodes + 4 * static_cast<std::size_t>(master_)) +=
          plane_->projected(Eigen::Map<Vector6>(values + 6 * static_cast<std::size_t>(master_)));
    return;
  }
  if (scalar_ >= 0) scalars[scalar_] = released = inverse_ * (scalars[scalar_] + left_.dot(slave));
  if (master_ < 0) return;
  Eigen::Map<Vector3> master(nodes + 4 * static_cast<std::size_t>(master_));
  master += slave;
  master[2] += lever_left_.x() * slave[1] - lever_left_.y() * slave[0];
  if (scalar_ >= 0) master -= released * coupling_;
}

void PlanarJointFront::backward(const FoldMaps& maps, double* nodes, double* scalars) {
  Eigen::Map<Vector3> slave(nodes + 4 * static_cast<std::size_t>(slave_));
  if (space_) {
    double* values = space_->values.data();
    if (master_ >= 0)
      Eigen::Map<Vector6>(values + 6 * static_cast<std::size_t>(master_)) =
          plane_->expanded(Eigen::Map<Vector3>(nodes + 4 * static_cast<std::size_t>(master_)));
    space_->front.backward(maps, values);
    space_->give(scalars);
    slave = plane_->projected(Eigen::Map<Vector6>(values + 6 * static_cast<std::size_t>(slave_)));
    return;
  }
  Vector3 moved = Vector3::Zero();
  if (master_ >= 0) {
    moved = Eigen::Map<const Vector3>(nodes + 4 * static_cast<std::size_t>(master_));
    if (scalar_ >= 0) scalars[scalar_] -= elimination_.dot(moved);
    moved[0] -= moved[2] * lever_right_.y();
    moved[1] += moved[2] * lever_right_.x();
  }
  if (scalar_ >= 0) moved += scalars[scalar_] * right_;
  slave = moved;
}

}  // namespace flexarm
