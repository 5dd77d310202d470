#pragma once
/// Stand-in for the ros_control header of this name.

#include "hardware_interface/posvel_command_interface.h"

namespace hardware_interface {

class PosVelAccJointHandle : public PosVelJointHandle {
 public:
  PosVelAccJointHandle() = default;
  PosVelAccJointHandle(const JointStateHandle& state, double* position, double* velocity, double* acceleration)
      : PosVelJointHandle(state, position, velocity), acceleration_(acceleration) {}
  void setCommand(double position, double velocity, double acceleration) {
    PosVelJointHandle::setCommand(position, velocity);
    *acceleration_ = acceleration;
  }

 private:
  double* acceleration_ = nullptr;
};

class PosVelAccJointInterface : public HardwareResourceManager<PosVelAccJointHandle, ClaimResources> {};

}  // namespace hardware_interface
