// A PD controller as a node, for control_test.py. At each message of joint_states it commands the effort stiffness (set
// point - position) - damping velocity on every joint. Set points are the first positions plus `~offset`.
#include <flexarm/JointForceCommand.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <vector>

namespace {

class PdController {
 public:
  PdController() {
    const ros::NodeHandle own("~");
    own.getParam("stiffness", stiffness_);  // for each joint [N m/rad]
    own.getParam("damping", damping_);      // for each joint [N m s/rad]
    own.getParam("offset", offset_);
    const ros::TransportHints without_delay = ros::TransportHints().tcpNoDelay();
    commands_ = node_.advertise<flexarm::JointForceCommand>("joint_force_command", 1, /*latch=*/true);
    states_ = node_.subscribe("joint_states", 1, &PdController::control, this, without_delay);
  }

 private:
  void control(const sensor_msgs::JointState& state) {
    if (set_points_.empty())
      for (const double position : state.position) set_points_.push_back(position + offset_);
    flexarm::JointForceCommand command;
    command.names = state.name;
    for (std::size_t i = 0; i < state.name.size(); ++i)
      command.efforts.push_back(stiffness_.at(i) * (set_points_[i] - state.position[i]) -
                                damping_.at(i) * state.velocity[i]);
    commands_.publish(command);
  }

  ros::NodeHandle node_;
  ros::Publisher commands_;
  ros::Subscriber states_;
  std::vector<double> stiffness_, damping_, set_points_;
  double offset_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "pd_controller", ros::init_options::AnonymousName);
  const PdController controller;
  ros::spin();
}
