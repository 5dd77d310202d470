#include "ros_control/simulated_robot.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/command_refusal.h"

namespace flexarm::ros_control {
namespace {

using Controllers = std::list<hardware_interface::ControllerInfo>;

/// Index into Joint::commands and kCommandInterfaces.
enum InterfaceIndex : std::size_t { kEffort, kVelocity, kPosition, kPositionVelocity, kPositionVelocityAcceleration };
struct CommandInterfaceRow {
  const char* name;
  ServoMode mode;
};
constexpr CommandInterfaceRow kCommandInterfaces[] = {
    {"hardware_interface::EffortJointInterface", ServoMode::Effort},
    {"hardware_interface::VelocityJointInterface", ServoMode::Velocity},
    {"hardware_interface::PositionJointInterface", ServoMode::Position},
    {"hardware_interface::PosVelJointInterface", ServoMode::Position},
    {"hardware_interface::PosVelAccJointInterface", ServoMode::Position},
};

std::optional<std::size_t> command_interface_called(const std::string& name) {
  for (std::size_t i = 0; i < std::size(kCommandInterfaces); ++i)
    if (kCommandInterfaces[i].name == name) return i;
  return std::nullopt;
}

const scene::ServoDescription* servo_described(const scene::SceneDescription& scene, const std::string& coordinate) {
  const auto servo = std::find_if(scene.servos.begin(), scene.servos.end(),
                                  [&](const scene::ServoDescription& one) { return one.coordinate == coordinate; });
  return servo == scene.servos.end() ? nullptr : &*servo;
}

bool has_gains(const scene::ServoDescription& servo, ServoMode mode) {
  return servo.mode == mode ||
         std::any_of(servo.other_modes.begin(), servo.other_modes.end(),
                     [&](const scene::ServoDescription::Gains& gains) { return gains.mode == mode; });
}

}  // namespace

SimulatedRobot::SimulatedRobot(Simulation& simulation)
    : simulation_(simulation), joints_(simulation.coordinate_names().size()) {
  for (std::size_t coordinate = 0; coordinate < joints_.size(); ++coordinate) register_joint(coordinate);
  register_sensors();
  registerInterface(&states_);
  registerInterface(&efforts_);
  registerInterface(&velocities_);
  registerInterface(&positions_);
  registerInterface(&moving_positions_);
  registerInterface(&accelerated_positions_);
  registerInterface(&imus_);
  registerInterface(&wrenches_);
  read({}, {});
}

void SimulatedRobot::register_joint(std::size_t coordinate) {
  const std::string& name = simulation_.coordinate_names()[coordinate];
  coordinates_[name] = coordinate;
  Joint& joint = joints_[coordinate];
  const hardware_interface::JointStateHandle state(name, &joint.position, &joint.velocity, &joint.effort);
  states_.registerHandle(state);
  // Joints that cannot be commanded get handles, too, so that prepareSwitch() can say why.
  for (std::size_t i = 0; i < kInterfaces; ++i) joint.faults[i] = find_fault(coordinate, i);
  auto& commands = joint.commands;
  efforts_.registerHandle({state, &commands[kEffort].value});
  velocities_.registerHandle({state, &commands[kVelocity].value});
  positions_.registerHandle({state, &commands[kPosition].value});
  moving_positions_.registerHandle({state, &commands[kPositionVelocity].value, &commands[kPositionVelocity].rate});
  Command& accelerated = commands[kPositionVelocityAcceleration];
  accelerated_positions_.registerHandle({state, &accelerated.value, &accelerated.rate, &accelerated.acceleration});
}

void SimulatedRobot::register_sensors() {
  const scene::SceneDescription& scene = simulation_.scene();
  const auto is_wrench = [](scene::SensorKind kind) {
    return scene::traits_of(kind).place == scene::SensedPlace::Joint;
  };
  for (std::size_t index = 0; index < scene.sensors.size(); ++index)
    if (scene.sensors[index].kind == scene::SensorKind::Imu || is_wrench(scene.sensors[index].kind))
      sensors_.push_back({index});
  for (Sensor& entry : sensors_) {
    const scene::Sensor& sensor = scene.sensors[entry.index];
    double* const values = entry.values.data();
    if (is_wrench(sensor.kind)) {
      const bool in_world = scene::traits_of(sensor.kind).in_world;
      wrenches_.registerHandle({sensor.name, in_world ? scene.root_link : sensor.link, values, values + 3});
    } else {
      hardware_interface::ImuSensorHandle::Data data;  // covariances are unknown, and orientation is not measured
      data.name = sensor.name;
      data.frame_id = sensor.link;
      data.angular_velocity = values;
      data.linear_acceleration = values + 3;
      imus_.registerHandle(hardware_interface::ImuSensorHandle(data));
    }
  }
}

// ---------------------------------------------------------------- claims of controllers

std::string SimulatedRobot::find_fault(std::size_t coordinate, std::size_t interface) const {
  const ServoMode mode = kCommandInterfaces[interface].mode;
  const std::string& name = simulation_.coordinate_names()[coordinate];
  if (std::string refusal = refusal_of_commands(simulation_, coordinate); !refusal.empty()) return refusal;
  if (mode == ServoMode::Effort) return {};
  const scene::ServoDescription* const servo = servo_described(simulation_.scene(), name);
  const std::string mode_text = "mode=\"" + std::string(to_string(mode)) + "\" kp=\"...\"";
  if (!servo)
    return "'" + name + "' has no servo: write <servo joint=\"" + name + "\" " + mode_text + " .../> into the scene";
  if (has_gains(*servo, mode)) return {};
  return "the servo of '" + name + "' has no gains of mode '" + to_string(mode) + "': write <gains " + mode_text +
         " .../> into its <servo>";
}

template <class Act>
void SimulatedRobot::for_claims(const Controllers& controllers, const Act& act) const {
  for (const hardware_interface::ControllerInfo& controller : controllers)
    for (const hardware_interface::InterfaceResources& claimed : controller.claimed_resources) {
      const std::optional<std::size_t> interface = command_interface_called(claimed.hardware_interface);
      if (!interface) continue;  // an interface of another part of a larger robot
      for (const std::string& name : claimed.resources)
        if (const auto place = coordinates_.find(name); place != coordinates_.end()) act(place->second, *interface);
    }
}

std::string SimulatedRobot::find_faults(const hardware_interface::ControllerInfo& controller) const {
  std::string faults;
  for_claims({controller}, [&](std::size_t coordinate, std::size_t interface) {
    const std::string& fault = joints_[coordinate].faults[interface];
    if (fault.empty()) return;
    faults += (faults.empty() ? "" : "\n") +
              ("controller '" + controller.name + "' claims " + kCommandInterfaces[interface].name + ", but " + fault);
  });
  return faults;
}

bool SimulatedRobot::prepareSwitch(const Controllers& started, const Controllers& /*stopped*/) {
  bool is_possible = true;
  for (const hardware_interface::ControllerInfo& controller : started) {
    const std::string faults = find_faults(controller);
    if (faults.empty()) continue;
    ROS_ERROR_STREAM(faults);
    is_possible = false;
  }
  return is_possible;
}

void SimulatedRobot::doSwitch(const Controllers& started, const Controllers& stopped) {
  for_claims(stopped, [this](std::size_t coordinate, std::size_t) { let_go(coordinate); });
  for_claims(started, [this](std::size_t coordinate, std::size_t interface) { take_hold(coordinate, interface); });
}

void SimulatedRobot::take_hold(std::size_t coordinate, std::size_t interface) {
  Joint& joint = joints_[coordinate];
  if (!joint.faults[interface].empty()) return;  // was refused by prepareSwitch()
  const bool has_servo = simulation_.has_servo(coordinate);
  if (has_servo) simulation_.switch_mode(coordinate, kCommandInterfaces[interface].mode);
  // Hold the present set point until the controller commands another one.
  joint.commands[interface] = {has_servo ? simulation_.set_point(coordinate) : 0};
  joint.interface = interface;
}

void SimulatedRobot::let_go(std::size_t coordinate) {
  Joint& joint = joints_[coordinate];
  if (!joint.interface) return;
  const bool stands = kCommandInterfaces[*joint.interface].mode == ServoMode::Position;
  give(coordinate, {stands ? simulation_.set_point(coordinate) : 0});
  joint.interface.reset();
}

// ---------------------------------------------------------------- a cycle

void SimulatedRobot::read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  for (std::size_t coordinate = 0; coordinate < joints_.size(); ++coordinate) {
    Joint& joint = joints_[coordinate];
    joint.position = simulation_.position(coordinate);
    joint.velocity = simulation_.velocity(coordinate);
    joint.effort = simulation_.effort(coordinate);
  }
  for (Sensor& sensor : sensors_)
    std::copy_n(simulation_.sample(sensor.index).values.begin(), sensor.values.size(), sensor.values.begin());
}

void SimulatedRobot::give(std::size_t coordinate, const Command& command) {
  if (simulation_.has_servo(coordinate))
    simulation_.command_set_point(coordinate, command.value, command.rate, command.acceleration);
  else
    simulation_.command_effort(coordinate, command.value);
}

void SimulatedRobot::write(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  since_write_ = 0;
  for (std::size_t coordinate = 0; coordinate < joints_.size(); ++coordinate) {
    const Joint& joint = joints_[coordinate];
    if (!joint.interface) continue;
    const Command& command = joint.commands[*joint.interface];
    if (std::isfinite(command.value) && std::isfinite(command.rate) && std::isfinite(command.acceleration))
      give(coordinate, command);
    else
      ROS_ERROR_STREAM_THROTTLE(1, "joint '" << simulation_.coordinate_names()[coordinate]
                                             << "': a controller commands " << command.value << ", rate "
                                             << command.rate << ", acceleration " << command.acceleration
                                             << ", which are not all finite: ignored");
  }
}

StepResult SimulatedRobot::step() {
  since_write_ += simulation_.step_size();
  const double ahead = since_write_;
  for (std::size_t coordinate = 0; coordinate < joints_.size(); ++coordinate) {
    const Joint& joint = joints_[coordinate];
    if (!joint.interface) continue;
    const Command& now = joint.commands[*joint.interface];
    const Command then{now.value + ahead * (now.rate + ahead * now.acceleration / 2),
                       now.rate + ahead * now.acceleration, now.acceleration};
    const bool moves = now.rate != 0 || now.acceleration != 0;
    if (moves && std::isfinite(then.value) && std::isfinite(then.rate)) give(coordinate, then);
  }
  return simulation_.step();
}

void SimulatedRobot::reset() {
  simulation_.reset();
  for (std::size_t coordinate = 0; coordinate < joints_.size(); ++coordinate)
    if (joints_[coordinate].interface) take_hold(coordinate, *joints_[coordinate].interface);
}

}  // namespace flexarm::ros_control
