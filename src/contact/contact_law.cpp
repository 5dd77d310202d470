#include "contact/contact_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "joints/penetration.h"
#include "joints/stop_restitution.h"
#include "math/pi.h"

namespace flexarm {
namespace {

/// A step is too long if it advances the phase of the contact's oscillator by more than kLargestAngle, and covers more
/// than the part kLargestPart of a hit.
constexpr double kLargestAngle = kPi / 9, kLargestPart = 0.25;
/// Hits below this speed are not resolved. Relative to the speed at which the deepest penetration that still acts from
/// the surface (ContactLaw::most_start) would be pushed out. Without this bound, a contact that begins at rest would
/// cover all of its motion in every step, however short.
constexpr double kSlow = 1e-3;
/// Phase angle by which a step advances a sticking oscillator that the step damps best.
constexpr double kBestAngle = 4;
/// In a hit, the hardened penetration is at most the speed of approach over the frequency. If it is more than
/// 1 / kPressed times as large, something presses.
constexpr double kPressed = 0.5;
/// An initial penetration decays to 1/e while the contact's oscillator advances by this phase angle.
constexpr double kLetOutAngle = 100;

/// What sticks at the end of a step by itself: `whole` and at most `most`, with derivatives.
struct Held {
  Vector3 stretch;
  Matrix3 by_whole, by_normal;
  Vector3 by_most;
};

/// The part of a stretch normal to `normal`, of length at most `most`.
Held held_across(const Vector3& whole, const Vector3& normal, double most) {
  const Matrix3 tangential = Matrix3::Identity() - normal * normal.transpose();
  const Vector3 trial = tangential * whole;
  const Matrix3 by_normal = -(normal.dot(whole) * Matrix3::Identity() + normal * whole.transpose());
  const double size = trial.norm();
  if (size <= most) return {trial, tangential, by_normal, Vector3::Zero()};
  const Vector3 along = trial / size;
  const Matrix3 turn = most / size * (Matrix3::Identity() - along * along.transpose());
  return {most * along, turn * tangential, turn * by_normal, along};
}

/// The part of a stretch along `normal`, of length at most `most`.
Held held_along(const Vector3& whole, const Vector3& normal, double most) {
  const double size = normal.dot(whole);
  if (std::abs(size) <= most)
    return {size * normal, normal * normal.transpose(), size * Matrix3::Identity() + normal * whole.transpose(),
            Vector3::Zero()};
  const double sign = size < 0 ? -1 : 1;
  return {sign * most * normal, Matrix3::Zero(), sign * most * Matrix3::Identity(), sign * normal};
}

/// `most`: the largest pull, per push; `slip`: as in `held` before it was scaled by the root.
ContactGrip grip_of(const Held& held, const Vector3& slip, double push, double most, double root) {
  const Vector3 stretch_by_root = held.by_whole * slip - most * push / (root * root) * held.by_most;
  return {held.stretch,          root * held.stretch, root * root * held.by_whole,
          root * held.by_normal, most * held.by_most, held.stretch + root * stretch_by_root};
}

}  // namespace

double damping_for_restitution(double restitution) {
  assert(restitution >= 0 && restitution <= 1);
  if (restitution == 1) return 0;
  const double e = std::max(restitution, kLeastRestitution);
  // Newton's method from the leading terms of the series at e = 1; bisection if an update leaves the bracket.
  double low = 1e-9, high = (1 - 1e-15) / e, d = std::min(1.5 * (1 - e), high);
  for (int i = 0; i < 100; ++i) {
    const double value = d * (1 + e) - std::log1p(d) + std::log1p(-e * d);
    (value > 0 ? low : high) = d;
    const double before = d, slope = 1 + e - 1 / (1 + d) - e / (1 - e * d);
    d -= value / slope;
    if (!(low < d && d < high)) d = 0.5 * (low + high);
    if (std::abs(d - before) <= std::numeric_limits<double>::epsilon() * d) break;
  }
  return d;
}

Restitution::Restitution(double value) {
  values_[0] = value;
  dampings_[0] = damping_for_restitution(value);
}

Restitution::Restitution(const std::vector<double>& values, const std::vector<double>& speeds) : count_(values.size()) {
  assert(count_ >= 1 && count_ <= kMost && (count_ == 1 || speeds.size() == count_));
  for (std::size_t i = 0; i < count_; ++i) {
    values_[i] = values[i];
    dampings_[i] = damping_for_restitution(values[i]);
    if (!speeds.empty()) speeds_[i] = speeds[i];
  }
}

double Restitution::at(double speed) const {
  const auto begin = speeds_.begin(), end = begin + count_;
  const auto next = static_cast<std::size_t>(std::upper_bound(begin, end, speed) - begin);
  if (next == 0) return values_[0];
  if (next == count_) return values_[count_ - 1];
  const double part = (speed - speeds_[next - 1]) / (speeds_[next] - speeds_[next - 1]);
  return values_[next - 1] + part * (values_[next] - values_[next - 1]);
}

double Restitution::damping_at(double speed) const {
  if (count_ == 1 || speed <= speeds_[0]) return dampings_[0];
  if (speed >= speeds_[count_ - 1]) return dampings_[count_ - 1];
  return damping_for_restitution(at(speed));
}

double contact_energy(const ContactLaw& law, double penetration) {
  if (penetration <= 0) return 0;
  const double x = hardened({penetration, law.depth}).value;
  return 0.5 * law.stiffness * x * x;
}

ContactPush contact_push(const ContactLaw& law, const ContactChange& change) {
  const Penetration begin{change.begin, law.depth}, end{change.end, law.depth};
  const Hardened x1 = hardened(end);
  const double k = law.stiffness;
  if (change.duration == 0) return {k * x1.slope * x1.value, k * (x1.slope * x1.slope + x1.curvature * x1.value), 0};
  if (!begin.is_felt() && !end.is_felt()) return {};
  const double x0 = hardened(begin).value, mean = 0.5 * (x0 + x1.value);
  const Hardened rise = quotient(begin, end);
  const double elastic = k * rise.value * mean, slope = k * (rise.slope * mean + 0.5 * rise.value * x1.slope);
  const double way = change.end - change.begin, stored = k * (x1.value - x0) * mean;
  const double damping = law.restitution.damping_at(change.speed);
  if (damping == 0) return {elastic, slope, 0};
  // Slow contacts are damped like hits with half of the speed that belongs to their penetration.
  const double bound = 0.5 * law.frequency * mean, alpha = damping / std::max(change.speed, bound);
  const double factor = 1 + alpha * way / change.duration;
  if (factor <= 0) return {0, 0, -stored};
  const double alpha_slope = bound > change.speed ? -0.5 * alpha * x1.slope / mean : 0.0;
  return {elastic * factor, slope * factor + elastic * (alpha + alpha_slope * way) / change.duration,
          elastic * factor * way - stored};
}

double push_at(const ContactLaw& law, double penetration, double rate, double speed) {
  const Hardened x = hardened({penetration, law.depth});
  if (x.value == 0) return 0;
  const double alpha = law.restitution.damping_at(speed) / std::max(speed, 0.5 * law.frequency * x.value);
  return law.stiffness * x.slope * x.value * std::max(0.0, 1 + alpha * rate);
}

bool is_coarse_hit(const ContactLaw& law, const ContactChange& change, double begin_rate, double refinement) {
  const double x0 = hardened({change.begin, law.depth}).value, x1 = hardened({change.end, law.depth}).value;
  const bool conserves =
      law.restitution.damping_at(change.speed) == 0 && std::isinf(law.depth);  // for steps of any length
  if (conserves || (x0 == 0 && x1 == 0)) return false;
  const double way = change.end - change.begin, end_rate = 2 * way / change.duration - begin_rate;
  const double rise = way == 0 ? 1.0 : std::max((x1 - x0) / way, std::isinf(law.depth) ? 1.0 : 0.0);
  const double angle = law.frequency * change.duration * rise;
  if (angle * refinement <= kLargestAngle) return false;
  const double part = std::hypot(law.frequency * (x1 - x0), end_rate - begin_rate);
  const double whole = std::max(std::hypot(law.frequency * x0, begin_rate), std::hypot(law.frequency * x1, end_rate));
  return whole > kSlow * law.frequency * law.most_start && part * refinement > kLargestPart * whole;
}

double approach_speed(double penetration, double begin_rate, double remembered) {
  if (begin_rate <= 0) return std::abs(remembered);
  return penetration <= 0 || remembered < 0 ? begin_rate : std::max(remembered, begin_rate);
}

double remembered_speed(const ContactChange& change, double begin_rate) {
  if (change.end <= 0) return 0;
  return begin_rate < 0 ? -change.speed : change.speed;
}

double let_out(const ContactLaw& law, double start, double duration) {
  if (start == 0) return 0;
  const double left = start * std::exp(-law.frequency * std::abs(duration) / kLetOutAngle);
  return left > kLeastStart ? left : 0.0;
}

double let_out_rate(const ContactLaw& law, double start) {
  return start * law.frequency / kLetOutAngle;
}

GripRoot grip_root(const ContactLaw& law, double penetration, double speed, double duration) {
  if (penetration <= 0 || std::isinf(law.depth)) return {};
  const Hardened x = hardened({penetration, law.depth});
  const double part = speed / (law.frequency * x.value);
  if (part <= kPressed) return {};
  const double s = share({penetration, law.depth}), square = s * s, a = room(s);
  const double rise = (1 + square * (18 + 21 * square)) / std::pow(a, 6) - 1;
  const double rise_slope = 24 * s * (2 + square * (11 + 7 * square)) / std::pow(a, 7) / law.depth;
  const double weight = std::min((part - kPressed) / (1 - kPressed), 1.0);
  const double weight_slope = part < 1 ? -part * x.slope / x.value / (1 - kPressed) : 0;
  const double factor = 1 + weight * rise, angle = law.frequency * std::abs(duration);
  if (factor * angle * angle >= kBestAngle * kBestAngle) return {std::max(1.0, kBestAngle / angle), 0};
  return {std::sqrt(factor), 0.5 * (weight * rise_slope + weight_slope * rise) / std::sqrt(factor)};
}

ContactGrip contact_grip(const ContactLaw& law, const Vector3& stretch, const Vector3& slip, const Vector3& normal,
                         double push, double root) {
  assert(law.grip > 0);
  const double most = law.friction / law.grip;
  return grip_of(held_across(stretch + root * slip, normal, most * push / root), slip, push, most, root);
}

ContactGrip turn_grip(const ContactLaw& law, const Vector3& turned, const Vector3& turn, const Vector3& normal,
                      double push, double root) {
  assert(law.turn_grip > 0);
  const double spins = law.spinning / law.turn_grip, rolls = law.rolling / law.turn_grip;
  const Vector3 whole = turned + root * turn;
  const ContactGrip along = grip_of(held_along(whole, normal, spins * push / root), turn, push, spins, root);
  const ContactGrip across = grip_of(held_across(whole, normal, rolls * push / root), turn, push, rolls, root);
  return {along.stretch + across.stretch,     along.pull + across.pull,       along.by_slip + across.by_slip,
          along.by_normal + across.by_normal, along.by_push + across.by_push, along.by_root + across.by_root};
}

}  // namespace flexarm
