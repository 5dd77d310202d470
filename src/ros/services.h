#pragma once
/// ~pause, ~resume, ~reset, ~reset_with_clock, ~reload, ~step; ~save_state, ~load_state, ~set_joint_state;
/// ~switch_mode; ~apply_wrench, ~clear_wrenches.

#include <flexarm/ApplyWrench.h>
#include <flexarm/LoadState.h>
#include <flexarm/SaveState.h>
#include <flexarm/SetJointState.h>
#include <flexarm/Step.h>
#include <flexarm/SwitchMode.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <string>
#include <vector>

namespace flexarm::node {

class Node;

class Services {
 public:
  Services(ros::NodeHandle& private_node, Node& simulator);
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  std::vector<std::string> names() const;

 private:
  bool pause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool resume(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool reset_with_clock(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool reload(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  bool save_state(SaveState::Request& request, SaveState::Response& response);
  bool load_state(LoadState::Request& request, LoadState::Response& response);
  bool set_joint_state(SetJointState::Request& request, SetJointState::Response& response);
  bool switch_mode(SwitchMode::Request& request, SwitchMode::Response& response);
  bool apply_wrench(ApplyWrench::Request& request, ApplyWrench::Response& response);
  bool clear_wrenches(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  Node& simulator_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace flexarm::node
