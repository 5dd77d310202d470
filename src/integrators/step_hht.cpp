// What the Hilber-Hughes-Taylor family adds to Newmark's rule: forces at t_{n+1+alpha} (Muñoz 2004, sec. 4.2).
//
// All else in the balance has to belong to that instant, too, or the family is first order:
// - Momentum rates in all three forms as the thesis has them for HHT3 only (4.13). With (4.14) the gyroscopic terms
//   would be those of t_{n+1}.
// - HHT1 interpolates moments conjugate to rotation vectors and turns them back at the rotation of t_{n+1+alpha}.
// - Forces that joints transmit are those of t_{n+1+alpha}, but slaves are folded by the maps of t_{n+1}. To fold what
//   belongs there, reactions are extrapolated from two steps, (1 - alpha) R_{n+1} + alpha R_n; without joints they
//   vanish.
#include <algorithm>

#include "integrators/step_system.h"
#include "math/so3.h"

namespace flexarm {

double StepSystem::load_time() const {
  if (scheme_.is_incremental()) return 0.5;
  return scheme_.hht == HhtForm::Kinematics ? 1 + scheme_.alpha : 1;
}

void StepSystem::interpolate_configuration() {
  const double alpha = scheme_.alpha;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    interpolated_[i] = end_[i];
    if (scheme_.hht != HhtForm::Kinematics) continue;
    const Vector3 turn = so3::log(end_[i].orientation * begin_[i].orientation.conjugate()), back = alpha * turn;
    interpolated_[i].position = (1 + alpha) * end_[i].position - alpha * begin_[i].position;
    interpolated_[i].orientation = so3::exp_quaternion(back) * end_[i].orientation;
    interpolated_[i].rotation = interpolated_[i].orientation.toRotationMatrix();
    interpolated_spins_[i] = so3::exp(back) + alpha * so3::tangent(back) * so3::inverse_tangent(turn);
  }
}

InterpolatedMoment StepSystem::interpolated_moment(int node, const Vector3& begin, const Vector3& end,
                                                   bool with_derivative) const {
  InterpolatedMoment out{(1 + scheme_.alpha) * end - scheme_.alpha * begin, (1 + scheme_.alpha) * Matrix3::Identity(),
                         Matrix3::Zero()};
  if (scheme_.hht != HhtForm::AdditiveForces) return out;
  const double alpha = scheme_.alpha;
  const Vector3 &theta_begin = state_->total_rotations[node], &theta = reference_.total_rotations()[node];
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

void StepSystem::add_interpolated_forces(bool with_tangent) {
  const bool of_forces = scheme_.hht != HhtForm::Kinematics;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const int node = static_cast<int>(i);
    Vector6 force = end_forces_[i];
    if (of_forces) {
      const Vector6& begin = state_->forces[i];
      const InterpolatedMoment moment =
          interpolated_moment(node, begin.tail<3>(), end_forces_[i].tail<3>(), with_tangent);
      force.head<3>() = (1 + scheme_.alpha) * end_forces_[i].head<3>() - scheme_.alpha * begin.head<3>();
      force.tail<3>() = moment.value;
      if (with_tangent)
        Eigen::Map<Matrix6>(backend_->diagonal_block(node)).bottomRightCorner<3, 3>() += moment.derivative;
    }
    Eigen::Map<Vector6>(rows_.at(node)) += force;
  }
}

void StepSystem::shift_reactions() {
  const double weight = scheme_.alpha / (1 - scheme_.alpha);
  for (std::size_t i = 0; i < end_.size(); ++i) {
    Eigen::Map<Vector6> residual(rows_.at(static_cast<int>(i)));
    end_reactions_[i] = residual;
    if (has_reactions()) residual += weight * state_->reactions[i];
  }
}

void StepSystem::initialise_momentum_rates(State& state) {
  const auto rate = [](const Matrix3& rotation, const Matrix3& J, const Vector3& W, const Vector3& A) {
    return Vector3(rotation * (W.cross(J * W) + J * A));
  };
  state.momentum_rates.assign(end_momentum_rates_.size(), Vector3::Zero());
  for_each_element(model_.beams, [&](const auto& element) {
    for (std::size_t k = 0; k < element.mass_points.size(); ++k) {
      const int index = element.first_mass_point + static_cast<int>(k);
      const MassPointState& point = state.mass_points[index];
      state.momentum_rates[index] =
          rate(begin_mass_rotations_[index], element.inertia, point.angular_velocity, point.angular_acceleration);
    }
  });
  for (std::size_t i = 0; i < state.nodes.size(); ++i)
    state.momentum_rates[model_.mass_point_count + i] =
        rate(begin_[i].rotation, model_.inertias[i].rotary, state.nodes[i].angular_velocity,
             state.nodes[i].angular_acceleration);
}

}  // namespace flexarm
