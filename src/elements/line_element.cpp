#include "elements/line_element.h"

#include <cassert>

#include "elements/line_ends.h"

namespace flexarm {

LineElement::LineElement(std::string name, const NodePoint& from, const NodePoint& to)
    : ForceElement(std::move(name), nodes_of(to, from)),
      child_(to.node >= 0 ? to : from),
      parent_(to.node >= 0 ? from : to) {}

void LineElement::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  assert(action.residual.size() == 6 * static_cast<Eigen::Index>(reach().size()));
  assert(action.tangent.size() == 0 || action.tangent.rows() == action.residual.size());
  assert(!step.at_end || step.duration == 0 || step.velocities.size() == step.end.size());
  const LineEnds begin(child_, parent_, step.begin), end(child_, parent_, step.end);
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
    change.begin_rate = begin.gradient().dot(velocity);
  }
  const LineTension tension = this->tension(change);
  action.dissipated = tension.dissipated;
  action.work = tension.work;

  Vector12 residual;
  Matrix12 tangent;
  const bool with_tangent = action.tangent.size() != 0;
  LineStep(begin, end, change.at_end).act(tension.value, tension.slope, residual, with_tangent ? &tangent : nullptr);
  action.residual = residual.head(action.residual.size());
  if (with_tangent) action.tangent = tangent.topLeftCorner(action.tangent.rows(), action.tangent.cols());
}

double LineElement::energy(const State& state, const double*) const {
  return energy(LineEnds(child_, parent_, state).length());
}

ForceMeasures LineElement::measures(const State& state, const double*, const int*) const {
  const LineEnds here(child_, parent_, state);
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(reach().size());
  return {here.gradient().head(size).transpose(), Eigen::MatrixXd::Constant(1, 1, elastic(here.length()).slope)};
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
    const NodePose node = point->node < 0 ? NodePose() : node_pose(motion.state.nodes[point->node]);
    points.push_back(node.position + node.rotation * point->arm);
  }
}

void LineElement::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  assert(motion.velocities.size() == motion.state.nodes.size());
  const LineEnds here(child_, parent_, motion.state);
  const Vector12 direction = here.gradient();
  double rate = direction.head<6>().dot(motion.velocities[child_.node]);
  if (parent_.node >= 0) rate += direction.tail<6>().dot(motion.velocities[parent_.node]);
  values.push_back(here.length());
  values.push_back(elastic(here.length()).value + damper(rate).value);
}

}  // namespace flexarm
