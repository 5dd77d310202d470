/// The ROS node: a simulated arm that looks like a real one on the graph.

#include <ros/console.h>
#include <ros/init.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "node.h"

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // who reads a pipe is told at once, too
  ros::init(argc, argv, "flexarm");
  // As ROS does with SIGINT: otherwise the node would stay registered with the master for ever.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle keeps_ros_alive;  // beyond a failed construction: its message is to go out
  try {
    flexarm::node::Node node;
    ros::spin();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
