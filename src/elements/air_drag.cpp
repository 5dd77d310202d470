#include "elements/air_drag.h"

#include <cassert>
#include <cmath>

#include "joints/coordinate_step.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {
namespace {

using so3::hat;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

std::vector<int> nodes_of(const std::vector<DragPlace>& places) {
  std::vector<int> nodes;
  nodes.reserve(places.size());
  for (const DragPlace& place : places) nodes.push_back(place.point.node);
  return nodes;
}

/// A place at an instant, or averaged over a step, in world axes.
struct PlaceAxes {
  Vector3 arm, position;
  Matrix3 axes;

  PlaceAxes(const NodePoint& point, const NodePose& node)
      : arm(node.rotation * point.arm),
        position(node.position + arm),
        axes(node.rotation * point.orientation.toRotationMatrix()) {}
  /// The derivative of the position by {displacement, spin} of the node.
  Matrix36 gradient() const {
    Matrix36 gradient;
    gradient << Matrix3::Identity(), -hat(arm);
    return gradient;
  }
};

/// Minus the drag along the axes of a place, and its derivative.
struct QuadraticDrag {
  Vector3 force = Vector3::Zero();  ///< [N]
  Matrix3 slope = Matrix3::Zero();  ///< by the velocity [N s/m]

  /// `velocity`: along the axes [m/s]
  QuadraticDrag(const Vector3& resistance, const Vector3& velocity) {
    const Vector3 felt = (resistance.array() > 0).select(velocity, 0.0);
    const double speed = felt.norm();
    if (speed == 0) return;
    const Vector3 loads = resistance.cwiseProduct(velocity);
    force = speed * loads;
    slope = loads * (felt / speed).transpose();
    slope.diagonal() += speed * resistance;
  }
};

/// The rate of a position over a step, and its derivative by the position at the end [1/s].
struct PlaceRate {
  Vector3 value;
  double slope;
};

PlaceRate rate_of(const ForceStep& step, const DragPlace& place, const PlaceAxes& begin, const PlaceAxes& end) {
  CoordinateStep change;
  change.step = step.duration;
  Vector3 velocity = Vector3::Zero();
  if (step.at_end) {
    change.gamma = step.gamma;
    velocity = begin.gradient() * step.velocities[place.point.node];
  }
  PlaceRate rate{Vector3::Zero(), rate_slope(change)};
  for (int i = 0; i < 3; ++i) {
    change.increment = end.position[i] - begin.position[i];
    change.begin_rate = velocity[i];
    rate.value[i] = rate_of(change);
  }
  return rate;
}

}  // namespace

AirDrag::AirDrag(std::string link, std::vector<DragPlace> places)
    : ForceElement(std::move(link), nodes_of(places)), places_(std::move(places)) {
  for (int i = 0; i < static_cast<int>(places_.size()); ++i) pieces_.pairs.push_back({i, -1});
}

void AirDrag::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  action.residual.setZero();
  if (action.tangent.size() != 0) action.tangent.setZero();
  if (action.pieces.blocks.size() != 0) action.pieces.set_zero();
  if (step.duration == 0) return;
  const double weight = step.at_end ? 1 : 0.5;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const DragPlace& place = places_[k];
    const PlaceAxes begin(place.point, step.begin[place.point.node]), end(place.point, step.end[place.point.node]);
    const Matrix3 axes = (1 - weight) * begin.axes + weight * end.axes;
    const Vector3 arm = (1 - weight) * begin.arm + weight * end.arm;
    const PlaceRate rate = rate_of(step, place, begin, end);
    const QuadraticDrag drag(place.resistance, axes.transpose() * rate.value);
    const Vector3 force = axes * drag.force;
    const auto at = static_cast<Eigen::Index>(6 * k);
    action.residual.segment<6>(at) << force, arm.cross(force);
    action.dissipated += force.dot(end.position - begin.position);
    if (!action.wants_tangent()) continue;

    Matrix36 by_velocity = rate.slope * axes.transpose() * end.gradient();  // velocity along the axes
    for (int i = 0; i < 3; ++i) by_velocity.row(i).tail<3>() += weight * end.axes.col(i).cross(rate.value).transpose();
    Matrix36 d_force = axes * drag.slope * by_velocity;
    d_force.rightCols<3>() -= weight * hat(end.axes * drag.force);
    Matrix6 tangent;
    tangent << d_force, hat(arm) * d_force;
    tangent.bottomRightCorner<3, 3>() += weight * hat(force) * hat(end.arm);
    if (action.tangent.size() != 0) action.tangent.block<6, 6>(at, at) = tangent;
    if (action.pieces.blocks.size() != 0) action.pieces.blocks.block<6, 6>(0, 2 * at) = tangent;
  }
}

ForceMeasures AirDrag::measures(const State& state, const double*, const int*) const {
  const auto count = static_cast<Eigen::Index>(places_.size());
  ForceMeasures out{Eigen::MatrixXd::Zero(3 * count, 6 * count), Eigen::MatrixXd::Zero(3 * count, 3 * count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const NodePoint& point = places_[k].point;
    const PlaceAxes here(point, node_pose(state.nodes[point.node]));
    out.rows.block<3, 6>(3 * k, 6 * k) = here.axes.transpose() * here.gradient();
  }
  return out;
}

DamperTensions AirDrag::dampers(const State&, const double*, const Eigen::VectorXd& rates) const {
  assert(rates.size() == static_cast<Eigen::Index>(3 * places_.size()));
  DamperTensions out{Eigen::VectorXd(rates.size()), Eigen::MatrixXd::Zero(rates.size(), rates.size())};
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    const QuadraticDrag drag(places_[k].resistance, rates.segment<3>(at));
    out.tension.segment<3>(at) = drag.force;
    out.slope.block<3, 3>(at, at) = drag.slope;
  }
  return out;
}

void AirDrag::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  Vector3 sum = Vector3::Zero();
  for (const DragPlace& place : places_) {
    const PlaceAxes here(place.point, node_pose(motion.state.nodes[place.point.node]));
    const Vector3 velocity = here.axes.transpose() * here.gradient() * motion.velocities[place.point.node];
    sum -= here.axes * QuadraticDrag(place.resistance, velocity).force;
  }
  values.insert(values.end(), sum.data(), sum.data() + 3);
}

}  // namespace flexarm
