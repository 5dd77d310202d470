#pragma once
/// Stand-in for the ros_control header of this name.

#include <ros/duration.h>
#include <ros/time.h>

#include <list>
#include <map>
#include <typeindex>
#include <typeinfo>

#include "hardware_interface/controller_info.h"

namespace hardware_interface {

class RobotHW {
 public:
  virtual ~RobotHW() = default;
  template <class Interface>
  void registerInterface(Interface* interface) {
    interfaces_[typeid(Interface)] = interface;
  }
  template <class Interface>
  Interface* get() {
    const auto found = interfaces_.find(typeid(Interface));
    return found == interfaces_.end() ? nullptr : static_cast<Interface*>(found->second);
  }
  virtual bool prepareSwitch(const std::list<ControllerInfo>&, const std::list<ControllerInfo>&) { return true; }
  virtual void doSwitch(const std::list<ControllerInfo>&, const std::list<ControllerInfo>&) {}
  virtual void read(const ros::Time&, const ros::Duration&) {}
  virtual void write(const ros::Time&, const ros::Duration&) {}

 private:
  std::map<std::type_index, void*> interfaces_;
};

}  // namespace hardware_interface
