#pragma once
/// Stand-in for the ros_control header of this name.

#include <map>
#include <string>
#include <vector>

#include "hardware_interface/hardware_interface.h"

namespace hardware_interface {

struct ClaimResources {
  static void claim(HardwareInterface& hardware, const std::string& name) { hardware.claim(name); }
};
struct DontClaimResources {
  static void claim(HardwareInterface&, const std::string&) {}
};

template <class Handle, class ClaimPolicy = DontClaimResources>
class HardwareResourceManager : public HardwareInterface {
 public:
  void registerHandle(const Handle& handle) { handles_[handle.getName()] = handle; }
  Handle getHandle(const std::string& name) {
    const auto handle = handles_.find(name);
    if (handle == handles_.end()) throw HardwareInterfaceException("Could not find resource '" + name + "'.");
    ClaimPolicy::claim(*this, name);
    return handle->second;
  }
  std::vector<std::string> getNames() const {
    std::vector<std::string> names;
    for (const auto& [name, handle] : handles_) names.push_back(name);
    return names;
  }

 private:
  std::map<std::string, Handle> handles_;
};

}  // namespace hardware_interface
