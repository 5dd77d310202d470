#include "elements/line_element.h"

#include <cassert>
#include <limits>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Returns a length that is safe to divide by. An element of length zero has no direction, and then exerts no force.
double divisor(double length) {
  return std::max(length, std::numeric_limits<double>::min());
}

std::vector<int> nodes_of(const NodePoint& child, const NodePoint& parent) {
  assert(child.node >= 0 && child.node != parent.node && "between two bodies, of which one at least moves");
  std::vector<int> nodes;
  for (const NodePoint* point : {&child, &parent})
    if (point->node >= 0) nodes.push_back(point->node);
  return nodes;
}

NodePose pose_of(const std::vector<NodePose>& nodes, int node) {
  return node < 0 ? NodePose() : nodes[node];
}

NodePose pose_of(const State& state, int node) {
  return node < 0 ? NodePose() : node_pose(state.nodes[node]);
}

}  // namespace

/// Arms and distance of the two points in world axes, at one instant or averaged over two.
struct LineElement::Ends {
  Vector3 child_arm, parent_arm;
  Vector3 distance;  // from the parent's to the child's point

  double length() const { return distance.norm(); }
  static Ends mean(const Ends& a, const Ends& b, double weight) {
    const auto mix = [&](const Vector3& x, const Vector3& y) { return Vector3((1 - weight) * x + weight * y); };
    return {mix(a.child_arm, b.child_arm), mix(a.parent_arm, b.parent_arm), mix(a.distance, b.distance)};
  }
};

LineElement::LineElement(std::string name, const NodePoint& from, const NodePoint& to)
    : ForceElement(std::move(name), to.node >= 0 ? nodes_of(to, from) : nodes_of(from, to)),
      child_(to.node >= 0 ? to : from),
      parent_(to.node >= 0 ? from : to) {}

template <class Nodes>
LineElement::Ends LineElement::ends(const Nodes& nodes) const {
  const NodePose child = pose_of(nodes, child_.node), parent = pose_of(nodes, parent_.node);
  Ends out;
  out.child_arm = child.rotation * child_.arm;
  out.parent_arm = parent.rotation * parent_.arm;
  out.distance = child.position + out.child_arm - parent.position - out.parent_arm;
  return out;
}

Vector12 LineElement::gradient(const Ends& v) const {
  const Vector3 along = v.distance / divisor(v.length());
  Vector12 gradient;
  gradient << along, v.child_arm.cross(along), -along, -v.parent_arm.cross(along);
  return gradient;
}

void LineElement::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  assert(action.residual.size() == 6 * static_cast<Eigen::Index>(reach().size()));
  assert(action.tangent.size() == 0 || action.tangent.rows() == action.residual.size());
  assert(!step.at_end || step.duration == 0 || step.velocities.size() == step.end.size());
  const Ends begin = ends(step.begin), end = ends(step.end);
  CoordinateStep change;
  change.begin = begin.length();
  change.end = end.length();
  change.increment = change.end - change.begin;
  change.step = step.duration;
  change.at_end = step.at_end;
  if (step.at_end && step.duration != 0) {
    Vector12 velocity = Vector12::Zero();
    velocity.head<6>() = step.velocities[child_.node];
    if (parent_.node >= 0) velocity.tail<6>() = step.velocities[parent_.node];
    change.gamma = step.gamma;
    change.begin_rate = gradient(begin).dot(velocity);
  }
  const LineTension tension = this->tension(change);
  action.dissipated = tension.dissipated;
  action.work = tension.work;

  const double weight = change.at_end ? 1 : 0.5;
  const Ends v = Ends::mean(begin, end, weight);
  const double length = divisor((1 - weight) * change.begin + weight * change.end);
  const double density = tension.value / length;
  const Vector3 force = density * v.distance;
  Vector12 residual;
  residual << force, v.child_arm.cross(force), -force, -v.parent_arm.cross(force);
  action.residual = residual.head(action.residual.size());
  if (action.tangent.size() == 0) return;

  // Derivative of the distance at the end with respect to {displacement, spin} of child and parent.
  Eigen::Matrix<double, 3, 12> distance;
  distance << Matrix3::Identity(), -hat(end.child_arm), -Matrix3::Identity(), hat(end.parent_arm);
  const double density_slope = (tension.slope - weight * density) / length;
  const Vector3 along = density_slope / divisor(change.end) * end.distance;
  const Eigen::Matrix<double, 3, 12> d_force =
      weight * density * distance + v.distance * (along.transpose() * distance);
  Matrix12 tangent;
  tangent << d_force, hat(v.child_arm) * d_force, -d_force, -hat(v.parent_arm) * d_force;
  // The arms rotate with their nodes.
  tangent.block<3, 3>(3, 3) += weight * hat(force) * hat(end.child_arm);
  tangent.block<3, 3>(9, 9) -= weight * hat(force) * hat(end.parent_arm);
  action.tangent = tangent.topLeftCorner(action.tangent.rows(), action.tangent.cols());
}

double LineElement::energy(const State& state, const double*) const {
  return energy(ends(state).length());
}

ForceMeasures LineElement::measures(const State& state, const double*, const int*) const {
  const Ends here = ends(state);
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(reach().size());
  return {gradient(here).head(size).transpose(), Eigen::MatrixXd::Constant(1, 1, elastic(here.length()).slope)};
}

DamperTensions LineElement::dampers(const State&, const double*, const Eigen::VectorXd& rates) const {
  assert(rates.size() == 1);
  const LineTension damping = damper(rates[0]);
  return {Eigen::VectorXd::Constant(1, damping.value), Eigen::MatrixXd::Constant(1, 1, damping.slope)};
}

std::vector<ForceOutput> LineElement::outputs() const {
  return {{"length", "m"}, {"tension", "N"}};
}

void LineElement::put_line(const ForceMotion& motion, std::vector<Vector3>& points) const {
  for (const NodePoint* point : {&parent_, &child_}) {
    const NodePose node = pose_of(motion.state, point->node);
    points.push_back(node.position + node.rotation * point->arm);
  }
}

void LineElement::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  assert(motion.velocities.size() == motion.state.nodes.size());
  const Ends here = ends(motion.state);
  const Vector12 direction = gradient(here);
  double rate = direction.head<6>().dot(motion.velocities[child_.node]);
  if (parent_.node >= 0) rate += direction.tail<6>().dot(motion.velocities[parent_.node]);
  values.push_back(here.length());
  values.push_back(elastic(here.length()).value + damper(rate).value);
}

}  // namespace flexarm
