#include "contact/point_contact.h"

#include <algorithm>
#include <limits>

#include "math/so3.h"

namespace flexarm {
namespace {

using so3::hat;

/// Motions shorter than this, relative to the distance from the shape's origin, get no correction.
constexpr double kShort = 1e-6;
/// An edge that is lower than this does not hold a corner back. Relative to ContactLaw::depth.
constexpr double kLow = 0.2;

/// Normal force and normal, which friction and resistance to turning depend on, with their derivatives.
struct Pushed {
  double push;
  Vector3 normal;                 ///< unit vector
  Matrix3 by_end;                 ///< derivative of the normal with respect to the point at the end
  Vector3 push_by_end;            ///< derivative of the push with respect to the point at the end
  double root;                    ///< see grip_root()
  Vector3 root_by_end;            ///< its derivative with respect to the point at the end
  double push_slope, root_slope;  ///< derivatives of both with respect to the penetration at the end
};
Pushed pushed(const GapChange& gap, const ContactPush& push, const GripRoot& root) {
  const double length = gap.gradient.norm();
  const Vector3 normal = gap.gradient / length;
  return {push.value,
          normal,
          (Matrix3::Identity() - normal * normal.transpose()) * gap.slope / length,
          -push.slope * gap.end_gradient,
          root.value,
          -root.slope * gap.end_gradient,
          push.slope,
          root.slope};
}

/// Derivative of a grip's pull with respect to the point at the end, but for that by the slip.
Matrix3 pull_by_end(const ContactGrip& grip, const Pushed& pushed) {
  return grip.by_normal * pushed.by_end + grip.by_push * pushed.push_by_end.transpose() +
         grip.by_root * pushed.root_by_end.transpose();
}

/// Derivative of a grip's pull with respect to the penetration at the end.
Vector3 pull_by_penetration(const ContactGrip& grip, const Pushed& pushed) {
  return grip.by_push * pushed.push_slope + grip.by_root * pushed.root_slope;
}

/// Adds friction, which acts at the surface of the ball, or at the lowest point of a rim.
void add_grip(const ContactLaw& law, double radius, const PointMotion& motion, const Pushed& pushed,
              const Vector3& stretch, bool with_slope, PointAction& action) {
  const Vector3 offset = motion.offset() - radius * pushed.normal;
  const Vector3 slip = motion.end - motion.begin + motion.turn.cross(offset);
  const ContactGrip grip = contact_grip(law, stretch, slip, pushed.normal, pushed.push, pushed.root);
  const Vector3 drag = -law.grip * grip.pull;
  action.memory.stretch = grip.stretch;
  action.dissipated += -drag.dot(slip) - 0.5 * law.grip * grip.stretch.squaredNorm();
  action.wrench.head<3>() += drag;
  action.wrench.tail<3>() += offset.cross(drag);
  if (!with_slope) return;
  // The point at the end moves the normal, and by it this offset. The offset of a rim moves it and the point.
  const Matrix3 by_end = -radius * pushed.by_end, turning = hat(motion.turn);
  const Matrix3 by_offset = by_end + motion.end_weight() * Matrix3::Identity();
  Eigen::Matrix<double, 3, 6> drag_slope;
  drag_slope << grip.by_slip * (Matrix3::Identity() + turning * by_end) + pull_by_end(grip, pushed),
      -grip.by_slip * hat(offset);
  drag_slope *= -law.grip;
  action.slope.topRows<3>() += drag_slope;
  action.slope.bottomRows<3>() += hat(offset) * drag_slope;
  action.slope.bottomLeftCorner<3, 3>() -= hat(drag) * by_end;
  if (!motion.end_offset.isZero(0)) {
    const Matrix3 drag_by_offset = -law.grip * (grip.by_slip * turning * by_offset + pull_by_end(grip, pushed));
    action.by_offset.topRows<3>() += drag_by_offset;
    action.by_offset.bottomRows<3>() += hat(offset) * drag_by_offset - hat(drag) * by_offset;
  }
  action.by_begin.topRows<3>() = law.grip * grip.by_slip;
  action.by_begin.bottomRows<3>() = hat(offset) * action.by_begin.topRows<3>();
  const Vector3 drag_by_excess = -law.grip * pull_by_penetration(grip, pushed);
  action.by_excess.head<3>() += drag_by_excess;
  action.by_excess.tail<3>() += offset.cross(drag_by_excess);
}

/// Adds the resistance to rotation relative to the surface.
void add_turn_grip(const ContactLaw& law, const PointMotion& motion, const Pushed& pushed, const Vector3& turned,
                   bool with_slope, PointAction& action) {
  const ContactGrip grip = turn_grip(law, turned, motion.turn, pushed.normal, pushed.push, pushed.root);
  const Vector3 couple = -law.turn_grip * grip.pull;
  action.memory.turned = grip.stretch;
  action.dissipated += -couple.dot(motion.turn) - 0.5 * law.turn_grip * grip.stretch.squaredNorm();
  action.wrench.tail<3>() += couple;
  if (!with_slope) return;
  action.slope.bottomLeftCorner<3, 3>() -= law.turn_grip * pull_by_end(grip, pushed);
  action.by_offset.bottomRows<3>() -= law.turn_grip * pull_by_end(grip, pushed);
  action.slope.bottomRightCorner<3, 3>() -= law.turn_grip * grip.by_slip;
  action.by_excess.tail<3>() -= law.turn_grip * pull_by_penetration(grip, pushed);
}

/// Adds the normal force. The change of the excess of a segment, which the point itself does not have, does its work by
/// a wrench in proportion to the motion. (docs/notes/contact.md 1.2)
void add_push(const GapChange& gap, const ContactPush& push, const PointMotion& motion, bool with_slope,
              PointAction& action) {
  Vector6 way;  // rotations count by the lever
  way << motion.end - motion.begin, motion.lever * motion.lever * motion.turn;
  const double square = way.head<3>().squaredNorm() + way.tail<3>().dot(motion.turn);
  const bool corrects = motion.lever > 0 && !motion.at_end && square > kShort * kShort * motion.lever * motion.lever;
  const double part = corrects ? (motion.begin_excess - motion.end_excess) / square : 0;
  Vector6 gradient = part * way;
  gradient.head<3>() += gap.gradient;
  action.wrench += push.value * gradient;
  if (!with_slope) return;
  action.slope.leftCols<3>() -= push.slope * gradient * gap.end_gradient.transpose();
  action.slope.topLeftCorner<3, 3>() += push.value * gap.slope;
  action.by_offset = action.slope.leftCols<3>();
  action.by_excess += push.slope * gradient;
  if (!corrects) return;
  action.by_excess -= push.value / square * way;
  action.slope -= 2 * push.value * part / square * way * way.transpose();
  action.slope.topLeftCorner<3, 3>().diagonal().array() += push.value * part;
  action.slope.bottomRightCorner<3, 3>().diagonal().array() += push.value * part * motion.lever * motion.lever;
}

/// Energy that is stored by sticking [J].
double held_energy(const ContactLaw& law, const PointMemory& memory) {
  return 0.5 * (law.grip * memory.stretch.squaredNorm() + law.turn_grip * memory.turned.squaredNorm());
}

/// A point deeper below a face than this, relative to half of the shape's smallest width, has not entered by that face.
/// The excess over 1 is for round-off.
constexpr double kHalfWay = 1 + 1e-6;

/// Replaces the face by which a corner or edge enters by one that it lies on, if there is one. Example: a block slides
/// off a table. The table's edge enters the block through its front, but it should push against the block's bottom. The
/// edge is already above the bottom by the penetration of the resting contact. The same happens if a corner slides from
/// one table to another of equal height. Forces begin at the depth at which the point enters, so that no energy is
/// stored at once.
void lay_on_another(const ContactShape& shape, const ContactLaw& law, const PointMotion& motion, FeltShape& felt) {
  const double deepest = (can_lie_on(shape, felt.face, motion.outwards) ? kLow : 1.0) * law.depth;
  const int face = face_to_lie_on(shape, felt.face, motion.begin_point(), motion.outwards, deepest);
  if (face == 0) return;
  felt.face = face;
  felt.radius = std::min(beyond_face(shape, face).distance(motion.begin_point()).value, 0.0);
}

/// Returns the face by which a point enters in a step, or is already inside; 0: none. PointMotion::face allows only
/// one.
int face_of_entry(const ContactShape& shape, const PointMotion& motion) {
  const Vector3 from = motion.begin_point(), to = motion.end_point();
  if (motion.face == 0) return shape.gap(from) < 0 ? nearest_face(shape, from) : entered_face(shape, from, to);
  const ContactShape below = beyond_face(shape, motion.face);
  const double begin = below.distance(from).value, end = below.distance(to).value;
  if (begin >= 0 && end >= 0) return 0;
  const double part = begin > 0 ? begin / (begin - end) : 0;
  return is_over_face(shape, motion.face, from + part * (to - from)) ? motion.face : 0;
}

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

FeltShape felt_shape(const ContactShape& shape, const ContactLaw& law, double radius, const PointMotion& motion,
                     const PointMemory& memory) {
  FeltShape out{shape};
  out.radius = radius;
  out.start = motion.duration != 0 ? memory.start : 0;  // equilibria have no offset
  if (radius > 0 || !has_faces(shape)) return out;
  const Vector3 from = motion.begin_point();
  out.face = memory.face;
  out.radius = -memory.within;
  if (out.face != 0 && !is_over_face(shape, out.face, from)) {
    out.let_go = contact_energy(law, out.radius - out.start - beyond_face(shape, out.face).distance(from).value);
    out.face = 0;
  }
  if (out.face == 0) {
    out.radius = 0;
    out.face = face_of_entry(shape, motion);
    if (out.face != 0 && motion.face == 0 && shape.gap(from) >= 0) lay_on_another(shape, law, motion, out);
  }
  out.is_felt = out.face != 0;
  if (out.is_felt) out.shape = beyond_face(shape, out.face);
  if (memory.face != out.face) out.start = std::min(out.start, std::max(0.0, -out.shape.distance(from).value));
  // Energy that the point keeps when it moves from one face of a hull to the next is not lost.
  if (out.is_felt && out.let_go > 0)
    out.let_go -= contact_energy(law, out.radius - out.start - out.shape.distance(from).value);
  return out;
}

PointMemory start_inside(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                         const Matrix3& outwards, int face) {
  PointMemory out;
  const bool by_face = radius == 0 && has_faces(shape);
  if (shape.distance(point).value - radius > kLeastStart) return out;
  if (by_face) {
    // If equal boxes lie on each other, corners are at edges, and the nearest face may be a side.
    out.face = face != 0 ? face : nearest_face(shape, point);
    if (face == 0 && !can_lie_on(shape, out.face, outwards))
      if (const int other = face_to_lie_on(shape, 0, point, outwards, kHalfWay * half_width(shape))) out.face = other;
  }
  const ContactShape& felt = by_face ? beyond_face(shape, out.face) : shape;
  out.start = radius - felt.distance(point).value;
  return out.start > std::max(law.most_start, kLeastStart) ? out : PointMemory();
}

double stored_energy(const ContactShape& shape, const ContactLaw& law, double radius, const Vector3& point,
                     const PointMemory& memory) {
  const ContactShape& felt = memory.face != 0 ? beyond_face(shape, memory.face) : shape;
  return contact_energy(law, radius - memory.within - memory.start - felt.distance(point).value) +
         held_energy(law, memory);
}

PointAction point_action(const ContactShape& whole, const ContactLaw& law, double radius, const PointMotion& motion,
                         const PointMemory& memory, bool with_slope) {
  PointAction out;
  const FeltShape felt = felt_shape(whole, law, radius, motion, memory);
  const ContactShape& shape = felt.shape;
  // Energy stored at the beginning; what is stored at the end is subtracted below.
  out.dissipated = felt.let_go + held_energy(law, memory);
  if (!felt.is_felt) return out;
  GapChange gap = gap_change(shape, motion.begin_point(), motion.end_point(), motion.at_end);
  gap.begin -= motion.begin_excess;
  gap.end -= motion.end_excess;
  const double end_start = let_out(law, felt.start, motion.duration);
  ContactChange change{felt.radius - felt.start - gap.begin, felt.radius - end_start - gap.end,
                       motion.at_end ? 0.0 : motion.duration};
  const double inside = felt.face != 0 ? -gap.end : 0;
  // If the point moves out a little, the offset decreases with it: forces begin there when it moves in again.
  out.memory.start = std::clamp(felt.radius - gap.end, 0.0, end_start);
  out.memory.face = change.end > 0 || ((felt.radius < 0 || end_start > 0) && inside > 0) ? felt.face : 0;
  if (out.memory.face != 0 && felt.radius < 0) out.memory.within = std::min(-felt.radius, inside);
  if (change.begin <= 0 && change.end <= 0) return out;
  out.acts = true;
  // Near its depth the law is so steep that small updates do not mean convergence. In an equilibrium, NaN makes the
  // solver use shorter load steps. In a motion, penetrations near the depth can occur when a step is too long for a
  // hit. But if a point is there at the beginning and goes deeper, it is driven, and no force can stop it.
  const bool is_driven = change.begin >= kDeepestRest * law.depth && change.end >= law.depth;
  if ((motion.at_end && change.end >= kDeepestRest * law.depth) || is_driven) {
    out.wrench.setConstant(std::numeric_limits<double>::quiet_NaN());
    // This reports the failure even if the nodes have no unknowns.
    out.dissipated = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  const double begin_rate =
      let_out_rate(law, felt.start) - shape.distance(motion.begin_point()).gradient.dot(motion.begin_velocity);
  change.speed = approach_speed(change.begin, begin_rate, memory.speed);
  const ContactPush push = contact_push(law, change);
  if (change.duration != 0) out.memory.speed = remembered_speed(change, begin_rate);
  out.dissipated += push.dissipated;
  out.work = push.value * (felt.start - end_start);
  out.normal = gap.end_gradient;
  out.push = push.value;
  out.push_slope = push.slope;
  add_push(gap, push, motion, with_slope, out);
  if (gap.gradient.isZero(0)) return out;
  if (!(law.friction > 0) && !law.resists_turns()) return out;
  const GripRoot root = grip_root(law, change.end, change.speed, motion.duration);
  if (change.end > 0) out.memory.root = root.value;
  const Pushed pushed = flexarm::pushed(gap, push, root);
  if (law.friction > 0) add_grip(law, radius, motion, pushed, memory.stretch, with_slope, out);
  if (law.resists_turns()) add_turn_grip(law, motion, pushed, memory.turned, with_slope, out);
  return out;
}

PointTouch point_touch(const ContactShape& whole, const ContactLaw& law, double radius, const Vector3& point,
                       const Vector3& velocity, const PointMemory& memory) {
  const ContactShape& shape = memory.face != 0 ? beyond_face(whole, memory.face) : whole;
  const SignedDistance distance = shape.distance(point);
  PointTouch out{distance.value - radius + memory.within, distance.gradient};
  const double penetration = -out.gap - memory.start;
  if (penetration <= 0) return out;
  const double rate = let_out_rate(law, memory.start) - distance.gradient.dot(velocity);
  out.push = push_at(law, penetration, rate, approach_speed(penetration, rate, memory.speed));
  // As in a step without motion.
  const double root = memory.root > 0 ? memory.root : 1;
  if (law.friction > 0)
    out.friction = -law.grip * contact_grip(law, memory.stretch, Vector3::Zero(), out.normal, out.push, root).pull;
  if (law.resists_turns())
    out.couple = -law.turn_grip * turn_grip(law, memory.turned, Vector3::Zero(), out.normal, out.push, root).pull;
  return out;
}

bool passes_through(const ContactShape& shape, const Vector3& from, const Vector3& to, double radius) {
  if (shape.is_hollow) return false;  // a hole is convex, so the way between two of its places is free
  const Vector3 way = to - from;
  const double length = way.norm();
  // The distance from a convex shape is convex along the way. Its minimum is at an end, unless it first falls and then
  // rises.
  if (shape.distance(from).gradient.dot(way) >= 0 || shape.distance(to).gradient.dot(way) <= 0) return false;
  // The ball can advance by its distance from the surface without touching it.
  double gone = shape.distance(from).value - radius;
  if (gone + shape.distance(to).value - radius >= length) return false;
  constexpr double kLeast = 1e-4;  // smallest advance, relative to the way
  while (gone < length) {
    const double gap = shape.distance(from + gone / length * way).value - radius;
    if (gap < -kGraze * std::abs(radius)) return true;
    gone += std::max(gap, kLeast * length);
  }
  return false;
}

}  // namespace flexarm
