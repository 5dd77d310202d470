#include "trajectory_follower.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace flexarm::node {
namespace {

bool are_finite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

std::string fault_of_point(const JointTrajectory::Point& point, std::size_t joints) {
  if (point.positions.size() != joints)
    return "has " + std::to_string(point.positions.size()) + " positions for " + std::to_string(joints) + " joints";
  if (!point.velocities.empty() && point.velocities.size() != joints)
    return "has " + std::to_string(point.velocities.size()) + " velocities for " + std::to_string(joints) + " joints";
  if (!point.accelerations.empty() && point.accelerations.size() != joints)
    return "has " + std::to_string(point.accelerations.size()) + " accelerations for " + std::to_string(joints) +
           " joints";
  if (!point.accelerations.empty() && point.velocities.empty()) return "has accelerations, but no velocities";
  for (const auto* numbers : {&point.positions, &point.velocities, &point.accelerations})
    if (!are_finite(*numbers)) return "has a number that is not finite";
  return {};
}

JointSpline::Order order_of(const JointTrajectory::Point& point) {
  return !point.accelerations.empty() ? JointSpline::Order::Acceleration
         : !point.velocities.empty()  ? JointSpline::Order::Velocity
                                      : JointSpline::Order::Position;
}

JointPoint joint_point(const JointTrajectory::Point& point, std::size_t k) {
  return {point.positions[k], point.velocities.empty() ? 0 : point.velocities[k],
          point.accelerations.empty() ? 0 : point.accelerations[k]};
}

}  // namespace

// ---------------------------------------------------------------- one joint

JointPoint JointSpline::Piece::at(double t) const {
  const std::array<double, 6>& c = coefficients;
  return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
          c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5]))),
          2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]))};
}

JointPoint JointSpline::at(double time) const {
  const auto after = std::find_if(pieces_.rbegin(), pieces_.rend(),
                                  [&](const Piece& piece) { return piece.begin <= time + kTimeRoundOff; });
  if (after == pieces_.rend()) return {pieces_.empty() ? rest_ : pieces_.front().coefficients[0]};
  const double since = std::max(time - after->begin, 0.0);
  if (since > after->duration + kTimeRoundOff) return {after->at(after->duration).position};
  return after->at(std::min(since, after->duration));
}

JointPoint JointSpline::cut(double end) {
  const JointPoint there = at(end);
  const auto is_later = [&](const Piece& piece) { return piece.begin >= end; };
  pieces_.erase(std::remove_if(pieces_.begin(), pieces_.end(), is_later), pieces_.end());
  if (pieces_.empty()) rest_ = there.position;
  return there;
}

void JointSpline::forget_before(double time) {
  const auto present = std::find_if(pieces_.rbegin(), pieces_.rend(),
                                    [&](const Piece& piece) { return piece.begin <= time + kTimeRoundOff; });
  if (present != pieces_.rend()) pieces_.erase(pieces_.begin(), std::prev(present.base()));
}

void JointSpline::add(double begin, const JointPoint& from, double end, const JointPoint& to, Order order) {
  const double T = end - begin, way = to.position - from.position;
  const double v0 = from.velocity, v1 = to.velocity, a0 = from.acceleration, a1 = to.acceleration;
  Piece piece{begin, T, {from.position}};
  std::array<double, 6>& c = piece.coefficients;
  if (order == Order::Position) {
    c[1] = way / T;
  } else if (order == Order::Velocity) {
    c[1] = v0;
    c[2] = (3 * way / T - 2 * v0 - v1) / T;
    c[3] = (-2 * way / T + v0 + v1) / (T * T);
  } else {
    c[1] = v0;
    c[2] = a0 / 2;
    c[3] = (20 * way / T - 12 * v0 - 8 * v1 - (3 * a0 - a1) * T) / (2 * T * T);
    c[4] = (-30 * way / T + 16 * v0 + 14 * v1 + (3 * a0 - 2 * a1) * T) / (2 * T * T * T);
    c[5] = (12 * way / T - 6 * v0 - 6 * v1 - (a0 - a1) * T) / (2 * T * T * T * T);
  }
  pieces_.push_back(piece);
}

void JointSpline::add_stop(double begin, const JointPoint& from, double duration) {
  if (duration <= 0)
    pieces_.push_back({begin, 0, {from.position}});
  else
    add(begin, from, begin + duration, {from.position + 0.5 * duration * from.velocity}, Order::Velocity);
}

// ---------------------------------------------------------------- all joints

std::string TrajectoryFollower::find_fault(const JointTrajectory& trajectory) const {
  if (trajectory.joints.empty()) return "it names no joint";
  if (std::set<std::size_t>(trajectory.joints.begin(), trajectory.joints.end()).size() != trajectory.joints.size())
    return "it names a joint twice";
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const JointTrajectory::Point& point = trajectory.points[i];
    const std::string name = "point " + std::to_string(i + 1);
    if (const std::string fault = fault_of_point(point, trajectory.joints.size()); !fault.empty())
      return name + " " + fault;
    if (!(point.time >= 0)) return "the time of " + name + " is not a number >= 0";
    if (i > 0 && !(point.time > trajectory.points[i - 1].time)) return name + " is not later than the one before";
  }
  return {};
}

bool TrajectoryFollower::is_over(const JointTrajectory& trajectory, double now) {
  return trajectory.points.empty() || trajectory.start + trajectory.points.back().time <= now;
}

void TrajectoryFollower::follow(const JointTrajectory& trajectory, double now, const std::vector<double>& set_points) {
  using Order = JointSpline::Order;
  const double begin = std::max(trajectory.start, now);
  for (std::size_t k = 0; k < trajectory.joints.size(); ++k) {
    Joint& joint = joints_[trajectory.joints[k]];
    if (!joint.follows) joint.way = JointSpline(set_points[k]);
    joint.follows = true;
    double time = begin;
    JointPoint from = joint.way.cut(begin);
    Order order_before = Order::Acceleration;  // position, velocity and acceleration at the beginning are known
    for (const JointTrajectory::Point& point : trajectory.points) {
      const double arrival = trajectory.start + point.time;
      if (arrival <= begin) continue;
      const JointPoint to = joint_point(point, k);
      joint.way.add(time, from, arrival, to, std::min(order_before, order_of(point)));
      time = arrival;
      from = to;
      order_before = order_of(point);
    }
  }
}

void TrajectoryFollower::stop(std::size_t index, double now, double duration) {
  JointSpline& way = joints_[index].way;
  const JointPoint from = way.cut(now);
  way.add_stop(now, from, duration);
}

void TrajectoryFollower::release_arrived(double time) {
  for (Joint& joint : joints_)
    if (joint.follows && !joint.way.is_moving(time + kTimeRoundOff)) joint.follows = false;
}

void TrajectoryFollower::forget_before(double time) {
  for (Joint& joint : joints_) joint.way.forget_before(time);
}

void TrajectoryFollower::renumber(const Renumbering::Places& joints, std::size_t count) {
  std::vector<Joint> before = std::exchange(joints_, std::vector<Joint>(count));
  for (std::size_t i = 0; i < before.size(); ++i)
    if (joints[i]) joints_[*joints[i]] = std::move(before[i]);
}

}  // namespace flexarm::node
