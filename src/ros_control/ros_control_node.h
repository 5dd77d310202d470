#pragma once
/// A node whose simulation is moved by controllers of ros_control.

#include <controller_manager/controller_manager.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <chrono>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "ros/clock_publisher.h"
#include "ros/parameters.h"
#include "ros/run_state.h"
#include "ros_control/control_loop.h"
#include "ros_control/simulated_robot.h"
#include "stepping/pacer.h"

namespace flexarm::ros_control {

/// Simulated time is /clock. The thread that calls run() makes the cycles, and serves ~pause, ~resume and ~reset
/// between them. The services of the controller manager, which wait for cycles, and the callbacks of controllers need
/// other threads.
class RosControlNode {
 public:
  /// Reads parameters and scene.
  /// @throws node::ParameterError, ModelError if they cannot be used
  RosControlNode();
  RosControlNode(const RosControlNode&) = delete;
  RosControlNode& operator=(const RosControlNode&) = delete;

  /// Makes cycles and serves the node's services until ROS shuts down.
  void run();

 private:
  void advertise_services();
  /// Makes a cycle if it is due. @returns how long to wait for the next one [s]
  double cycle_if_due();
  void cycle();
  void fail(const StepResult& result);
  /// @throws std::runtime_error if the simulation was paused by a failure, and fails again in the next cycle
  void resume();

  ros::NodeHandle node_, private_node_{"~"};
  node::Parameters parameters_;
  int steps_per_cycle_;
  Simulation simulation_;
  node::RunState run_;
  node::ClockPublisher clock_;
  SimulatedRobot robot_;
  controller_manager::ControllerManager manager_;
  ControlLoop loop_;
  node::Pacer pacer_;
  std::chrono::steady_clock::time_point last_look_;  ///< when the wall clock was read last
  ros::CallbackQueue own_queue_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace flexarm::ros_control
