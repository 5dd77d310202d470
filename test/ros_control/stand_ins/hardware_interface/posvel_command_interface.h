#pragma once
/// Stand-in for the ros_control header of this name.

#include "hardware_interface/joint_state_interface.h"

namespace hardware_interface {

class PosVelJointHandle : public JointStateHandle {
 public:
  PosVelJointHandle() = default;
  PosVelJointHandle(const JointStateHandle& state, double* position, double* velocity)
      : JointStateHandle(state), position_(position), velocity_(velocity) {}
  void setCommand(double position, double velocity) {
    *position_ = position;
    *velocity_ = velocity;
  }

 private:
  double *position_ = nullptr, *velocity_ = nullptr;
};

class PosVelJointInterface : public HardwareResourceManager<PosVelJointHandle, ClaimResources> {};

}  // namespace hardware_interface
