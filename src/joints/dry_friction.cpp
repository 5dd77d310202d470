#include "joints/dry_friction.h"

#include <algorithm>
#include <cassert>

namespace flexarm {

void StickSlip::begin(double rest_increment, double rate) {
  rest_increment_ = rest_increment;
  low_ = std::min(rest_increment, 0.0);
  high_ = std::max(rest_increment, 0.0);
  branch_ = rate > 0 ? SlipForth : rate < 0 ? SlipBack : HeldLow;
}

bool StickSlip::revise(double increment, double effort, double capacity, double slack) {
  assert(!(capacity < 0) && slack >= 0);
  const Branch before = branch_;
  const bool plain = low_ == high_;  // both vertical parts of the staircase coincide
  const double excess = slack * capacity, least = plain ? -capacity : 0, most = plain ? capacity : 0;
  switch (before) {
    case SlipBack:
      if (increment > low_) branch_ = increment > high_ ? HeldHigh : HeldLow;
      break;
    case HeldLow:
      if (effort < -capacity - excess) branch_ = SlipBack;
      if (effort > most + excess) branch_ = plain ? SlipForth : Free;
      break;
    case Free:
      if (increment < low_) branch_ = HeldLow;
      if (increment > high_) branch_ = HeldHigh;
      break;
    case HeldHigh:
      if (effort < least - excess) branch_ = plain ? SlipBack : Free;
      if (effort > capacity + excess) branch_ = SlipForth;
      break;
    case SlipForth:
      if (increment < high_) branch_ = increment < low_ ? HeldLow : HeldHigh;
      break;
  }
  return branch_ != before;
}

NormalForce normal_force(Contact contact, const Vector6& column, const Vector3& force) {
  NormalForce out;
  Vector3 normal = force;
  if (contact != Contact::Both) {
    const int first = contact == Contact::Travel ? 0 : 3;
    const Vector3 way = column.segment<3>(first);
    const double length = way.norm();
    const Vector3 unit = way / length;
    const double axial = unit.dot(force);
    normal -= axial * unit;
    out.magnitude = normal.norm();
    if (out.magnitude > 0) out.arm.segment<3>(first) = normal / out.magnitude;
    out.along = -axial / length;
  }
  out.magnitude = normal.norm();
  if (out.magnitude > 0) out.direction = normal / out.magnitude;
  return out;
}

}  // namespace flexarm
