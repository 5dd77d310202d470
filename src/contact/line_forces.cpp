#include "contact/line_forces.h"

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

}  // namespace

void LineActing::add_to(ForceAction& action) const {
  const Vector3 force = local.wrench.head<3>(), couple = local.wrench.tail<3>();
  const Vector3 on_side = arm.cross(force) + couple, on_line = middle.cross(force) + couple;
  for (int i = 0; i < count; ++i) {
    const Node& node = nodes[i];
    action.residual.segment<3>(6 * node.at) -= (node.side - node.line) * force;
    action.residual.segment<3>(6 * node.at + 3) -= node.side * on_side - node.line * on_line;
  }
  if (action.tangent.size() > 0) add_tangent_to(action);
}

void LineActing::add_tangent_to(ForceAction& action) const {
  const LineAction::Columns by_distance = local.by_distance * normal().transpose();
  const Matrix3 arm_hat = hat(arm), end_hat = hat(end_arm), middle_hat = hat(middle);
  const Matrix3 pressed = weight * hat(Vector3(local.wrench.head<3>()));
  for (int j = 0; j < count; ++j) {
    const Node& column = nodes[j];
    const double way = column.side - column.line;
    Matrix6 slope;  // derivative of the wrench
    slope.leftCols<3>() = way * local.by_end + (column.side - column.nearest) * by_distance;
    slope.rightCols<3>() = (column.side * local.by_turn + column.line * local.by_line_turn) * column.by_spin;
    // Derivative of the vector from the line to the station.
    Eigen::Matrix<double, 3, 6> moved = Eigen::Matrix<double, 3, 6>::Zero();
    moved.leftCols<3>().diagonal().setConstant(way);
    if (j == body) {
      slope.rightCols<3>() -= (local.by_end + by_distance) * end_hat;
      moved.rightCols<3>() = -end_hat;
    }
    Eigen::Matrix<double, 3, 6> on_side = arm_hat * slope.topRows<3>() + slope.bottomRows<3>();
    if (j == body) on_side.rightCols<3>() += pressed * end_hat;
    const Eigen::Matrix<double, 3, 6> on_line =
        middle_hat * slope.topRows<3>() + slope.bottomRows<3>() - pressed * moved;
    for (int i = 0; i < count; ++i) {
      const Node& row = nodes[i];
      auto block = action.tangent.block<6, 6>(6 * row.at, 6 * column.at);
      block.topRows<3>() -= (row.side - row.line) * slope.topRows<3>();
      block.bottomRows<3>() -= row.side * on_side - row.line * on_line;
    }
  }
}

void LineActing::add_push_to(ForceAction& action) const {
  const ContactPush& push = local.push;
  const Vector3 normal = this->normal(), force = push.value * normal;
  const double distance = nearest.norm();
  for (int i = 0; i < count; ++i) {
    const Node& node = nodes[i];
    action.residual.segment<3>(6 * node.at) -= (node.side - node.nearest) * force;
    if (i == body) action.residual.segment<3>(6 * node.at + 3) -= end_arm.cross(force);
  }
  if (action.tangent.size() == 0) return;
  using Row = Eigen::Matrix<double, 1, 6>;
  const Matrix3 across = push.value / distance * (Matrix3::Identity() - normal * normal.transpose());
  const Matrix3 arm_hat = hat(end_arm), stiffness = across - push.slope * normal * normal.transpose();
  for (int j = 0; j < count; ++j) {
    const Node& column = nodes[j];
    const double way = column.side - column.nearest;
    Eigen::Matrix<double, 3, 6> slope = Eigen::Matrix<double, 3, 6>::Zero();
    Row place = Row::Zero();  // derivative of xi
    slope.leftCols<3>() = way * stiffness;
    place.head<3>() = way * tangent.transpose() + column.slope * nearest.transpose();
    if (j == body) {
      slope.rightCols<3>() = -stiffness * arm_hat;
      place.tail<3>() = -tangent.transpose() * arm_hat;
    }
    place *= rise > 0 ? 1 / rise : 0.0;
    slope -= across * tangent * place;
    for (int i = 0; i < count; ++i) {
      const Node& row = nodes[i];
      auto block = action.tangent.block<6, 6>(6 * row.at, 6 * column.at);
      block.topRows<3>() -= (row.side - row.nearest) * slope - row.slope * force * place;
      if (i != body) continue;
      block.bottomRows<3>() -= arm_hat * slope;
      if (j == body) block.bottomRightCorner<3, 3>() -= hat(force) * arm_hat;
    }
  }
}

}  // namespace flexarm
