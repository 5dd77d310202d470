#pragma once
/// ROS topics of sensors.

#include <string>

namespace flexarm::scene {

/// Returns the topic "sensors/NAME" of the sensor with that name. Characters other than letters, digits and _ become _.
std::string sensor_topic(std::string name);

}  // namespace flexarm::scene
