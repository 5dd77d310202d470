/// The ROS node: simulates an arm, with the topics, services and actions that a real arm would have.

#include <ros/console.h>
#include <ros/init.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "node.h"

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // so that lines reach a pipe at once, too
  ros::init(argc, argv, "flexarm");
  // ROS does the same for SIGINT. Without this, SIGTERM would leave the node registered with the master for ever.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle keeps_ros_alive;  // so that the error of a failed construction still reaches /rosout
  try {
    flexarm::node::Node node;
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
