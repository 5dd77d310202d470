#pragma once
/// The topics of sensors.

#include <string>

namespace flexarm::scene {

/// The topic of the sensor with that name, "sensors/NAME". Characters other than letters, digits and _ become _.
std::string sensor_topic(std::string name);

}  // namespace flexarm::scene
