#pragma once
/// Computes set points of joints that follow trajectories. Uses neither ROS nor the simulation.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "renumbering.h"

namespace flexarm::node {

/// Times, which are sums, count as equal if they differ by less than this [s].
constexpr double kTimeRoundOff = 1e-9;

/// Motion of a joint at an instant [rad or m; per s; per s^2].
struct JointPoint {
  double position = 0, velocity = 0, acceleration = 0;
};

/// Points through which joints move, as in trajectory_msgs/JointTrajectory.
struct JointTrajectory {
  struct Point {
    double time = 0;                                           ///< from the start [s]
    std::vector<double> positions, velocities, accelerations;  ///< per joint; velocities and accelerations may be empty
  };
  std::vector<std::size_t> joints;
  double start = 0;  ///< [s]
  std::vector<Point> points;
};

/// The path of one joint over time: consecutive polynomials. The joint rests before the first and after the last one.
class JointSpline {
 public:
  explicit JointSpline(double position) : rest_(position) {}

  /// Removes everything after `end` [s]. Returns the joint's motion at `end`.
  JointPoint cut(double end);
  /// Removes what is over at `time` [s]. at() must not be called for earlier times any more.
  void forget_before(double time);
  std::size_t piece_count() const { return pieces_.size(); }
  /// Which values a polynomial matches at both ends: positions (degree 1), velocities as well (3), accelerations as
  /// well (5).
  enum class Order { Position, Velocity, Acceleration };
  /// Appends a polynomial from `from` at time `begin` to `to` at time `end`.
  void add(double begin, const JointPoint& from, double end, const JointPoint& to, Order order);
  /// Appends a constant deceleration from `from` to rest.
  void add_stop(double begin, const JointPoint& from, double duration);
  JointPoint at(double time) const;
  /// Time from which the joint rests [s].
  double end() const { return pieces_.empty() ? 0 : pieces_.back().begin + pieces_.back().duration; }
  bool is_moving(double time) const { return !pieces_.empty() && time < end(); }

 private:
  struct Piece {
    double begin, duration;
    std::array<double, 6> coefficients;  // of powers of the time since `begin`, in ascending order
    JointPoint at(double since) const;
  };
  std::vector<Piece> pieces_;
  double rest_;  // position before the first piece
};

/// The paths of all joints. A joint that follows no trajectory can take other commands.
class TrajectoryFollower {
 public:
  explicit TrajectoryFollower(std::size_t joints) : joints_(joints) {}

  /// Why the trajectory cannot be followed, or an empty string.
  std::string find_fault(const JointTrajectory& trajectory) const;
  /// Whether no point of a valid trajectory is later than `now` [s].
  static bool is_over(const JointTrajectory& trajectory, double now);
  /// Follows a valid trajectory that is not over. It begins at its start time, or at `now` if that is later. Joints
  /// move without a jump from their present path to the first point after the beginning. Until the beginning, they
  /// continue on their present path; other joints are not affected. `set_points`: positions of joints that follow no
  /// trajectory yet, one for each joint of the trajectory.
  void follow(const JointTrajectory& trajectory, double now, const std::vector<double>& set_points);
  /// Decelerates a joint that follows a trajectory to rest, over `duration` [s].
  void stop(std::size_t joint, double now, double duration);
  /// Stops following for a joint at once.
  void release(std::size_t joint) { joints_[joint].follows = false; }
  /// Stops following for joints that have arrived.
  void release_arrived(double time);
  /// Frees the memory of what is over at `time` [s]. at() must not be called for earlier times any more.
  void forget_before(double time);

  bool follows(std::size_t joint) const { return joints_[joint].follows; }
  /// Set point of a joint that follows a trajectory.
  JointPoint at(std::size_t joint, double time) const { return joints_[joint].way.at(time); }
  /// Time at which the joint arrives [s].
  double end(std::size_t joint) const { return joints_[joint].way.end(); }
  std::size_t joint_count() const { return joints_.size(); }
  /// Number of polynomials of a joint's path that are kept.
  std::size_t piece_count(std::size_t joint) const { return joints_[joint].way.piece_count(); }
  /// To be called when links have come or gone, so that there are `count` joints. Those that stay go on.
  void renumber(const Renumbering::Places& joints, std::size_t count);

 private:
  struct Joint {
    bool follows = false;
    JointSpline way{0};
  };
  std::vector<Joint> joints_;
};

}  // namespace flexarm::node
