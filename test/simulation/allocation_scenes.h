#pragma once
/// Scenes for tests that steps allocate nothing.

#include "support/scene_text.h"

namespace flexarm::test {

/// A boom on oil, with a pump, relief valves and voids that are filled.
inline const char* const kOilScene = R"xml(<robot name="r"> <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 -1 0"/> </joint>
    <link name="boom"> <inertial> <origin xyz="0.5 0 0"/> <mass value="10"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <cylinder name="lift" from="world" from_at="0.3 0 -0.3" to="boom" to_at="0.3 0 0">
      <limit lower="0.2" upper="0.5"/>
      <hydraulics bore="0.03" rod="0.02" bulk_modulus="1e8" pressure="4e5" relief_pressure="1.2e6" flow="1e-5*sin(t)">
        <pump name="pump"> <drive rotor_inertia="20"/> </pump> </hydraulics> </cylinder>
    <simulation> <integrator scheme="em" step="1e-3"/> <effort joint="pump" history="3000*sin(40*t)"/> </simulation>
    </robot>)xml";

/// A beam of several Maxwell elements that turns in space, or in a plane if `axis` is along y.
inline std::string relaxing_scene(const std::string& axis) {
  return R"xml(<robot name="r"> <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz=")xml" +
         axis + R"xml("/> </joint>
    <link name="rod"> <beam elements="6" order="2"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="2e5" ga2="1e5" ga3="1e5" gj="2" ei2="2.5" ei3="2.5" mass="0.5" j1="2e-4" j2="1e-4" j3="1e-4"/>
      <damping> <maxwell modulus_ratio="0.4" relaxation_time="0.02"/> <maxwell modulus_ratio="0.1" relaxation_time="1"/>
      </damping> </beam> </link>
    <simulation> <gravity xyz="0 0 -9.81"/> <integrator scheme="em" step="1e-3"/> </simulation> </robot>)xml";
}

/// A line that slips over a point, runs over a pulley and onto a drum, paid out by a winch. It is slack first; then the
/// mass falls into it.
inline std::string rope_scene(double friction) {
  return robot(
      joint("rail", "prismatic", "world", "mass", "<origin xyz='0 0 -1'/><axis xyz='0 0 1'/>" + kFarLimits) +
          body("mass", 2) +
          joint("axle", "continuous", "world", "drum",
                "<origin xyz='2 0 0'/><axis xyz='0 1 0'/><dynamics damping='1'/>") +
          body("drum", 1) +
          fmt::format(R"(<tendon name="rope" ea="1e4" damping="10"> <via link="mass"/> <via link="world" at="0 0 1" {}/>
      <pulley link="world" at="1 0 1.2" axis="0 1 0" radius="0.1" side="left"/>
      <pulley link="drum" axis="0 1 0" radius="0.2" side="left" grips="true"/> </tendon>
    <winch name="hoist" tendon="rope"/> <sensor name="cell" kind="tendon" tendon="rope"/>
    <tendon name="other" ea="100" rest_length="1"> <via link="world"/> <via link="mass"/> </tendon>)",
                      friction > 0 ? fmt::format("friction='{}'", friction) : ""),
      gravity({0, 0, -9.81}) + integrator("em", 1e-3) + "<motion joint='hoist' position='0.1*sin(9*t)'/>");
}

/// Lines along a rod, one of them paid out by a winch, and drag of the air.
inline const char* const kTendonScene = R"xml(<robot name="r"> <link name="world"/>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint>
    <link name="rod"> <beam elements="8" order="2"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="2e5" ga2="1e5" ga3="1e5" gj="2" ei2="2.5" ei3="2.5" mass="0.5" j1="2e-4" j2="1e-4" j3="1e-4"/>
      </beam> <drag coefficient="1.2" width="0.02"/> </link>
    <joint name="wrist" type="continuous"> <parent link="rod"/> <child link="tool"/> <origin xyz="1 0 0"/> </joint>
    <link name="tool"> <inertial> <mass value="1"/> <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>
      </inertial> <drag coefficient="1" area="0.01"/> </link>
    <tendon name="upper" ea="2000" damping="1"> <vias link="rod" from="0 0 0.03" to="1 0 0.03" count="9"/> </tendon>
    <tendon name="lower" ea="2000"> <vias link="rod" from="0 0 -0.03" to="0.875 0 -0.03" count="8"/>
      <via link="tool" at="0 0.1 -0.03"/> </tendon>
    <winch name="hoist" tendon="upper"/>
    <simulation> <gravity xyz="0 0 -9.81"/> <integrator scheme="em" step="1e-3"/>
      <motion joint="hoist" position="-0.01*sin(9*t)"/> </simulation> </robot>)xml";

}  // namespace flexarm::test
