#pragma once
/// Makes messages of sensors' samples, with standard types where possible.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>

#include <cstddef>
#include <string>
#include <variant>

#include <flexarm/StrainStamped.h>
#include <flexarm/TendonStamped.h>

#include "flexarm/simulation/simulation.h"

namespace flexarm::messages {

using SensorMessage = std::variant<geometry_msgs::WrenchStamped, sensor_msgs::Imu, geometry_msgs::PoseStamped,
                                   geometry_msgs::TwistStamped, StrainStamped, TendonStamped>;

/// The last sample of a sensor. The frame of the message depends on the kind of sensor:
/// - forces in a section or in a link's axes: the link's frame. Forces in a section have the section's axes, which are
///   the link's axes only at the beginning of a straight beam.
/// - reactions, poses and twists: the root link's frame
/// - lines: the link's frame of the first guide
/// - inertial units: the link's frame; values have the unit's own axes
SensorMessage sensor_message(const Simulation& simulation, std::size_t sensor, const ros::Time& stamp,
                             const std::string& frame_prefix);

}  // namespace flexarm::messages
