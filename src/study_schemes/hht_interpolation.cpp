#include "study_schemes/hht_interpolation.h"

#include <algorithm>
#include <cassert>

#include "math/so3.h"

namespace flexarm {

HhtInterpolation::HhtInterpolation(const StepConfiguration& configuration, const std::vector<Vector3>& total_rotations)
    : configuration_(configuration),
      total_rotations_(total_rotations),
      interpolated_(configuration.end()),
      interpolated_spins_(interpolated_.size(), Matrix3::Identity()),
      end_forces_(interpolated_.size(), Vector6::Zero()),
      end_reactions_(interpolated_.size(), Vector6::Zero()) {}

void HhtInterpolation::begin_evaluation() {
  std::fill(end_forces_.begin(), end_forces_.end(), Vector6::Zero());
  const double alpha = configuration_.scheme().alpha;
  for (std::size_t i = 0; i < interpolated_.size(); ++i) {
    const NodePose &begin = configuration_.begin()[i], &end = configuration_.end()[i];
    interpolated_[i] = end;
    if (!of_kinematics()) continue;
    const Vector3 turn = so3::log(end.orientation * begin.orientation.conjugate()), back = alpha * turn;
    interpolated_[i].position = (1 + alpha) * end.position - alpha * begin.position;
    interpolated_[i].orientation = so3::exp_quaternion(back) * end.orientation;
    interpolated_[i].rotation = interpolated_[i].orientation.toRotationMatrix();
    interpolated_spins_[i] = so3::exp(back) + alpha * so3::tangent(back) * so3::inverse_tangent(turn);
  }
}

HhtInterpolation::Moment HhtInterpolation::moment(int node, const Vector3& begin, const Vector3& end,
                                                  bool with_derivative) const {
  assert(!of_rotation_vectors() || total_rotations_.size() == interpolated_.size());
  const double alpha = configuration_.scheme().alpha;
  Moment out{(1 + alpha) * end - alpha * begin, (1 + alpha) * Matrix3::Identity(), Matrix3::Zero()};
  if (!of_rotation_vectors()) return out;
  const Vector3 &theta_begin = configuration_.state().study.total_rotations[node], &theta = total_rotations_[node];
  const Vector3 between = (1 + alpha) * theta - alpha * theta_begin;
  const so3::ExponentialMap<double> map(theta);
  const Matrix3 transposed = map.tangent().transpose(), back = so3::inverse_tangent(between).transpose();
  const Vector3 additive = (1 + alpha) * (transposed * end) - alpha * (so3::tangent(theta_begin).transpose() * begin);
  out.value = back * additive;
  out.slope = (1 + alpha) * back * transposed;
  if (with_derivative)  // T^{-T}(theta) = T^{-1}(-theta)
    out.derivative = (1 + alpha) *
                     (back * map.xi_tangent_transposed(end) - so3::xi_inverse_tangent(Vector3(-between), additive)) *
                     map.inverse_tangent();
  return out;
}

void HhtInterpolation::take(int node, const Vector6& force, Eigen::Matrix<double, 6, 3>& rotational,
                            bool of_configuration, bool with_tangent) {
  end_forces_[node] += force;
  if (of_kinematics()) {
    if (of_configuration) rotational = (rotational * interpolated_spins_[node]).eval();
  } else if (with_tangent) {
    rotational.topRows<3>() *= 1 + configuration_.scheme().alpha;
    rotational.bottomRows<3>() = (moment_slope(node) * rotational.bottomRows<3>()).eval();
  }
}

void HhtInterpolation::add_forces(Balance& balance) const {
  assert(of_kinematics() || configuration_.state().study.forces.size() == end_forces_.size());
  const double alpha = configuration_.scheme().alpha;
  for (std::size_t i = 0; i < end_forces_.size(); ++i) {
    const int node = static_cast<int>(i);
    Vector6 force = end_forces_[i];
    if (!of_kinematics()) {
      const Vector6& begin = configuration_.state().study.forces[i];
      const Moment interpolated = moment(node, begin.tail<3>(), end_forces_[i].tail<3>(), balance.tangent != nullptr);
      force.head<3>() = (1 + alpha) * end_forces_[i].head<3>() - alpha * begin.head<3>();
      force.tail<3>() = interpolated.value;
      if (balance.tangent && of_rotation_vectors()) {
        Matrix6 tangent = Matrix6::Zero();
        tangent.bottomRightCorner<3, 3>() = interpolated.derivative;
        balance.tangent->add_to_node(node, tangent);
      }
    }
    balance.residual.node(node) += force;
  }
}

void HhtInterpolation::shift_reactions(Balance& balance) {
  assert(!has_reactions() || configuration_.state().study.reactions.size() == end_reactions_.size());
  const double alpha = configuration_.scheme().alpha, weight = alpha / (1 - alpha);
  for (std::size_t i = 0; i < end_reactions_.size(); ++i) {
    Eigen::Map<Vector6> residual = balance.residual.node(static_cast<int>(i));
    end_reactions_[i] = residual;
    if (has_reactions()) residual += weight * configuration_.state().study.reactions[i];
  }
}

void HhtInterpolation::accept(State& state) const {
  assert(state.study.forces.size() == end_forces_.size());
  std::copy(end_forces_.begin(), end_forces_.end(), state.study.forces.begin());
  state.study.reactions = end_reactions_;
}

}  // namespace flexarm
