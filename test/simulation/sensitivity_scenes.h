#pragma once
/// Scenes for tests of sensitivities.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/sensitivities.h"

namespace flexarm::test {

/// A scene text that can be read with other values of its parameters.
struct Scene {
  std::string text;

  Simulation simulation(const scene::ParameterValues& values = {}, const SimulationOptions& options = {}) const {
    scene::ReadResult result = scene::read_scene_text(text, "test.urdf", {false, false, false, values});
    if (!result.scene) throw std::runtime_error(scene::to_text(result.diagnostics));
    return Simulation(std::move(*result.scene), options);
  }
  SensitivityRequest request(std::vector<std::string> parameters) const {
    SensitivityRequest request;
    request.parameters = std::move(parameters);
    request.read = [text = text](const std::string& name, double value) {
      return scene::read_scene_text(text, "test.urdf", {false, false, false, {{name, value}}});
    };
    return request;
  }
};

/// Adds an integrator to the text of one of the scenes below.
inline std::string with_scheme(std::string scene, const std::string& scheme, double step) {
  const std::string place = "<simulation>";
  scene.insert(scene.find(place) + place.size(),
               fmt::format(" <integrator scheme=\"{}\" step=\"{}\" tolerance=\"1e-10\"/>", scheme, step));
  return scene + "</robot>";
}

/// A rod on a hinge with damping.
inline const std::string kPendulum = R"(<robot name="pendulum">
  <parameter name="damping" value="0.5" min="0"/> <parameter name="payload" value="2"/>
  <parameter name="angle" value="1.2"/> <parameter name="speed" value="0.7"/> <parameter name="reach" value="0.8"/>
  <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/>
    <dynamics damping="${damping}"/> </joint>
  <link name="rod"> <inertial> <origin xyz="${reach} 0 0"/> <mass value="${payload}"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <simulation> <initial joint="hinge" position="${angle}" velocity="${speed}"/>
    <probe name="end" link="rod" at="1 0 0"/> </simulation>
  )";

/// The pendulum with a controller behind an elastic gear, and a rotor whose inertia is as large as the rod's.
inline const std::string kGearedPendulum = kPendulum + R"(
  <drive joint="hinge" rotor_inertia="1.5" stiffness="200" damping="0.5"/>
  <servo joint="hinge" mode="position" kp="40" kd="1" set_point="0.5"/>)";

/// A flexible boom with a load on a hinge at its end.
inline std::string flexible_arm(const std::string& wrist_axis) {
  return R"(<robot name="arm">
  <parameter name="young" value="7e9"/> <parameter name="payload" value="0.4"/> <parameter name="damping" value="0.3"/>
  <parameter name="length" value="1"/> <parameter name="elements" value="3"/> <parameter name="turn" value="0.3"/>
  <link name="world"/>
  <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 1 0"/>
    <dynamics damping="${damping}"/> </joint>
  <link name="boom"> <beam elements="${elements}"> <centerline> <line to="${length} 0 0"/> </centerline>
    <circle radius="0.01"/> <material young="${young}" poisson="0.3" density="2700"/> </beam> </link>
  <joint name="wrist" type="continuous"> <parent link="boom"/> <child link="load"/> <origin xyz="${length} 0 0"/>
    <axis xyz=")" +
         wrist_axis + R"x("/> </joint>
  <link name="load"> <inertial> <origin xyz="0.1 0.02 0"/> <mass value="${payload}"/>
    <inertia ixx="1e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
  <simulation> <effort joint="shoulder" history="3*sin(5*t)"/>
    <initial joint="wrist" position="${turn}" velocity="1"/> <probe name="tip" link="load"/> </simulation>
  )x";
}

/// A rod that turns freely until it hits a stop.
inline std::string rod_with_stop(double upper, const std::string& gravity, const std::string& integrator) {
  return fmt::format(R"(<robot name="rod"> <parameter name="speed" value="0.7"/> <link name="world"/>
    <joint name="hinge" type="revolute"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/>
      <limit lower="-10" upper="{:.17g}" effort="0" velocity="100"/> </joint>
    <link name="rod"> <inertial> <origin xyz="0.8 0 0"/> <mass value="2"/>
      <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <simulation> <gravity xyz="{}"/> <initial joint="hinge" velocity="${{speed}}"/> <integrator {}/>
    </simulation> </robot>)",
                     upper, gravity, integrator);
}

}  // namespace flexarm::test
