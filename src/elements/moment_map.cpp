#include "elements/moment_map.h"

#include "math/cayley.h"

namespace flexarm {

MomentMap::MomentMap(StressRule rule, const Matrix3& begin, const Matrix3& end)
    : is_scaled_(rule == StressRule::CayleyMoment), begin_(begin) {
  const Quaternion relative = so3::quaternion_from_matrix(end * begin.transpose());
  increment_ = is_scaled_ ? cayley::increment(relative) : so3::log(relative);
  map_ = (is_scaled_ ? cayley::tangent(increment_) : so3::tangent(increment_)) * begin;
}

Matrix3 MomentMap::derivative(const Vector3& material) const {
  const Vector3 a = begin_ * material;
  return is_scaled_ ? Matrix3(cayley::xi_tangent(increment_, a) * cayley::inverse_tangent(increment_))
                    : Matrix3(so3::xi_tangent(increment_, a) * so3::inverse_tangent(increment_));
}

}  // namespace flexarm
