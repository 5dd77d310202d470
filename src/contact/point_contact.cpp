#include "contact/point_contact.h"

#include <algorithm>
#include <limits>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Ways too short for a correction along them, relative to where the points are.
constexpr double kShort = 1e-6;
/// Of the depth: no equilibrium is deeper.
constexpr double kDeepest = 0.95;

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

FeltShape felt_shape(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& from,
                     const Vector3& to, int remembered_face) {
  FeltShape out{shape};
  if (radius > 0 || !has_faces(shape)) return out;
  out.face = remembered_face;
  if (out.face != 0 && !is_over_face(shape, out.face, from)) {
    out.let_go = contact_energy(law, -beyond_face(shape, out.face).distance(from).value);
    out.face = 0;
  }
  if (out.face == 0)
    out.face = shape.distance(from).value < 0 ? nearest_face(shape, from) : entered_face(shape, from, to);
  out.is_felt = out.face != 0;
  if (out.is_felt) out.shape = beyond_face(shape, out.face);
  return out;
}

double stored_energy(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                     const PointMemory& memory) {
  const ContactShape& felt = memory.face != 0 ? beyond_face(shape, memory.face) : shape;
  return contact_energy(law, radius - felt.distance(point).value) + 0.5 * law.grip * memory.stretch.squaredNorm();
}

PointAction point_action(const ContactShape& whole, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope) {
  PointAction out;
  const FeltShape felt = felt_shape(whole, law, radius, motion.begin, motion.end, memory.face);
  const ContactShape& shape = felt.shape;
  const double grip_energy = 0.5 * law.grip * memory.stretch.squaredNorm();
  out.dissipated = felt.let_go + grip_energy;  // of a contact that has let go
  if (!felt.is_felt) return out;
  const GapChange gap = gap_change(shape, motion.begin, motion.end, motion.at_end);
  ContactChange change{radius - gap.begin, radius - gap.end, motion.at_end ? 0.0 : motion.duration};
  if (change.begin <= 0 && change.end <= 0) return out;
  out.acts = true;
  // Beyond its depth the law means nothing, and updates are too small to tell: an equilibrium is to be looked for by
  // shorter ways.
  if (motion.at_end && change.end >= kDeepest * law.depth) {
    out.wrench.setConstant(std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  out.memory.face = change.end > 0 ? felt.face : 0;
  const double begin_rate = -shape.distance(motion.begin).gradient.dot(motion.begin_velocity);
  change.speed = approach_speed(change.begin, begin_rate, memory.speed);
  const ContactPush push = contact_push(law, change);
  if (change.duration != 0) out.memory.speed = remembered_speed(change, begin_rate);
  out.dissipated = felt.let_go + push.dissipated;
  Vector3 force = push.value * gap.gradient;
  const Vector3 by_end = -push.slope * gap.end_gradient;  // of the push
  if (with_slope) out.slope.topLeftCorner<3, 3>() = gap.gradient * by_end.transpose() + push.value * gap.slope;
  if (const double length = gap.gradient.norm(); law.friction > 0 && length > 0) {
    const Vector3 normal = gap.gradient / length, offset = -radius * normal;
    const Vector3 slip = motion.end - motion.begin + motion.turn.cross(offset);
    const ContactGrip grip = contact_grip(law, memory.stretch, slip, normal, push.value);
    const Vector3 drag = -law.grip * grip.stretch;
    out.memory.stretch = grip.stretch;
    out.dissipated += -drag.dot(slip) + grip_energy - 0.5 * law.grip * grip.stretch.squaredNorm();
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

bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius) {
  const Vector3 way = to - from;
  const double length = way.norm();
  // Distances of convex shapes are convex: lowest at an end unless they fall first and rise then.
  if (shape.distance(from).gradient.dot(way) >= 0 || shape.distance(to).gradient.dot(way) <= 0) return false;
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
