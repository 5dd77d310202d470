#pragma once
/// Set points of joints that follow trajectories. Knows neither ROS nor the simulation.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace flexarm::node {

/// Times that are sums are equal if they differ by less than this [s].
constexpr double kTimeRoundOff = 1e-9;

/// Of a joint at an instant [rad or m; over s; over s^2].
struct JointPoint {
  double position = 0, velocity = 0, acceleration = 0;
};

/// Points that joints are to pass, as trajectory_msgs/JointTrajectory has them.
struct JointTrajectory {
  struct Point {
    double time = 0;                                           ///< from the start [s]
    std::vector<double> positions, velocities, accelerations;  ///< per joint; velocities and accelerations may be empty
  };
  std::vector<std::size_t> joints;
  double start = 0;  ///< [s]
  std::vector<Point> points;
};

/// A joint's way as polynomials of time, one after the other; it rests before them and after them.
class JointSpline {
 public:
  explicit JointSpline(double position) : rest_(position) {}

  /// Forgets what would come after `end` [s]; where the joint is then.
  JointPoint cut(double end);
  /// Goes on by a polynomial from `from` at `begin` to `to` at `end`: of degree 5 with accelerations, 3 with velocities
  /// alone, else 1.
  enum class Order { Position, Velocity, Acceleration };
  void add(double begin, const JointPoint& from, double end, const JointPoint& to, Order order);
  /// Goes on at a constant deceleration from `from` to a stand.
  void add_stop(double begin, const JointPoint& from, double duration);
  JointPoint at(double time) const;
  /// Where it rests from then on [s].
  double end() const { return pieces_.empty() ? 0 : pieces_.back().begin + pieces_.back().duration; }
  bool is_moving(double time) const { return !pieces_.empty() && time < end(); }

 private:
  struct Piece {
    double begin, duration;
    std::array<double, 6> coefficients;  // of powers of the time since `begin`
    JointPoint at(double since) const;
  };
  std::vector<Piece> pieces_;
  double rest_;  // position before the first piece
};

/// The ways of all joints. A joint without a way takes other commands.
class TrajectoryFollower {
 public:
  explicit TrajectoryFollower(std::size_t joints) : joints_(joints) {}

  /// Why the trajectory cannot be followed, or nothing.
  std::string find_fault(const JointTrajectory& trajectory) const;
  /// Whether one that has no fault has a point later than `now` [s].
  static bool is_over(const JointTrajectory& trajectory, double now);
  /// Follows a trajectory that has no fault and is not over. It begins at its start, or `now` if that is past: its
  /// joints move from where they should be then to the first point after that, without a jump. Until then they go on as
  /// before; other joints always do. `set_points`: where joints rest that follow nothing, one for each joint of the
  /// trajectory.
  void follow(const JointTrajectory& trajectory, double now, const std::vector<double>& set_points);
  /// Lets a joint that follows a trajectory decelerate for that time [s] and stop.
  void stop(std::size_t joint, double now, double duration);
  /// Stops following for a joint at once.
  void release(std::size_t joint) { joints_[joint].follows = false; }
  /// Stops following for joints that have arrived.
  void release_arrived(double time);

  bool follows(std::size_t joint) const { return joints_[joint].follows; }
  /// Of a joint that follows a trajectory.
  JointPoint at(std::size_t joint, double time) const { return joints_[joint].way.at(time); }
  /// When it has arrived [s].
  double end(std::size_t joint) const { return joints_[joint].way.end(); }
  std::size_t joint_count() const { return joints_.size(); }
  /// Others came behind them, or the last went.
  void resize(std::size_t joints) { joints_.resize(joints); }

 private:
  struct Joint {
    bool follows = false;
    JointSpline way{0};
  };
  std::vector<Joint> joints_;
};

}  // namespace flexarm::node
