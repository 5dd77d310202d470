#pragma once
/// Stand-in for the ros_control header of this name.

#include <string>

#include "hardware_interface/internal/hardware_resource_manager.h"

namespace hardware_interface {

class ImuSensorHandle {
 public:
  struct Data {
    Data() {}  // as in the original
    std::string name, frame_id;
    double *orientation = nullptr, *orientation_covariance = nullptr;
    double *angular_velocity = nullptr, *angular_velocity_covariance = nullptr;
    double *linear_acceleration = nullptr, *linear_acceleration_covariance = nullptr;
  };

  ImuSensorHandle(const Data& data = {}) : data_(data) {}
  std::string getName() const { return data_.name; }
  std::string getFrameId() const { return data_.frame_id; }
  const double* getOrientation() const { return data_.orientation; }
  const double* getAngularVelocity() const { return data_.angular_velocity; }
  const double* getLinearAcceleration() const { return data_.linear_acceleration; }

 private:
  Data data_;
};

class ImuSensorInterface : public HardwareResourceManager<ImuSensorHandle> {};

}  // namespace hardware_interface
