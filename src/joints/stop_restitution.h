#pragma once
/// Computes the damping of a stop for a given coefficient of restitution. (docs/notes/stops.md)

namespace flexarm {

/// The most damped hit that there is, of stops and of contacts. Without any restitution the damper would have to be
/// infinitely strong.
constexpr double kLeastRestitution = 0.05;

/// Returns the damping ratio for a `restitution` from 0 to 1. Below kLeastRestitution it is the ratio for that.
double stop_damping_ratio(double restitution);

}  // namespace flexarm
