#pragma once
/// Stand-in for the ros_control header of this name: the parts that src/ros_control uses, for tests.

#include <exception>
#include <set>
#include <string>
#include <utility>

namespace hardware_interface {

class HardwareInterface {
 public:
  virtual ~HardwareInterface() = default;
  virtual void claim(std::string resource) { claims_.insert(std::move(resource)); }
  void clearClaims() { claims_.clear(); }
  std::set<std::string> getClaims() const { return claims_; }

 private:
  std::set<std::string> claims_;
};

class HardwareInterfaceException : public std::exception {
 public:
  explicit HardwareInterfaceException(std::string message) : message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

}  // namespace hardware_interface
