#include "contact/line_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/cayley.h"

namespace flexarm {
namespace {

using so3::hat;

/// Relative motions shorter than this, relative to the radii, get no correction.
constexpr double kShortMotion = 1e-6;

Vector3 unit_or_zero(const Vector3& v) {
  const double length = v.norm();
  return length > 0 ? Vector3(v / length) : Vector3(Vector3::Zero());
}

/// Adds the normal force. Its direction is the gradient of the distance with respect to {relative displacement,
/// relative rotation} of ball and line, with a correction that makes the work over the step exact.
void add_line_push(const LineRadii& radii, const LineMotion& motion, bool with_slope, LineAction& action) {
  const Vector3 middle = 0.5 * (motion.begin + motion.end), along_end = unit_or_zero(motion.end);
  const double size = motion.begin.norm() + motion.end.norm();
  if (size == 0) return;  // the force has no direction
  const Vector3 normal = (motion.begin + motion.end) / size;
  const double arm = radii.sum * radii.sum;
  Vector6 way, along, gradient;
  way << motion.end - motion.begin - motion.line_turn.cross(middle), motion.turn - motion.line_turn;
  along << way.head<3>(), arm * way.tail<3>();
  gradient << normal, Vector3::Zero();
  const double square = way.dot(along),
               missing = motion.end_distance - motion.begin_distance - (motion.end.norm() - motion.begin.norm());
  const bool is_corrected = square > kShortMotion * kShortMotion * arm;
  if (is_corrected) gradient += missing / square * along;
  action.wrench = action.push.value * gradient;
  if (!with_slope) return;
  LineAction::Columns by_end = LineAction::Columns::Zero();
  by_end.topRows<3>() = (Matrix3::Identity() - normal * along_end.transpose()) / size;
  action.by_distance = -action.push.slope * gradient;
  if (is_corrected) {
    const Matrix3 way_by_end = Matrix3::Identity() - 0.5 * hat(motion.line_turn);
    const double ratio = missing / square;
    const Vector3 towards = along.head<3>(), turned = along.tail<3>();
    const auto by_way = [&](const Matrix3& of_way) {  // for a variation {of_way, 0} of `way`
      LineAction::Columns out;
      out.topRows<3>() = ratio * of_way;
      out.bottomRows<3>().setZero();
      out.noalias() -= 2 * ratio / square * along * (towards.transpose() * of_way);
      return out;
    };
    by_end += by_way(way_by_end) - along / square * along_end.transpose();
    LineAction::Columns by_turn = -2 * ratio / square * along * turned.transpose();
    by_turn.bottomRows<3>().diagonal().array() += ratio * arm;
    action.by_turn = action.push.value * by_turn;
    action.by_line_turn = action.push.value * (by_way(hat(middle)) - by_turn);
    action.by_distance += action.push.value / square * along;
  }
  action.by_end = action.push.value * by_end;
}

/// Half of the rotation with the tangent-scaled vector w, and the derivative of its spin with respect to w.
struct HalfTurn {
  Matrix3 rotation, spin;
};
HalfTurn half_turn(const Vector3& w) {
  const double q = std::sqrt(1 + 0.25 * w.squaredNorm()), scale = 1 / (1 + q);
  const Vector3 half = scale * w;
  const Matrix3 by_w = scale * Matrix3::Identity() - scale * scale / (4 * q) * w * w.transpose();
  return {cayley::rotation(half), cayley::tangent(half) * by_w};
}

/// Adds friction at the ball's surface.
void add_line_grip(const ContactLaw& law, const LineRadii& radii, const LineMotion& motion, const LineMemory& memory,
                   const GripRoot& root, bool with_slope, LineAction& action) {
  const double weight = motion.at_end ? 1 : 0.5, length_least = 1e-12 * radii.sum;
  const Vector3 middle = weight * motion.end + (1 - weight) * motion.begin;
  const double length = middle.norm();
  if (length <= length_least) return;
  const Vector3 normal = middle / length, offset = -radii.ball * normal;
  const Vector3 turn = motion.turn - motion.line_turn;
  const Vector3 slip = motion.end - motion.begin - motion.line_turn.cross(middle) + turn.cross(offset);
  const HalfTurn half = half_turn(motion.line_turn);
  const Vector3 stretch = half.rotation * memory.stretch;
  const ContactGrip grip = contact_grip(law, stretch, slip, normal, action.push.value, root.value);
  const Vector3 drag = -law.grip * grip.pull;
  action.memory.stretch = half.rotation * grip.stretch;
  action.dissipated += -drag.dot(slip) - 0.5 * law.grip * grip.stretch.squaredNorm();
  action.wrench.head<3>() += drag;
  action.wrench.tail<3>() += offset.cross(drag);
  if (!with_slope) return;
  const Matrix3 normal_by_end = weight / length * (Matrix3::Identity() - normal * normal.transpose());
  const Matrix3 slip_by_end =
      Matrix3::Identity() - weight * hat(motion.line_turn) - radii.ball * hat(turn) * normal_by_end;
  const Matrix3 slip_by_line_turn = hat(middle) + hat(offset);
  const Matrix3 by_end = -law.grip * (grip.by_slip * slip_by_end + grip.by_normal * normal_by_end);
  const Matrix3 by_turn = law.grip * grip.by_slip * hat(offset);
  const Matrix3 by_line_turn =
      -law.grip * (grip.by_slip * slip_by_line_turn - grip.by_slip / root.value * hat(stretch) * half.spin);
  const Vector3 by_distance = law.grip * (action.push.slope * grip.by_push + root.slope * grip.by_root);
  const Matrix3 couple = hat(offset);
  action.by_end.topRows<3>() += by_end;
  action.by_end.bottomRows<3>() += couple * by_end + radii.ball * hat(drag) * normal_by_end;
  action.by_turn.topRows<3>() += by_turn;
  action.by_turn.bottomRows<3>() += couple * by_turn;
  action.by_line_turn.topRows<3>() += by_line_turn;
  action.by_line_turn.bottomRows<3>() += couple * by_line_turn;
  action.by_distance.head<3>() += by_distance;
  action.by_distance.tail<3>() += couple * by_distance;
}

}  // namespace

LineAction line_action(const ContactLaw& law, const LineRadii& radii, const LineMotion& motion,
                       const LineMemory& memory, bool with_slope) {
  LineAction out;
  // Energy stored at the beginning; what is stored at the end is subtracted below.
  out.dissipated = 0.5 * law.grip * memory.stretch.squaredNorm();
  const double start = motion.duration != 0 ? memory.start : 0.0, end_start = let_out(law, start, motion.duration);
  ContactChange change{radii.sum - start - motion.begin_distance, radii.sum - end_start - motion.end_distance,
                       motion.at_end ? 0.0 : motion.duration};
  out.memory.start = std::clamp(radii.sum - motion.end_distance, 0.0, end_start);
  if (change.begin <= 0 && change.end <= 0) return out;
  out.acts = true;
  if (motion.at_end && change.end >= kDeepestRest * law.depth) {
    out.wrench.setConstant(std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  out.memory.stiffening = change.end > 0 || law.friction > 0 ? memory.stiffening : 0;
  const double begin_rate = motion.begin_rate + let_out_rate(law, start);
  change.speed = approach_speed(change.begin, begin_rate, memory.speed);
  out.push = contact_push(law, change);
  if (change.duration != 0) out.memory.speed = remembered_speed(change, begin_rate);
  out.dissipated += out.push.dissipated;
  out.work = out.push.value * (start - end_start);
  if (!motion.at_end) add_line_push(radii, motion, with_slope, out);
  if (!(law.friction > 0)) return out;
  const GripRoot root = grip_root(law, change.end, change.speed, motion.duration);
  if (change.end > 0) out.memory.root = root.value;
  add_line_grip(law, radii, motion, memory, root, with_slope, out);
  return out;
}

}  // namespace flexarm
