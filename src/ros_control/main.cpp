/// The node flexarm_ros_control: a simulated arm as the hardware of ros_control's controllers.

#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include <csignal>
#include <exception>

#include "ros_control/ros_control_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "flexarm_ros_control");
  // ROS does the same for SIGINT. Without this, SIGTERM would leave the node registered with the master for ever.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle keeps_ros_alive;  // so that the error of a failed construction still reaches /rosout
  try {
    flexarm::ros_control::RosControlNode node;
    // One thread for the controller manager's services, which wait for cycles, and one for the controllers'
    // subscribers.
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
