#pragma once
/// Stand-in for the ros_control header of this name.

#include <string>

#include "hardware_interface/internal/hardware_resource_manager.h"

namespace hardware_interface {

class JointStateHandle {
 public:
  JointStateHandle() = default;
  JointStateHandle(const std::string& name, const double* position, const double* velocity, const double* effort)
      : name_(name), position_(position), velocity_(velocity), effort_(effort) {
    if (!position || !velocity || !effort) throw HardwareInterfaceException("Cannot create handle '" + name + "'.");
  }
  std::string getName() const { return name_; }
  double getPosition() const { return *position_; }
  double getVelocity() const { return *velocity_; }
  double getEffort() const { return *effort_; }

 private:
  std::string name_;
  const double *position_ = nullptr, *velocity_ = nullptr, *effort_ = nullptr;
};

class JointStateInterface : public HardwareResourceManager<JointStateHandle> {};

}  // namespace hardware_interface
