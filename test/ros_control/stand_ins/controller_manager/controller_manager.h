#pragma once
/// Stand-in for the ros_control header of this name: a single controller, which commands `~test_effort` to all joints.

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>

namespace controller_manager {

class ControllerManager {
 public:
  explicit ControllerManager(hardware_interface::RobotHW* robot, const ros::NodeHandle& = ros::NodeHandle())
      : robot_(robot), efforts_(*robot->get<hardware_interface::EffortJointInterface>()) {
    ros::NodeHandle("~").getParam("test_effort", effort_);
  }

  void update(const ros::Time&, const ros::Duration&, bool = false) {
    for (const std::string& name : efforts_.getNames()) efforts_.getHandle(name).setCommand(effort_);
    if (has_begun_) return;
    has_begun_ = true;
    const hardware_interface::ControllerInfo info{
        "test", "test", {{"hardware_interface::EffortJointInterface", efforts_.getClaims()}}};
    if (robot_->prepareSwitch({info}, {})) robot_->doSwitch({info}, {});
  }

 private:
  hardware_interface::RobotHW* robot_;
  hardware_interface::EffortJointInterface& efforts_;
  double effort_ = 0;
  bool has_begun_ = false;
};

}  // namespace controller_manager
