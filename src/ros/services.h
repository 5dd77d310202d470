#pragma once
/// ~pause, ~resume, ~reset and ~step.

#include <flexarm/Step.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Empty.h>

namespace flexarm::node {

class Node;

class Services {
 public:
  Services(ros::NodeHandle& private_node, Node& simulator);
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

 private:
  bool pause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool resume(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool step(Step::Request& request, Step::Response& response);

  Node& simulator_;
  ros::ServiceServer pause_server_, resume_server_, reset_server_, step_server_;
};

}  // namespace flexarm::node
