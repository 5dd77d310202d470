#include "contact/point_contact.h"

#include <cassert>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Ways too short for a correction along them, relative to where the points are.
constexpr double kShort = 1e-6;

}  // namespace

GapChange gap_change(const ContactShape& shape, const Vector3& from, const Vector3& to, bool at_end) {
  const SignedDistance end = shape.distance(to);
  GapChange out{shape.distance(from).value, end.value, end.gradient, end.hessian, end.gradient};
  if (at_end) return out;
  const SignedDistance middle = shape.distance(0.5 * (from + to));
  const Vector3 way = to - from;
  out.gradient = middle.gradient;
  out.slope = 0.5 * middle.hessian;
  const double square = way.squaredNorm(), missing = out.end - out.begin - middle.gradient.dot(way);
  const double size = (from - shape.place.position).norm() + way.norm();
  if (square <= kShort * kShort * size * size) return out;
  out.gradient += missing / square * way;
  const Vector3 missing_slope = end.gradient - middle.gradient - out.slope * way;
  out.slope += way * (missing_slope - 2 * missing / square * way).transpose() / square;
  out.slope.diagonal().array() += missing / square;
  return out;
}

PointAction point_action(const ContactShape& shape, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope) {
  PointAction out;
  const GapChange gap = gap_change(shape, motion.begin, motion.end, motion.at_end);
  ContactChange change{radius - gap.begin, radius - gap.end, motion.at_end ? 0.0 : motion.duration};
  if (change.begin <= 0 && change.end <= 0) {
    out.dissipated = 0.5 * law.grip * memory.stretch.squaredNorm();  // of a grip that has let go
    return out;
  }
  out.acts = true;
  change.speed = approach_speed(change.begin, motion.begin_rate, memory.speed);
  const ContactPush push = contact_push(law, change);
  if (change.duration != 0) out.memory.speed = remembered_speed(change, motion.begin_rate);
  out.dissipated = push.dissipated;
  Vector3 force = push.value * gap.gradient;
  const Vector3 by_end = -push.slope * gap.end_gradient;  // of the push
  if (with_slope) out.slope.topLeftCorner<3, 3>() = gap.gradient * by_end.transpose() + push.value * gap.slope;
  if (law.friction > 0) {
    const double length = gap.gradient.norm();
    const Vector3 normal = gap.gradient / length, offset = -radius * normal;
    const Vector3 slip = motion.end - motion.begin + motion.turn.cross(offset);
    const ContactGrip grip = contact_grip(law, memory.stretch, slip, normal, push.value);
    const Vector3 drag = -law.grip * grip.stretch;
    out.memory.stretch = grip.stretch;
    out.dissipated += -drag.dot(slip) - 0.5 * law.grip * (grip.stretch.squaredNorm() - memory.stretch.squaredNorm());
    force += drag;
    out.wrench.tail<3>() = offset.cross(drag);
    if (with_slope) {
      const Matrix3 by_normal = (Matrix3::Identity() - normal * normal.transpose()) * gap.slope / length;
      const Matrix3 slip_by_end = Matrix3::Identity() - radius * hat(motion.turn) * by_normal;
      Eigen::Matrix<double, 3, 6> drag_slope;
      drag_slope << grip.by_slip * slip_by_end + grip.by_normal * by_normal + grip.by_push * by_end.transpose(),
          -grip.by_slip * hat(offset);
      drag_slope *= -law.grip;
      out.slope.topRows<3>() += drag_slope;
      out.slope.bottomRows<3>() = hat(offset) * drag_slope;
      out.slope.bottomLeftCorner<3, 3>() += radius * hat(drag) * by_normal;
    }
  }
  out.wrench.head<3>() = force;
  return out;
}

double gap_rate(const ContactShape& shape, const Vector3& point, const Vector3& velocity) {
  return shape.distance(point).gradient.dot(velocity);
}

bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius) {
  const Vector3 way = to - from;
  const double length = way.norm();
  // No surface is nearer than the distance: the ball may go so far without a look.
  double gone = shape.distance(from).value - radius;
  if (gone + shape.distance(to).value - radius >= length) return false;
  constexpr double kLeast = 1e-4;  // of the way, per look
  while (gone < length) {
    const double gap = shape.distance(from + gone / length * way).value - radius;
    if (gap < 0) return true;
    gone += std::max(gap, kLeast * length);
  }
  return false;
}

}  // namespace flexarm
