// What the Hilber-Hughes-Taylor family adds to Newmark's rule: forces at t_{n+1+alpha} (Muñoz 2004, sec. 4.2).
//
// Their accelerations are those of t_{n+1+alpha}, too, and so are the forces that joints transmit; but the slaves'
// residuals are folded by the maps of t_{n+1}. To fold what belongs to t_{n+1}, the reactions are extrapolated from the
// last two steps, (1 - alpha) R_{n+1} + alpha R_n; without joints both are zero. Otherwise joints would make the family
// first order.
#include <algorithm>

#include "flexarm/integrators/step_system.h"
#include "flexarm/math/so3.h"

namespace flexarm {

double StepSystem::load_time() const {
  if (scheme_.is_incremental()) return 0.5;
  return scheme_.hht == HhtForm::Kinematics ? 1 + scheme_.alpha : 1;
}

void StepSystem::interpolate_configuration() {
  if (scheme_.hht != HhtForm::Kinematics) {
    std::copy(end_.begin(), end_.end(), interpolated_.begin());
    return;
  }
  const double alpha = scheme_.alpha;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const Vector3 turn = so3::log(end_[i].orientation * begin_[i].orientation.conjugate()), back = alpha * turn;
    interpolated_[i].position = (1 + alpha) * end_[i].position - alpha * begin_[i].position;
    interpolated_[i].orientation = so3::exp_quaternion(back) * end_[i].orientation;
    interpolated_[i].rotation = interpolated_[i].orientation.toRotationMatrix();
    interpolated_spins_[i] = so3::exp(back) + alpha * so3::tangent(back) * so3::inverse_tangent(turn);
  }
}

void StepSystem::subtract_begin_forces(bool with_tangent) {
  if (scheme_.hht == HhtForm::Kinematics) return;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    Vector6 force = -scheme_.alpha * state_->forces[i];
    if (scheme_.hht == HhtForm::AdditiveForces) {  // T_{n+1}^{-T} T_n^T
      const Vector3 &begin = state_->total_rotations[i], &end = reference_.total_rotations()[i];
      const Vector3 moment = so3::tangent(begin).transpose() * force.tail<3>();
      const Matrix3 inverse = so3::inverse_tangent(end);
      force.tail<3>() = inverse.transpose() * moment;
      if (with_tangent)
        Eigen::Map<Matrix6>(assembler_.diagonal_block(static_cast<int>(i))).bottomRightCorner<3, 3>() -=
            so3::xi_inverse_tangent(Vector3(-end), moment) * inverse;
    }
    Eigen::Map<Vector6>(assembler_.residual(static_cast<int>(i))) += force;
  }
}

void StepSystem::shift_reactions() {
  const double weight = scheme_.alpha / (1 - scheme_.alpha);
  for (std::size_t i = 0; i < end_.size(); ++i) {
    Eigen::Map<Vector6> residual(assembler_.residual(static_cast<int>(i)));
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
