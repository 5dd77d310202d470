#pragma once
/// What a simulation looks like to the controllers of ros_control.

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

/// A robot whose joints are the coordinates of a simulation, under their names, and whose sensors are those of the
/// scene. Positions and velocities are set points of the joint's servo; efforts go to the joint, through its servo
/// where it has one. All but the constructor, prepareSwitch() and checkForConflict() belongs to the thread that steps.
class SimulatedRobot : public hardware_interface::RobotHW {
 public:
  /// @param simulation  outlives the robot, and is stepped by step() alone
  explicit SimulatedRobot(Simulation& simulation);
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  /// Refuses controllers that claim what the scene cannot serve, and says why.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& started,
                     const std::list<hardware_interface::ControllerInfo>& stopped) override;
  /// Switches servos to the modes that are claimed, without a bump. A joint that is let go of stands: its position
  /// stays commanded as it was, its velocity or effort becomes zero.
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& started,
                const std::list<hardware_interface::ControllerInfo>& stopped) override;
  void read(const ros::Time& time, const ros::Duration& period) override;
  /// Commands that are not finite are left out, with an error.
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// One step of the simulation. Set points that have rates move on since write().
  StepResult step();
  /// The simulation is as at its start; what is claimed stays so.
  void reset();
  Simulation& simulation() { return simulation_; }
  /// Why a controller cannot run on this scene, one line for each joint; empty: it can.
  std::string find_faults(const hardware_interface::ControllerInfo& controller) const;

 private:
  static constexpr std::size_t kInterfaces = 5;
  struct Command {
    double value = 0, rate = 0, acceleration = 0;
  };
  struct Joint {
    double position = 0, velocity = 0, effort = 0;
    std::array<Command, kInterfaces> commands;    ///< what controllers write, for each interface
    std::optional<std::size_t> interface;         ///< that is claimed
    std::array<std::string, kInterfaces> faults;  ///< why an interface cannot be claimed; empty: it can
  };
  struct Sensor {
    std::size_t index = 0;  ///< in the scene
    std::array<double, 6> values = {};
  };

  void register_joint(std::size_t coordinate);
  void register_sensors();
  std::string find_fault(std::size_t coordinate, std::size_t interface) const;
  /// Calls `act(coordinate, interface)` for all that controllers claim.
  template <class Act>
  void for_claims(const std::list<hardware_interface::ControllerInfo>& controllers, const Act& act) const;
  void take_hold(std::size_t coordinate, std::size_t interface);
  void let_go(std::size_t coordinate);
  /// To the servo, or to the joint.
  void give(std::size_t coordinate, const Command& command);

  Simulation& simulation_;
  std::vector<Joint> joints_;  ///< never grows: handles point into it
  std::vector<Sensor> sensors_;
  std::map<std::string, std::size_t> coordinates_;  ///< by their names
  double since_write_ = 0;                          ///< simulated [s]
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
