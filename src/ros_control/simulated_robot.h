#pragma once
/// A simulation as the hardware (RobotHW) of ros_control's controllers.

#include <hardware_interface/controller_info.h>
#include <hardware_interface/force_torque_sensor_interface.h>
#include <hardware_interface/imu_sensor_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/duration.h>
#include <ros/time.h>

#include <array>
#include <cstddef>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/model/results.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::ros_control {

/// A robot whose joints are the coordinates of a simulation, with the same names, and whose sensors are those of the
/// scene. Commanded positions and velocities become set points of the joint's servo. Commanded efforts go to the servo,
/// or directly to the joint if it has no servo. Only the constructor, prepareSwitch() and checkForConflict() may be
/// called in another thread than the one that steps.
class SimulatedRobot : public hardware_interface::RobotHW {
 public:
  /// @param simulation  must outlive the robot; nothing but step() may step it
  explicit SimulatedRobot(Simulation& simulation);
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  /// Refuses controllers that claim interfaces that the scene cannot serve, and logs the reasons.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& started,
                     const std::list<hardware_interface::ControllerInfo>& stopped) override;
  /// Switches servos to the modes that new controllers claim, without a jump of the effort. A joint whose controller
  /// stops keeps its commanded position; a commanded velocity or effort becomes zero.
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& started,
                const std::list<hardware_interface::ControllerInfo>& stopped) override;
  void read(const ros::Time& time, const ros::Duration& period) override;
  /// Ignores commands that are not finite, and logs an error.
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// Makes one step of the simulation. Set points with rates have moved on since write().
  StepResult step();
  /// Resets the simulation to its initial state; controllers keep their claims.
  void reset();
  Simulation& simulation() { return simulation_; }
  /// Why a controller cannot run with this scene, one line for each joint; empty: it can.
  std::string find_faults(const hardware_interface::ControllerInfo& controller) const;

 private:
  static constexpr std::size_t kInterfaces = 5;
  struct Command {
    double value = 0, rate = 0, acceleration = 0;
  };
  struct Joint {
    double position = 0, velocity = 0, effort = 0;
    std::array<Command, kInterfaces> commands;    ///< the values that controllers write, one for each kind of interface
    std::optional<std::size_t> interface;         ///< kind of the claimed interface, if any
    std::array<std::string, kInterfaces> faults;  ///< why a kind of interface cannot be claimed; empty: it can
  };
  struct Sensor {
    std::size_t index = 0;  ///< in the scene
    std::array<double, 6> values = {};
  };

  void register_joint(std::size_t coordinate);
  void register_sensors();
  std::string find_fault(std::size_t coordinate, std::size_t interface) const;
  /// Calls `act(coordinate, interface)` for each interface that the controllers claim.
  template <class Act>
  void for_claims(const std::list<hardware_interface::ControllerInfo>& controllers, const Act& act) const;
  void take_hold(std::size_t coordinate, std::size_t interface);
  void let_go(std::size_t coordinate);
  /// Hands the command to the joint's servo or, without servo, to the joint.
  void give(std::size_t coordinate, const Command& command);

  Simulation& simulation_;
  std::vector<Joint> joints_;  ///< must not grow, since handles point into it
  std::vector<Sensor> sensors_;
  std::map<std::string, std::size_t> coordinates_;  ///< by name
  double since_write_ = 0;                          ///< time since write(), simulated [s]
  hardware_interface::JointStateInterface states_;
  hardware_interface::EffortJointInterface efforts_;
  hardware_interface::VelocityJointInterface velocities_;
  hardware_interface::PositionJointInterface positions_;
  hardware_interface::PosVelJointInterface moving_positions_;
  hardware_interface::PosVelAccJointInterface accelerated_positions_;
  hardware_interface::ImuSensorInterface imus_;
  hardware_interface::ForceTorqueSensorInterface wrenches_;
};

}  // namespace flexarm::ros_control
