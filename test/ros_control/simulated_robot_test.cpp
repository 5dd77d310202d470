// Tests the robot that controllers of ros_control see: states, and the effects of commands. The classes of ros_control
// are stand-ins.
#include <cmath>
#include <functional>
#include <limits>
#include <list>
#include <string>

#include <gtest/gtest.h>
#include <ros/time.h>

#include "flexarm/scene/urdf_reader.h"
#include "ros_control/control_loop.h"
#include "ros_control/simulated_robot.h"

namespace flexarm::test {
namespace {

using hardware_interface::ControllerInfo;
using ros_control::ControlLoop;
using ros_control::SimulatedRobot;

constexpr double kStep = 1e-3, kMass = 2;

const char* const kEffort = "hardware_interface::EffortJointInterface";
const char* const kVelocity = "hardware_interface::VelocityJointInterface";
const char* const kPosition = "hardware_interface::PositionJointInterface";
const char* const kPosVel = "hardware_interface::PosVelJointInterface";
const char* const kPosVelAcc = "hardware_interface::PosVelAccJointInterface";

/// Blocks of 2 kg on rails along x, without gravity: `free` has no servo, `driven` a servo with all modes, `held` one
/// for positions, and `led` mimics `free`.
std::string benches() {
  std::string text = "<robot name=\"benches\"><link name=\"world\"/>";
  for (const std::string name : {"free", "driven", "held", "led"})
    text += "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"world\"/><child link=\"" + name +
            "_block\"/><axis xyz=\"1 0 0\"/><limit lower=\"-100\" upper=\"100\" effort=\"0\" velocity=\"0\"/>" +
            (name == "led" ? "<mimic joint=\"held\"/>" : "") + "</joint><link name=\"" + name +
            "_block\"><inertial><mass value=\"2\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" "
            "iyz=\"0\"/></inertial></link>";
  return text +
         "<servo joint=\"driven\" mode=\"position\" kp=\"800\" kd=\"80\"><gains mode=\"velocity\" kp=\"200\"/></servo>"
         "<servo joint=\"held\" mode=\"position\" kp=\"800\" kd=\"80\" set_point=\"0.1\"/>"
         "<sensor name=\"unit\" kind=\"imu\" link=\"free_block\"/>"
         "<sensor name=\"cell\" kind=\"wrench\" link=\"free_block\"/>"
         "<sensor name=\"ground\" kind=\"reaction\" link=\"free_block\"/>"
         "<simulation><gravity xyz=\"0 0 -10\"/><integrator scheme=\"em\" step=\"0.001\" tolerance=\"1e-10\"/>"
         "<initial joint=\"free\" position=\"0.5\" velocity=\"0.25\"/></simulation></robot>";
}

Simulation simulate(const std::string& text) {
  scene::ReadResult result = scene::read_scene_text(text, "benches.urdf");
  if (!result.scene) throw std::runtime_error(scene::to_text(result.diagnostics));
  return Simulation(*std::move(result.scene));
}

ControllerInfo claim(const std::string& interface, const std::string& joint) {
  return {"test", "test/Controller", {{interface, {joint}}}};
}

/// A simulated robot in a control loop with a controller.
struct Rig {
  explicit Rig(int steps = 1)
      : simulation(simulate(benches())),
        robot(simulation),
        loop(robot, steps, [this](const ros::Time& time, const ros::Duration& period, bool restart) {
          last_period = period.toSec();
          restarts += restart;
          if (controller) controller(time.toSec() - kStep);
        }) {}

  /// Claims a joint, as a controller manager does when one controller starts and another one stops.
  bool switch_to(const std::list<ControllerInfo>& started, const std::list<ControllerInfo>& stopped = {}) {
    if (!robot.prepareSwitch(started, stopped)) return false;
    robot.doSwitch(started, stopped);
    return true;
  }
  void run(double seconds) {
    const double end = simulation.time() + seconds - kStep / 2;
    while (simulation.time() < end) ASSERT_TRUE(loop.cycle(ros::Time(simulation.time() + kStep)).converged);
    robot.read({}, {});
  }
  double position(const std::string& joint) const { return simulation.position(*simulation.find_coordinate(joint)); }
  double velocity(const std::string& joint) const { return simulation.velocity(*simulation.find_coordinate(joint)); }
  template <class Interface>
  auto handle(const std::string& joint) {
    return robot.get<Interface>()->getHandle(joint);
  }

  Simulation simulation;
  SimulatedRobot robot;
  double last_period = 0;
  int restarts = 0;
  std::function<void(double time)> controller;  ///< simulation time [s]
  ControlLoop loop;
};

using States = hardware_interface::JointStateInterface;
using Efforts = hardware_interface::EffortJointInterface;
using Velocities = hardware_interface::VelocityJointInterface;
using Positions = hardware_interface::PositionJointInterface;
using MovingPositions = hardware_interface::PosVelJointInterface;
using AcceleratedPositions = hardware_interface::PosVelAccJointInterface;

TEST(SimulatedRobot, StatesAreTheSimulations) {
  Rig rig;
  const auto states = rig.handle<States>("free");
  EXPECT_DOUBLE_EQ(states.getPosition(), 0.5);
  EXPECT_DOUBLE_EQ(states.getVelocity(), 0.25);
  rig.run(0.1);
  for (const std::string& name : rig.simulation.coordinate_names()) {
    const auto state = rig.handle<States>(name);
    const std::size_t coordinate = *rig.simulation.find_coordinate(name);
    EXPECT_EQ(state.getPosition(), rig.simulation.position(coordinate));
    EXPECT_EQ(state.getVelocity(), rig.simulation.velocity(coordinate));
    EXPECT_EQ(state.getEffort(), rig.simulation.effort(coordinate));
  }
  EXPECT_NEAR(states.getPosition(), 0.525, 1e-9);
}

TEST(SimulatedRobot, SensorsMeasureInTheirFrames) {
  Rig rig;
  rig.switch_to({claim(kEffort, "free")});
  rig.controller = [&, effort = rig.handle<Efforts>("free")](double) mutable { effort.setCommand(3); };
  rig.run(0.1);
  const auto imu = rig.robot.get<hardware_interface::ImuSensorInterface>()->getHandle("unit");
  EXPECT_EQ(imu.getFrameId(), "free_block");
  EXPECT_EQ(imu.getOrientation(), nullptr) << "it measures none";
  EXPECT_NEAR(imu.getLinearAcceleration()[0], 3 / kMass, 1e-6);
  EXPECT_NEAR(imu.getLinearAcceleration()[2], 10, 1e-6) << "less gravity";
  EXPECT_NEAR(imu.getAngularVelocity()[1], 0, 1e-9);
  for (const auto& [name, frame] : {std::pair("cell", "free_block"), std::pair("ground", "world")}) {
    const auto cell = rig.robot.get<hardware_interface::ForceTorqueSensorInterface>()->getHandle(name);
    EXPECT_EQ(cell.getFrameId(), frame);
    EXPECT_NEAR(cell.getForce()[0], 3, 1e-6);
    EXPECT_NEAR(cell.getForce()[2], 10 * kMass, 1e-6);
    EXPECT_NEAR(cell.getTorque()[0], 0, 1e-6);
  }
}

TEST(SimulatedRobot, EffortAcceleratesByTheClosedForm) {
  for (const std::string joint : {"free", "driven"})
    for (const int steps : {1, 5}) {
      Rig rig(steps);
      ASSERT_TRUE(rig.switch_to({claim(kEffort, joint)}));
      const double start = rig.position(joint), speed = rig.velocity(joint), time = 0.5;
      rig.controller = [&, effort = rig.handle<Efforts>(joint)](double) mutable { effort.setCommand(6); };
      rig.run(time);
      EXPECT_NEAR(rig.last_period, steps * kStep, 1e-12);
      EXPECT_NEAR(rig.velocity(joint), speed + 6 / kMass * time, 1e-8) << joint << ", steps in a cycle: " << steps;
      EXPECT_NEAR(rig.position(joint), start + speed * time + 3 / kMass * time * time, 1e-8);
      EXPECT_NEAR(rig.handle<States>(joint).getEffort(), 6, 1e-9);
    }
}

TEST(SimulatedRobot, ServoFollowsAPosition) {
  Rig rig;
  ASSERT_TRUE(rig.switch_to({claim(kPosition, "driven")}));
  rig.controller = [&, position = rig.handle<Positions>("driven")](double) mutable { position.setCommand(0.3); };
  rig.run(2);
  EXPECT_NEAR(rig.position("driven"), 0.3, 1e-6);
  EXPECT_NEAR(rig.velocity("driven"), 0, 1e-6);
}

TEST(SimulatedRobot, PositionsAloneLagAndThoseWithRatesDoNot) {
  // The set point is a ramp. The servo's kp e + kd de/dt does not know its rate, so it lags by kd / kp times the
  // velocity.
  Rig rig;
  ASSERT_TRUE(rig.switch_to({claim(kPosition, "driven")}));
  rig.controller = [&, position = rig.handle<Positions>("driven")](double time) mutable { position.setCommand(time); };
  rig.run(3);
  // A cycle uses the command of its beginning. The error is that in the middle of a step.
  EXPECT_NEAR(rig.position("driven"), rig.simulation.time() - kStep / 2 - 80.0 / 800, 1e-6);

  for (const int steps : {1, 4}) {
    Rig other(steps);
    ASSERT_TRUE(other.switch_to({claim(kPosVel, "driven")}));
    other.controller = [&, target = other.handle<MovingPositions>("driven")](double time) mutable {
      target.setCommand(time, 1);
    };
    other.run(3);
    EXPECT_NEAR(other.position("driven"), other.simulation.time(), 1e-6) << "steps in a cycle: " << steps;
  }
}

TEST(SimulatedRobot, PositionsWithRateAndAccelerationMoveOnWithinACycle) {
  for (const int steps : {1, 4}) {
    Rig rig(steps);
    ASSERT_TRUE(rig.switch_to({claim(kPosVelAcc, "driven")}));
    rig.controller = [&, target = rig.handle<AcceleratedPositions>("driven")](double time) mutable {
      target.setCommand(time * time, 2 * time, 2);
    };
    rig.run(3);
    // The remaining error is that of the accelerating force: m a / kp.
    EXPECT_NEAR(rig.position("driven"), std::pow(rig.simulation.time(), 2) - kMass * 2 / 800, 1e-5);
    EXPECT_NEAR(rig.velocity("driven"), 2 * rig.simulation.time(), 1e-5) << "steps in a cycle: " << steps;
  }
}

TEST(SimulatedRobot, SwitchesModesWithoutABumpAndStandsWhenLetGo) {
  Rig rig;
  ASSERT_TRUE(rig.switch_to({claim(kVelocity, "driven")}));
  EXPECT_EQ(rig.simulation.servo_mode(1), ServoMode::Velocity);
  rig.controller = [&, velocity = rig.handle<Velocities>("driven")](double) mutable { velocity.setCommand(0.5); };
  rig.run(1);
  EXPECT_NEAR(rig.velocity("driven"), 0.5, 1e-6);

  // Until its controller commands something, a position servo holds the joint.
  rig.controller = nullptr;
  ASSERT_TRUE(rig.switch_to({claim(kPosition, "driven")}, {claim(kVelocity, "driven")}));
  EXPECT_EQ(rig.simulation.servo_mode(1), ServoMode::Position);
  const double speed = rig.velocity("driven");
  rig.run(kStep);
  EXPECT_NEAR(rig.velocity("driven"), speed, 0.05) << "no bump";
  rig.run(2);
  const double place = rig.position("driven");
  rig.switch_to({}, {claim(kPosition, "driven")});
  rig.run(1);
  EXPECT_NEAR(rig.position("driven"), place, 1e-6) << "let go of, it holds";

  ASSERT_TRUE(rig.switch_to({claim(kVelocity, "driven")}));
  rig.controller = [&, velocity = rig.handle<Velocities>("driven")](double) mutable { velocity.setCommand(0.5); };
  rig.run(1);
  rig.switch_to({}, {claim(kVelocity, "driven")});
  rig.run(1);
  EXPECT_NEAR(rig.velocity("driven"), 0, 1e-6) << "let go of, it stands";

  ASSERT_TRUE(rig.switch_to({claim(kEffort, "free")}));
  rig.controller = [&, effort = rig.handle<Efforts>("free")](double) mutable { effort.setCommand(6); };
  rig.run(0.1);
  rig.switch_to({}, {claim(kEffort, "free")});
  rig.run(0.1);
  EXPECT_EQ(rig.handle<States>("free").getEffort(), 0);
}

TEST(SimulatedRobot, RefusesWhatTheSceneCannotServe) {
  Rig rig;
  const auto fault = [&](const std::string& interface, const std::string& joint) {
    const bool is_possible = rig.robot.prepareSwitch({claim(interface, joint)}, {});
    const std::string text = rig.robot.find_faults(claim(interface, joint));
    EXPECT_EQ(is_possible, text.empty());
    return text;
  };
  EXPECT_EQ(
      fault(kPosition, "free"),
      "controller 'test' claims hardware_interface::PositionJointInterface, but 'free' has no servo: write <servo "
      "joint=\"free\" mode=\"position\" kp=\"...\" .../> into the scene");
  EXPECT_EQ(fault(kVelocity, "held"),
            "controller 'test' claims hardware_interface::VelocityJointInterface, but the servo of 'held' has no gains "
            "of mode 'velocity': write <gains mode=\"velocity\" kp=\"...\" .../> into its <servo>");
  EXPECT_EQ(fault(kEffort, "led"),
            "controller 'test' claims hardware_interface::EffortJointInterface, but 'led' mimics 'held' and takes no "
            "commands of its own: command that one");
  for (const char* interface : {kPosition, kPosVel, kPosVelAcc, kEffort}) EXPECT_EQ(fault(interface, "held"), "");
  EXPECT_EQ(fault("hardware_interface::JointStateInterface", "led"), "");

  // A switch that was not prepared changes nothing.
  rig.robot.doSwitch({claim(kPosition, "free"), claim(kVelocity, "held")}, {});
  EXPECT_EQ(rig.simulation.servo_mode(2), ServoMode::Position);
  rig.run(2);
  EXPECT_NEAR(rig.position("held"), 0.1, 1e-6);
}

TEST(SimulatedRobot, LeavesOutCommandsThatAreNotFinite) {
  Rig rig;
  ASSERT_TRUE(rig.switch_to({claim(kEffort, "free"), claim(kPosVel, "driven")}));
  auto effort = rig.handle<Efforts>("free");
  auto position = rig.handle<MovingPositions>("driven");
  effort.setCommand(6);
  position.setCommand(0.1, 0);
  rig.run(2);
  effort.setCommand(std::numeric_limits<double>::quiet_NaN());
  position.setCommand(0.1, std::numeric_limits<double>::infinity());
  rig.run(0.1);
  EXPECT_NEAR(rig.handle<States>("free").getEffort(), 6, 1e-9) << "the one before holds";
  EXPECT_NEAR(rig.position("driven"), 0.1, 1e-5);
}

TEST(SimulatedRobot, BeginsAgainWithTheSameClaims) {
  Rig rig;
  ASSERT_TRUE(rig.switch_to({claim(kVelocity, "driven")}));
  rig.controller = [&, velocity = rig.handle<Velocities>("driven")](double) mutable { velocity.setCommand(0.5); };
  rig.run(0.5);
  rig.loop.reset();
  EXPECT_EQ(rig.simulation.time(), 0);
  EXPECT_EQ(rig.position("driven"), 0);
  EXPECT_EQ(rig.simulation.servo_mode(1), ServoMode::Velocity);
  EXPECT_EQ(rig.restarts, 0);
  ASSERT_TRUE(rig.loop.cycle(ros::Time(0.6)).converged);
  EXPECT_EQ(rig.restarts, 1);
  ASSERT_TRUE(rig.loop.cycle(ros::Time(0.601)).converged);
  EXPECT_EQ(rig.restarts, 1);
  EXPECT_NEAR(rig.last_period, kStep, 1e-9);
}

}  // namespace
}  // namespace flexarm::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::Time::init();  // for the log
  return RUN_ALL_TESTS();
}
