#pragma once
/// Stand-in for the ros_control header of this name.

#include <set>
#include <string>
#include <vector>

namespace hardware_interface {

struct InterfaceResources {
  std::string hardware_interface;
  std::set<std::string> resources;
};

struct ControllerInfo {
  std::string name, type;
  std::vector<InterfaceResources> claimed_resources;
};

}  // namespace hardware_interface
