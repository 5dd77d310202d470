#pragma once
/// Measures how far one motion of a scene is from another one. Runs to an accuracy and the benchmarks use this error.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Positions of a point at equal time intervals, beginning at the start [m].
using Trajectory = std::vector<Vector3>;

/// Largest distance of a point of the trajectory from its first point [m].
double largest_displacement(const Trajectory& trajectory);

/// Root mean square (over time, trapezoidal rule) of the distance from a reference [m].
/// @throws std::invalid_argument unless both trajectories have the same number of points, two or more.
double trajectory_distance(const Trajectory& trajectory, const Trajectory& reference);

/// trajectory_distance() divided by the reference's largest displacement.
/// @throws std::invalid_argument as trajectory_distance(), and if the reference does not move.
double trajectory_error(const Trajectory& trajectory, const Trajectory& reference);

/// The points by whose motion a run is judged: the scene's probes, or the tips of all moving links if it has none.
class JudgedPoints {
 public:
  /// `frame`: the link in whose frame the points are judged; empty: the world.
  /// @throws std::invalid_argument if there is no such link.
  explicit JudgedPoints(const Simulation& simulation, const std::string& frame = {});

  std::size_t size() const { return has_probes_ ? count_ : links_.size(); }
  /// The present positions of the points [m]. The second function overwrites `positions`.
  std::vector<Vector3> positions(const Simulation& simulation) const;
  void positions(const Simulation& simulation, std::vector<Vector3>& positions) const;

 private:
  bool has_probes_;
  std::size_t count_;               // number of probes
  std::vector<std::size_t> links_;  // judged links, if the scene has no probes
  std::optional<std::size_t> frame_;
};

/// Trajectories of all judged points, sampled at the same times.
struct JudgedMotion {
  std::vector<Trajectory> points;

  explicit JudgedMotion(std::size_t count = 0) : points(count) {}
  /// Appends one position for each point.
  /// @throws std::invalid_argument if the number of positions is another one.
  void add(const std::vector<Vector3>& positions);
  /// The largest distance of any point from its start [m].
  double largest_displacement() const;
};

/// Whether all judged points move by less than a millionth of the mechanism's size [m]. That is round-off, or what an
/// equilibrium has left.
bool is_at_rest(const JudgedMotion& motion, double mechanism);
/// The length by which errors of a motion are divided [m]: the largest displacement of a judged point. Of points at
/// rest there is no way of which a part could be asked for, so it is the mechanism's size. (docs/notes/accuracy.md 1)
double length_of_errors(const JudgedMotion& motion, double mechanism);

/// The largest trajectory_distance() of any point [m], divided by `scale` [m].
/// @throws std::invalid_argument unless both motions have the same points and times, and the scale is positive.
double motion_error(const JudgedMotion& motion, const JudgedMotion& reference, double scale);

}  // namespace flexarm
