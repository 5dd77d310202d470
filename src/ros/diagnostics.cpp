#include "diagnostics.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/this_node.h>

#include "parameters.h"

namespace flexarm::node {

Diagnostics::Diagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const Simulation& simulation,
                         const RunState& run)
    : report_(simulation, run),
      publisher_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)),
      last_time_(ros::Time::now()) {
  const double period = private_node.param("diagnostic_period", 1.0);
  if (!(period > 0)) throw ParameterError("~diagnostic_period must be above 0 s");
  period_.fromSec(period);
}

void Diagnostics::publish(bool force) {
  const ros::Time now = ros::Time::now();
  const bool is_set_back = now < last_time_;  // else nothing would be sent until ROS time reaches last_time_ again
  if (!force && !is_set_back && now < last_time_ + period_) return;
  last_time_ = now;
  diagnostic_msgs::DiagnosticArray message;
  message.header.stamp = now;
  message.status.resize(1);
  message.status[0].name = ros::this_node::getName().substr(1) + ": simulation";
  message.status[0].hardware_id = "none";
  report_.write(message.status[0]);
  publisher_.publish(message);
}

}  // namespace flexarm::node
