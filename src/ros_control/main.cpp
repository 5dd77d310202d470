/// A node whose simulated arm is the hardware of ros_control.

#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include <csignal>
#include <exception>

#include "ros_control/ros_control_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "flexarm_ros_control");
  // As ROS does with SIGINT: otherwise the node would stay registered with the master for ever.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle keeps_ros_alive;  // beyond a failed construction: its message is to go out
  try {
    flexarm::ros_control::RosControlNode node;
    // One for the controller manager's services, which wait for cycles; one for what controllers listen to.
    ros::AsyncSpinner others(2);
    others.start();
    node.run();
    others.stop();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
