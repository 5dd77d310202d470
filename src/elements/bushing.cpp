#include "elements/bushing.h"

#include <cassert>

#include <fmt/format.h>
#include <unsupported/Eigen/AutoDiff>

#include "elements/line_ends.h"
#include "joints/coordinate_step.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {
namespace {

/// A number with its derivatives by {displacement, spin} of the nodes of `from` and `to`.
using Dual = Eigen::AutoDiffScalar<Vector12>;
using so3::cross;

template <class S>
using Vector3Of = Eigen::Matrix<S, 3, 1>;
template <class S>
using Vector6Of = Eigen::Matrix<S, 6, 1>;

/// One of the two frames at an instant, or averaged over two: numbers are of the type S. World axes.
template <class S>
struct Frame {
  Vector3Of<S> arm, position;  ///< from the node; of the point
  Vector3Of<S> axes[3];
};

Frame<double> frame_at(const NodePoint& point, const NodePose& node) {
  const Matrix3 axes = node.rotation * point.orientation.toRotationMatrix();
  const Vector3 arm = node.rotation * point.arm;
  return {arm, node.position + arm, {axes.col(0), axes.col(1), axes.col(2)}};
}

Frame<double> frame_at(const NodePoint& point, const std::vector<NodePose>& nodes) {
  return frame_at(point, point.node < 0 ? NodePose() : nodes[point.node]);
}

Frame<double> frame_at(const NodePoint& point, const State& state) {
  return frame_at(point, point.node < 0 ? NodePose() : node_pose(state.nodes[point.node]));
}

/// The frame as a function of its node's motion, whose derivatives begin at `column`; column < 0: it does not move.
Frame<Dual> moving(const Frame<double>& frame, int column) {
  Frame<Dual> out;
  const auto seed = [&](const Vector3& turned, double by_way, const Vector3& value, Vector3Of<Dual>& result) {
    const Matrix3 turn = -so3::hat(turned);
    for (int i = 0; i < 3; ++i) {
      result[i] = Dual(value[i], Vector12::Zero());
      if (column < 0) continue;
      result[i].derivatives().segment<3>(column + 3) = turn.row(i).transpose();
      result[i].derivatives()[column + i] = by_way;
    }
  };
  seed(frame.arm, 0, frame.arm, out.arm);
  seed(frame.arm, 1, frame.position, out.position);
  for (int k = 0; k < 3; ++k) seed(frame.axes[k], 0, frame.axes[k], out.axes[k]);
  return out;
}

template <class S>
Vector3Of<S> between(const Vector3& a, const Vector3Of<S>& b, double weight) {
  Vector3Of<S> out;
  for (int i = 0; i < 3; ++i) out[i] = (1 - weight) * a[i] + weight * b[i];
  return out;
}

template <class S>
Frame<S> between(const Frame<double>& a, const Frame<S>& b, double weight) {
  Frame<S> out{between(a.arm, b.arm, weight), between(a.position, b.position, weight), {}};
  for (int k = 0; k < 3; ++k) out.axes[k] = between(a.axes[k], b.axes[k], weight);
  return out;
}

template <class S>
S dot(const Vector3Of<S>& a, const Vector3Of<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The measures at an instant, and s = (1 + trace Q)/4 of the relative rotation Q, whose axial vector is s p.
template <class S>
struct Measures {
  Vector6Of<S> e;
  S s;
};

template <class S>
Measures<S> measures_of(const Frame<S>& from, const Frame<S>& to, const Vector3& rest) {
  Measures<S> out;
  const Vector3Of<S> way = to.position - from.position;
  const auto q = [&](int i, int j) { return dot<S>(from.axes[i], to.axes[j]); };
  out.s = S(1.0);
  for (int i = 0; i < 3; ++i) out.s += q(i, i);
  out.s *= 0.25;
  for (int k = 0; k < 3; ++k) {
    out.e[k] = dot<S>(from.axes[k], way) - rest[k];
    const S axial = q((k + 2) % 3, (k + 1) % 3) - q((k + 1) % 3, (k + 2) % 3);
    out.e[3 + k] = 0.5 * axial / out.s;
  }
  return out;
}

/// Minus the forces {force, moment} of a tension on the nodes of `from` and `to`. `from`, `to`, `p`, `s`: at the
/// instant at which the forces act, or means over a step, whose work is then exactly tension . (change of e).
template <class S>
Eigen::Matrix<S, 12, 1> residual_of(const Frame<S>& from, const Frame<S>& to, const Vector3Of<S>& p, const S& s,
                                    const Vector6Of<S>& tension) {
  const Vector3Of<S> way = to.position - from.position;
  Vector3Of<S> force, moment, on_axial;
  for (int i = 0; i < 3; ++i) {
    force[i] = from.axes[0][i] * tension[0] + from.axes[1][i] * tension[1] + from.axes[2][i] * tension[2];
    on_axial[i] = tension[3 + i] / s;
    moment[i] = S(0.0);
  }
  // dp = (dw - p ds)/s with w the axial vector of Q, and dQ_ij = (spin of `to` - spin of `from`) . (to_j x from_i).
  const S on_trace = -0.25 * dot<S>(on_axial, p);
  const auto add = [&](const S& factor, int i, int j) {
    const Vector3Of<S> by_turn = cross(to.axes[j], from.axes[i]);
    for (int k = 0; k < 3; ++k) moment[k] += factor * by_turn[k];
  };
  for (int k = 0; k < 3; ++k) {
    add(on_trace, k, k);
    add(0.5 * on_axial[k], (k + 2) % 3, (k + 1) % 3);
    add(-0.5 * on_axial[k], (k + 1) % 3, (k + 2) % 3);
  }
  const Vector3Of<S> of_from = cross(from.arm, force), of_to = cross(to.arm, force), of_way = cross(way, force);
  Eigen::Matrix<S, 12, 1> out;
  for (int i = 0; i < 3; ++i) {
    out[i] = -force[i];
    out[3 + i] = -of_from[i] - of_way[i] - moment[i];
    out[6 + i] = force[i];
    out[9 + i] = of_to[i] + moment[i];
  }
  return out;
}

/// The measures at a state, and their derivatives.
Measures<Dual> moving_measures(const NodePoint& from, const NodePoint& to, const Vector3& rest,
                               const Frame<double>& at_from, const Frame<double>& at_to) {
  return measures_of(moving(at_from, from.node < 0 ? -1 : 0), moving(at_to, to.node < 0 ? -1 : 6), rest);
}

/// {v, w} of both nodes.
Vector12 velocities_of(const NodePoint& from, const NodePoint& to, const std::vector<Vector6>& velocities) {
  Vector12 out = Vector12::Zero();
  if (from.node >= 0) out.head<6>() = velocities[from.node];
  if (to.node >= 0) out.tail<6>() = velocities[to.node];
  return out;
}

Vector6 rates_of(const Measures<Dual>& at, const Vector12& velocity) {
  Vector6 out;
  for (int i = 0; i < 6; ++i) out[i] = at.e[i].derivatives().dot(velocity);
  return out;
}

template <class S>
Vector6Of<S> product(const Matrix6& matrix, const Vector6Of<S>& vector) {
  Vector6Of<S> out;
  for (int i = 0; i < 6; ++i) {
    out[i] = matrix(i, 0) * vector[0];
    for (int j = 1; j < 6; ++j) out[i] += matrix(i, j) * vector[j];
  }
  return out;
}

/// The step of a bushing: begins at `begin`, ends at `end`.
template <class S>
struct BushingStep {
  Eigen::Matrix<S, 12, 1> residual;
  S dissipated;

  BushingStep(const Bushing::Law& law, const ForceStep& step, const Frame<double> begin[2], const Frame<S> end[2],
              const Vector6& begin_rates) {
    const double weight = step.at_end ? 1 : 0.5;
    const Measures<double> before = measures_of(begin[0], begin[1], law.rest);
    const Measures<S> after = measures_of(end[0], end[1], law.rest);
    Vector6Of<S> e, rates, change;
    for (int i = 0; i < 6; ++i) {
      e[i] = (1 - weight) * before.e[i] + weight * after.e[i];
      change[i] = after.e[i] - before.e[i];
      if (step.duration == 0) continue;
      rates[i] = (change[i] / step.duration - (1 - step.gamma) * begin_rates[i]) / step.gamma;
    }
    Vector6Of<S> tension = product<S>(law.stiffness, e);
    dissipated = S(0.0);
    if (step.duration != 0) {
      const Vector6Of<S> viscous = product<S>(law.damping, rates);
      for (int i = 0; i < 6; ++i) {
        tension[i] += viscous[i];
        dissipated += viscous[i] * change[i];
      }
    }
    const S s = (1 - weight) * before.s + weight * after.s;
    residual = residual_of<S>(between(begin[0], end[0], weight), between(begin[1], end[1], weight),
                              Vector3Of<S>(e.template tail<3>()), s, tension);
  }
};

/// The rows and columns of nodes that move: both, or the one of them.
Eigen::Index first_row(const NodePoint& from) {
  return from.node < 0 ? 6 : 0;
}

}  // namespace

Bushing::Bushing(std::string name, const NodePoint& from, const NodePoint& to, const Law& law)
    : ForceElement(std::move(name), nodes_of(from, to)), from_(from), to_(to), law_(law) {}

std::string Bushing::description() const {
  const auto diagonal = [](const Matrix6& m) {
    return fmt::format("{:.6g} {:.6g} {:.6g}, {:.6g} {:.6g} {:.6g}", m(0, 0), m(1, 1), m(2, 2), m(3, 3), m(4, 4),
                       m(5, 5));
  };
  return fmt::format("{} (N/m, N m/rad), damping {}", diagonal(law_.stiffness), diagonal(law_.damping));
}

void Bushing::evaluate(const ForceStep& step, const int*, ForceAction& action) const {
  const Frame<double> begin[2] = {frame_at(from_, step.begin), frame_at(to_, step.begin)};
  const Frame<double> end[2] = {frame_at(from_, step.end), frame_at(to_, step.end)};
  Vector6 rates = Vector6::Zero();
  if (step.at_end && step.duration != 0)
    rates = rates_of(moving_measures(from_, to_, law_.rest, begin[0], begin[1]),
                     velocities_of(from_, to_, step.velocities));
  const Eigen::Index first = first_row(from_), size = action.residual.size();
  assert(size == 6 * static_cast<Eigen::Index>(reach().size()));
  if (action.tangent.size() == 0) {
    const BushingStep<double> solved(law_, step, begin, end, rates);
    action.residual = solved.residual.segment(first, size);
    action.dissipated = solved.dissipated;
    return;
  }
  const Frame<Dual> moved[2] = {moving(end[0], from_.node < 0 ? -1 : 0), moving(end[1], to_.node < 0 ? -1 : 6)};
  const BushingStep<Dual> solved(law_, step, begin, moved, rates);
  action.dissipated = solved.dissipated.value();
  for (Eigen::Index i = 0; i < size; ++i) {
    action.residual[i] = solved.residual[first + i].value();
    action.tangent.row(i) = solved.residual[first + i].derivatives().segment(first, size).transpose();
  }
}

double Bushing::energy(const State& state, const double*) const {
  const Vector6 e = measures_of(frame_at(from_, state), frame_at(to_, state), law_.rest).e;
  return 0.5 * e.dot(law_.stiffness * e);
}

ForceMeasures Bushing::measures(const State& state, const double*, const int*) const {
  const Measures<Dual> here = moving_measures(from_, to_, law_.rest, frame_at(from_, state), frame_at(to_, state));
  const Eigen::Index first = first_row(from_), size = 6 * static_cast<Eigen::Index>(reach().size());
  ForceMeasures out{Eigen::MatrixXd(6, size), law_.stiffness};
  for (int i = 0; i < 6; ++i) out.rows.row(i) = here.e[i].derivatives().segment(first, size).transpose();
  return out;
}

DamperTensions Bushing::dampers(const State&, const double*, const Eigen::VectorXd& rates) const {
  assert(rates.size() == 6);
  return {law_.damping * rates, law_.damping};
}

std::vector<ForceOutput> Bushing::outputs() const {
  return {{"x", "m"},  {"y", "m"},  {"z", "m"},  {"rx", "rad"}, {"ry", "rad"}, {"rz", "rad"},
          {"fx", "N"}, {"fy", "N"}, {"fz", "N"}, {"mx", "N m"}, {"my", "N m"}, {"mz", "N m"}};
}

void Bushing::put_out(const ForceMotion& motion, std::vector<double>& values) const {
  const Measures<Dual> here =
      moving_measures(from_, to_, law_.rest, frame_at(from_, motion.state), frame_at(to_, motion.state));
  Vector6 e;
  for (int i = 0; i < 6; ++i) e[i] = here.e[i].value();
  const Vector6 forces =
      -law_.stiffness * e - law_.damping * rates_of(here, velocities_of(from_, to_, motion.velocities));
  values.insert(values.end(), e.data(), e.data() + 6);
  values.insert(values.end(), forces.data(), forces.data() + 6);
}

void Bushing::put_line(const ForceMotion& motion, std::vector<Vector3>& points) const {
  for (const NodePoint* point : {&from_, &to_}) points.push_back(frame_at(*point, motion.state).position);
}

}  // namespace flexarm
