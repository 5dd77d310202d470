#pragma once
/// Stops of a coordinate: springs and dampers that harden. (docs/notes/stops.md)
///
/// They act on the hardened penetration x = p / (1 - (p/d)^2)^2 of the true one p. Shallow penetrations are their own
/// hardened ones; at p = d the stop gives way no further, whatever presses. With y the mean of both ends of a step,
///   effort = dx/dp (k y + c dp/dt),   energy k x^2 / 2,
/// where dx/dp is the quotient of the increments: work and energy agree exactly, and in x and the rate every hit is
/// that of a linear spring and damper, with their restitution at any speed.

#include "joints/coordinate_step.h"
#include "model/model.h"

namespace flexarm {

/// By which the stops of a coordinate hold while they are touched lightly.
struct StopPenalty {
  double stiffness = 0;    ///< [N/m or N m/rad]
  double damping = 0;      ///< of means of a step [N s/m or N m s/rad]
  double end_damping = 0;  ///< of forces at the end of a step [N s/m or N m s/rad]
};
/// Such that a contact lasts `contact_time` [s] were it without damping, and gives back what LimitStop::damping is for.
StopPenalty stop_penalty(const Coordinate& coordinate, double contact_time);

/// Of both stops.
PassiveEffort stop_effort(const LimitStop& limit, const StopPenalty& penalty, const CoordinateStep& change);
/// One side of a stop at an instant: the penetration, < 0 outside, its rate, and the push per dx/dp, < 0 where the stop
/// would have to pull. Inside and outside by the law of the inside, which is smooth there.
struct StopReach {
  double depth, rate, push;
};
/// `rate` of the coordinate; `at_end`: as CoordinateStep has it.
StopReach stop_reach(const LimitStop& limit, const StopPenalty& penalty, bool is_above, double position, double rate,
                     bool at_end);
/// Elastic energy at `position` [J].
double stop_energy(const LimitStop& limit, const StopPenalty& penalty, double position);
/// Slope of the effort against the rate, at rest at `position` [N s/m or N m s/rad].
double stop_damping(const LimitStop& limit, const StopPenalty& penalty, double position);

/// How much of an update from one position to another a stop allows, 1 where it is far: half the way from the first one
/// to where it gives way no further.
double admissible_part(const LimitStop& limit, double from, double to);
/// True if a whole hit would take fewer than five times `refinement` such steps (eight, where efforts are those at the
/// end): much of its restitution is lost.
bool is_coarse(const LimitStop& limit, const StopPenalty& penalty, const CoordinateStep& change, double refinement = 1);
/// True if the step goes through a part of a hit worth mentioning, which is the smaller the larger `refinement` is;
/// false if the coordinate rests on its stop.
/// `begin_rate` of the coordinate; the mean rate of the step is that of both ends.
bool swings(const LimitStop& limit, const StopPenalty& penalty, const CoordinateStep& change, double begin_rate,
            double refinement = 1);
/// True if, from the beginning of the step alone, the coordinate may come to its stop in it and go through much of what
/// the stop still gives way.
bool is_long_for_a_hit(const LimitStop& limit, const StopPenalty& penalty, const CoordinateStep& change,
                       double begin_rate);

}  // namespace flexarm
