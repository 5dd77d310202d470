#pragma once
/// The node's services: ~pause, ~resume, ~reset, ~reset_with_clock, ~reload, ~step; ~save_state, ~load_state,
/// ~set_joint_state; ~switch_mode; ~apply_wrench, ~clear_wrenches; ~attach, ~detach, ~spawn, ~delete.

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <optional>
#include <string>
#include <vector>

#include "step_service.h"

namespace flexarm::node {

class Node;

class Services {
 public:
  Services(ros::NodeHandle& private_node, Node& simulator);

  std::vector<std::string> names() const;

 private:
  std::vector<ros::ServiceServer> servers_;
  std::optional<StepService> step_service_;
};

}  // namespace flexarm::node
