#pragma once
/// Controllers and simulation in lock step.

#include <ros/duration.h>
#include <ros/time.h>

#include <functional>

#include "flexarm/model/results.h"
#include "ros_control/simulated_robot.h"

namespace flexarm::ros_control {

/// A cycle reads the robot, updates its controllers, writes what they command, and makes the steps until the next one.
class ControlLoop {
 public:
  /// As that of a controller_manager::ControllerManager; `restart`: controllers begin anew.
  using Update = std::function<void(const ros::Time& time, const ros::Duration& period, bool restart)>;

  /// @param steps  of the simulation in each cycle, at least one
  ControlLoop(SimulatedRobot& robot, int steps, Update update);

  /// @param time  simulated, later than in the cycle before
  /// @returns the last step, which has failed if it has not converged
  StepResult cycle(const ros::Time& time);
  /// The simulation is as at its start, and controllers begin anew with the next cycle.
  void reset();
  /// Of simulated time [s].
  double period() const;
  /// That the last cycle has made.
  int steps_made() const { return steps_made_; }

 private:
  SimulatedRobot& robot_;
  int steps_, steps_made_ = 0;
  Update update_;
  ros::Time last_;  ///< zero: there was no cycle yet
  bool restart_ = false;
};

}  // namespace flexarm::ros_control
