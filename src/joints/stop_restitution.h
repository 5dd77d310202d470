#pragma once
/// Computes the damping of a stop for a given coefficient of restitution. (docs/notes/stops.md)

namespace flexarm {

/// Returns the damping ratio for a `restitution` from 0.05 to 1.
double stop_damping_ratio(double restitution);

}  // namespace flexarm
