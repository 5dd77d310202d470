/// The ROS node: a simulated arm that looks like a real one on the graph.

#include <ros/ros.h>

#include <exception>

#include "node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "flexarm");
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
