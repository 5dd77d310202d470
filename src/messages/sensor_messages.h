#pragma once
/// Samples of sensors as messages of the usual types.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>

#include <cstddef>
#include <string>
#include <variant>

#include <flexarm/StrainStamped.h>

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

using SensorMessage =
    std::variant<geometry_msgs::WrenchStamped, sensor_msgs::Imu, geometry_msgs::PoseStamped, StrainStamped>;

/// The last sample of a sensor: forces of a section or in a link's axes stand in that link's frame (those of a section
/// in its own axes, with which the link's agree at the beginning of a straight beam), reactions and poses in the
/// root's, what an inertial unit measures in its own axes at the frame of its link.
SensorMessage sensor_message(const Simulation& simulation, std::size_t sensor, const ros::Time& stamp,
                             const std::string& frame_prefix);

}  // namespace flexarm::messages
