#pragma once
/// Stand-in for the ros_control header of this name.

#include "hardware_interface/joint_state_interface.h"

namespace hardware_interface {

class JointHandle : public JointStateHandle {
 public:
  JointHandle() = default;
  JointHandle(const JointStateHandle& state, double* command) : JointStateHandle(state), command_(command) {
    if (!command) throw HardwareInterfaceException("Cannot create handle '" + state.getName() + "'.");
  }
  void setCommand(double command) { *command_ = command; }
  double getCommand() const { return *command_; }

 private:
  double* command_ = nullptr;
};

class JointCommandInterface : public HardwareResourceManager<JointHandle, ClaimResources> {};
class EffortJointInterface : public JointCommandInterface {};
class VelocityJointInterface : public JointCommandInterface {};
class PositionJointInterface : public JointCommandInterface {};

}  // namespace hardware_interface
