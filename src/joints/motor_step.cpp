#include "joints/motor_step.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "joints/elasticity.h"
#include "joints/joint_forces.h"
#include "math/increasing_root.h"

namespace flexarm {
namespace {

/// The motor's effort, and its derivatives with respect to the increments of rotor and coordinate (link).
struct MotorEffort {
  double value, by_rotor, by_link;
};

/// Returns the largest effort in the direction of the rotor's `rate` that the motor can give, at most `limit`, and its
/// derivative with respect to the rate.
ValueAndSlope available(const Drive& drive, double limit, double rate) {
  assert(limit >= 0 && drive.effort_limit >= 0 && drive.velocity_limit > 0);
  const double part = std::clamp(1 - rate / drive.velocity_limit, 0.0, 1.0);
  const double effort = part == 1 ? drive.effort_limit : part * drive.effort_limit;
  if (effort >= limit) return {limit, 0};
  return {effort, part > 0 && part < 1 ? -drive.effort_limit / drive.velocity_limit : 0};
}

MotorEffort motor_effort(const Drive& drive, const MotorDemand& demand, const CoordinateStep& rotor, double link) {
  const double asked = demand.at(rotor.increment, link);
  const bool is_static = rotor.step == 0;
  const double rate = is_static ? 0 : rate_of(rotor), slope = is_static ? 0 : rate_slope(rotor);
  const ValueAndSlope forth = available(drive, demand.limit, rate), back = available(drive, demand.limit, -rate);
  if (asked > forth.value) return {forth.value, forth.slope * slope, 0};
  if (asked < -back.value) return {-back.value, back.slope * slope, 0};
  return {asked, demand.by_rotor, demand.by_link};
}

/// Returns the motor's effort at the end of the step: that without MotorDemand::surplus.
double effort_at_end(const Drive& drive, MotorDemand demand, const CoordinateStep& rotor, double link) {
  demand.constant -= demand.surplus;
  return motor_effort(drive, demand, rotor, link).value;
}

CoordinateStep with_increment(CoordinateStep change, double increment) {
  change.increment = increment;
  change.end = change.begin + increment;
  return change;
}

/// The action of a motor with a rigid gear. If the gear transmits the effort T, friction of loss |T| acts against the
/// motion.
MotorAction rigid_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                         const CoordinateStep& link) {
  const double u = link.increment;
  const MotorEffort motor = motor_effort(drive, demand, with_increment(rotor.change, u), u);
  const SmoothDirection direction = drive.loss > 0 ? smooth_direction(link) : SmoothDirection();
  const double net = motor.value - drive.inertia * (rotor.acceleration_offset + rotor.acceleration_slope * u);
  const double net_slope = motor.by_rotor + motor.by_link - drive.inertia * rotor.acceleration_slope;
  const double sign = net < 0 ? -1 : 1, part = 1 + drive.loss * sign * direction.value;
  MotorAction out;
  out.effort = net / part;
  out.slope = (net_slope - out.effort * drive.loss * sign * direction.slope) / part;
  out.increment = u;
  out.follows = 1;
  out.effort_by_load = -1 / part;
  out.motor = out.motor_at_end = motor.value;
  if (demand.surplus != 0) out.motor_at_end = effort_at_end(drive, demand, with_increment(rotor.change, u), u);
  out.demand = demand.at(u, u);
  out.dissipated = (net - out.effort) * u;
  return out;
}

/// The balance of efforts on a rotor behind an elastic gear, as a function of its increment u. Friction acts in a known
/// direction, or smoothly by the rotor's rate.
class RotorBalance {
 public:
  RotorBalance(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor, const CoordinateStep& link)
      : drive_(drive), demand_(demand), rotor_(rotor), link_(link) {
    assert(drive.gear && "a rotor that turns with its coordinate has no balance of its own");
  }

  struct Terms {
    PassiveEffort gear;  // effort on the twist
    MotorEffort motor;
    double capacity, without_friction;       // largest friction effort; balance without friction
    double own_slope, transmitted_by_twist;  // d(inertia and motor terms)/du; d|effort of the gear|/d(twist)
  };
  Terms terms(double u) const {
    Terms out;
    out.gear = elastic_effort(*drive_.gear, twist(u));
    out.motor = motor_effort(drive_, demand_, with_increment(rotor_.change, u), link_.increment);
    out.capacity = is_static() ? 0 : friction_capacity(drive_, out.gear.effort);
    out.without_friction = drive_.inertia * (rotor_.acceleration_offset + rotor_.acceleration_slope * u) -
                           out.gear.effort - out.motor.value;
    out.own_slope = drive_.inertia * rotor_.acceleration_slope - out.motor.by_rotor;
    out.transmitted_by_twist = out.gear.effort > 0 ? out.gear.slope : -out.gear.slope;
    return out;
  }
  SmoothDirection smooth(double u) const { return smooth_direction(with_increment(rotor_.change, u)); }

  /// Returns the balance with friction in this direction, and its derivative with respect to u.
  ValueAndSlope value(const Terms& t, const SmoothDirection& direction) const {
    return {t.without_friction + t.capacity * direction.value,
            t.own_slope - t.gear.slope + drive_.loss * t.transmitted_by_twist * direction.value +
                t.capacity * direction.slope};
  }
  double root(const SmoothDirection& direction, double guess) const {
    return increasing_root([&](double u) { return value(terms(u), direction); }, guess, scale());
  }

  /// Solves the balance with smooth friction, and returns the action at its root.
  MotorAction smooth_action(double guess) const {
    Terms t{};
    SmoothDirection direction;
    const auto evaluate = [&](double u) {
      t = terms(u), direction = smooth(u);
      return value(t, direction);
    };
    const double u = increasing_root(evaluate, guess, scale());
    return action(u, t, direction, true);
  }
  /// Returns the action at the increment u. `slides`: the rotor follows the coordinate; else friction holds it.
  MotorAction action(double u, const SmoothDirection& direction, bool slides) const {
    return action(u, terms(u), direction, slides);
  }

 private:
  MotorAction action(double u, const Terms& t, const SmoothDirection& direction, bool slides) const {
    const ValueAndSlope balance = value(t, direction);
    const double by_link = t.gear.slope - drive_.loss * t.transmitted_by_twist * direction.value - t.motor.by_link;
    // If nothing holds the rotor, as within the play in statics, it does not follow the coordinate either.
    const double yields = slides && balance.slope != 0 ? 1 / balance.slope : 0;
    MotorAction out;
    out.follows = -by_link * yields;
    out.effort = -t.gear.effort;
    out.slope = -t.gear.slope * (out.follows - 1);
    out.effort_by_load = t.gear.slope * yields;
    out.increment_by_load = -yields;
    out.increment = u;
    out.motor = out.motor_at_end = t.motor.value;
    if (demand_.surplus != 0)
      out.motor_at_end = effort_at_end(drive_, demand_, with_increment(rotor_.change, u), link_.increment);
    out.demand = demand_.at(u, link_.increment);
    out.dissipated = t.gear.dissipated;
    if (!is_static()) out.dissipated += (slides ? t.capacity * direction.value : -t.without_friction) * u;
    return out;
  }
  bool is_static() const { return link_.step == 0; }
  /// Returns the change of the twist over the step if the rotor's increment is u.
  CoordinateStep twist(double u) const {
    CoordinateStep twist = rotor_.change;
    twist.begin -= link_.begin;
    twist.begin_rate -= link_.begin_rate;
    return with_increment(twist, u - link_.increment);
  }
  double scale() const { return std::max(std::abs(link_.increment), 1e-6); }

  const Drive& drive_;
  const MotorDemand& demand_;
  const RotorStep& rotor_;
  const CoordinateStep& link_;
};

/// The action with Coulomb's law: StickSlip's law in one unknown. Its graph has two vertical parts; the signs of the
/// balance there tell on which part of the graph the solution is.
MotorAction sticking_action(const RotorBalance& balance, const RotorStep& rotor, double guess) {
  assert(rotor.rests || rotor.rate_slope != 0);
  const double rest = rotor.rests ? 0 : -rotor.rate_offset / rotor.rate_slope;
  const double low = std::min(rest, 0.0), high = std::max(rest, 0.0);
  const auto held = [&](double u) {
    MotorAction out = balance.action(u, {}, false);
    out.is_stopped = u == rest;
    return out;
  };
  const auto slipping = [&](double direction) {
    return balance.action(balance.root({direction, 0}, guess), {direction, 0}, true);
  };
  const auto at_low = balance.terms(low), at_high = balance.terms(high);
  if (at_low.without_friction - at_low.capacity > 0) return slipping(-1);
  if (at_high.without_friction + at_high.capacity < 0) return slipping(1);
  // Between its start and its rest, friction does not push the rotor.
  if (low == high || at_low.without_friction >= 0) return held(low);
  if (at_high.without_friction <= 0) return held(high);
  return slipping(0);
}

}  // namespace

MotorRange motor_range(const Drive& drive, double limit, double rate) {
  return {-available(drive, limit, -rate).value, available(drive, limit, rate).value};
}

MotorAction motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                         const CoordinateStep& link, double guess) {
  if (!drive.gear) return rigid_action(drive, demand, rotor, link);
  const RotorBalance balance(drive, demand, rotor, link);
  if (drive.sticks && link.step != 0) return sticking_action(balance, rotor, guess);
  return balance.smooth_action(guess);
}

MotorAction held_motor_action(const Drive& drive, const MotorDemand& demand, const RotorStep& rotor,
                              const CoordinateStep& link) {
  return RotorBalance(drive, demand, rotor, link).action(0, {}, false);
}

}  // namespace flexarm
