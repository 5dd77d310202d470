#include "ros_control/control_loop.h"

#include <utility>

namespace flexarm::ros_control {

ControlLoop::ControlLoop(SimulatedRobot& robot, int steps, Update update)
    : robot_(robot), steps_(steps), update_(std::move(update)) {}

StepResult ControlLoop::cycle(const ros::Time& time) {
  // If the last cycle failed half-way, less than a period has passed.
  const ros::Duration since_last = last_.isZero() ? ros::Duration(period()) : time - last_;
  last_ = time;
  robot_.read(time, since_last);
  update_(time, since_last, std::exchange(restart_, false));
  robot_.write(time, since_last);
  StepResult result;
  for (steps_made_ = 0; steps_made_ < steps_; ++steps_made_) {
    result = robot_.step();
    if (!result.converged) break;
  }
  return result;
}

void ControlLoop::reset() {
  robot_.reset();
  restart_ = true;
}

double ControlLoop::period() const {
  return steps_ * robot_.simulation().step_size();
}

}  // namespace flexarm::ros_control
