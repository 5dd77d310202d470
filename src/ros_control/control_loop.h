#pragma once
/// Runs controllers and simulation in lock step.

#include <ros/duration.h>
#include <ros/time.h>

#include <functional>

#include "flexarm/model/results.h"
#include "ros_control/simulated_robot.h"

namespace flexarm::ros_control {

/// A cycle reads the robot, updates the controllers, writes their commands, and steps the simulation to the next cycle.
class ControlLoop {
 public:
  /// The signature of controller_manager::ControllerManager::update(); `restart`: controllers begin anew.
  using Update = std::function<void(const ros::Time& time, const ros::Duration& period, bool restart)>;

  /// @param steps  of the simulation per cycle, at least one
  ControlLoop(SimulatedRobot& robot, int steps, Update update);

  /// @param time  simulated time, later than in the last cycle
  /// @returns the result of the last step; if it has not converged, the cycle has failed
  StepResult cycle(const ros::Time& time);
  /// Resets the simulation to its initial state; controllers begin anew with the next cycle.
  void reset();
  /// Simulated time from one cycle to the next [s].
  double period() const;
  /// Number of steps that the last cycle made.
  int steps_made() const { return steps_made_; }

 private:
  SimulatedRobot& robot_;
  int steps_, steps_made_ = 0;
  Update update_;
  ros::Time last_;  ///< time of the last cycle; zero: there was none yet
  bool restart_ = false;
};

}  // namespace flexarm::ros_control
