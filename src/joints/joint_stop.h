#pragma once
/// Stops of a coordinate: springs and dampers that harden with penetration. (docs/notes/stops.md)
///
/// Let p be the penetration and d its upper bound. Spring and damper act on the hardened penetration x = p / (1 -
/// (p/d)^2)^2. For small p, x equals p; towards p = d it grows without bound, so that no effort can press deeper. With
/// y the mean of x at both ends of a step,
///   effort = dx/dp (k y + c dp/dt),   energy k x^2 / 2,
/// where dx/dp is the quotient of the increments. So work and energy agree exactly. In terms of x and the rate, every
/// hit is that of a linear spring and damper, with the same restitution at all speeds. At an instant the effort is the
/// limit of that for short steps. It never pulls.

#include "joints/coordinate_step.h"
#include "model/model.h"

namespace flexarm {

/// Returns the effort of both stops on the coordinate. With CoordinateStep::blur the damper takes hold over the way
/// that the coordinate makes in that time, so that the effort does not jump at touch; the impulse is the same.
PassiveEffort stop_effort(const LimitStop& limit, const CoordinateStep& change);
/// One side of a stop at an instant: the penetration (< 0 outside), its rate, and the push divided by dx/dp (< 0 if the
/// stop would have to pull). The law for penetrations > 0 is also used outside, so all of these are smooth at touch.
/// The stop acts where depth and push are > 0.
struct StopReach {
  double depth, rate, push;
};
/// `rate`: of the coordinate.
StopReach stop_reach(const LimitStop& limit, bool is_above, double position, double rate);
/// What one side of a stop does. Released: penetrated, but it would have to pull.
enum class StopStage : char { Out, In, Released };
inline StopStage stop_stage(const StopReach& reach) {
  return reach.depth <= 0 ? StopStage::Out : reach.push > 0 ? StopStage::In : StopStage::Released;
}
/// > 0 as long as a stage lasts, and 0 where it ends. Released also ends where the depth is 0.
inline double stop_guard(StopStage stage, const StopReach& now) {
  return stage == StopStage::Out ? -now.depth : stage == StopStage::In ? now.push : -now.push;
}
/// How long an undamped hit lasts [s].
double hit_time(const LimitStop& limit);
/// Returns the elastic energy at `position` [J].
double stop_energy(const LimitStop& limit, double position);
/// Returns the damping coefficient at rest at `position`: minus the derivative of the effort with respect to the rate
/// [N s/m or N m s/rad].
double stop_damping(const LimitStop& limit, double position);

/// Returns the part of an update from one position to another that the stops allow; 1 if they are far. An update may go
/// at most half of the way from the present penetration (or the touch) to the largest one.
double admissible_part(const LimitStop& limit, double from, double to);
/// Whether a whole hit would take fewer than five times `refinement` steps of this length (eight times, for efforts at
/// the end of the step). The restitution would then be wrong.
bool is_coarse(const LimitStop& limit, const CoordinateStep& change, double refinement = 1);
/// Whether the step covers a considerable part of a hit; the limit is inversely proportional to `refinement`. False if
/// the coordinate rests on its stop. `begin_rate`: of the coordinate; the rate at the end follows from the mean rate of
/// the step.
bool swings(const LimitStop& limit, const CoordinateStep& change, double begin_rate, double refinement = 1);
/// Whether, judged by the beginning of the step alone, the coordinate may reach its stop within the step and cross much
/// of the remaining way to the largest penetration.
bool is_long_for_a_hit(const LimitStop& limit, const CoordinateStep& change, double begin_rate);

}  // namespace flexarm
