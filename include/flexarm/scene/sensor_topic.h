#pragma once
/// Under which topic a sensor publishes.

#include <string>

namespace flexarm::scene {

/// The topic of a sensor of that name, "sensors/NAME"; other characters than letters, digits and _ become _.
std::string sensor_topic(std::string name);

}  // namespace flexarm::scene
