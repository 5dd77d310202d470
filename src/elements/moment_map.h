#pragma once
/// How moments are turned into space over a step (Muñoz 2004, ch. 6; beam.md 3.2).

#include "math/so3.h"
#include "model/beam_element.h"
#include "schemes/time_rule.h"

namespace flexarm {

/// A = T(omega) Lambda_n or, by StressRule::CayleyMoment, S(w) Lambda_n, and d(A a) = derivative(a) * spin for constant
/// material a; spin: of the section at the end.
class MomentMap {
 public:
  /// From the section's rotations at both ends of the step.
  MomentMap(StressRule rule, const Matrix3& begin, const Matrix3& end);
  const Matrix3& map() const { return map_; }
  Matrix3 derivative(const Vector3& material) const;

 private:
  bool is_scaled_;
  Vector3 increment_;
  Matrix3 begin_, map_;
};

}  // namespace flexarm
