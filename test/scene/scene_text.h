#pragma once
/// A good scene as text, and ways to spoil it.

#include <gtest/gtest.h>

#include <string>

#include "flexarm/scene/urdf_reader.h"

namespace flexarm::scene {

/// Uses every element; the number of each line stands beside it.
inline const char* const kGoodScene =
    R"xml(<robot name="arm">
  <!-- 2 -->
  <material name="grey"> <color rgba="0.5 0.5 0.5 1"/> </material>
  <link name="world"/>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 0.5" rpy="0 0 1.5707963267948966"/>
    <parent link="world"/>
    <child link="upper"/>
    <axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" effort="30" velocity="4"/>
    <dynamics damping="0.1" friction="0.2"/>
  </joint>
  <link name="upper">
    <inertial>
      <origin xyz="0.1 0 0" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/>
    </inertial>
    <visual> <geometry> <box size="1 1 1"/> </geometry> <material name="grey"/> </visual>
    <collision> <geometry> <sphere radius="1"/> </geometry> </collision>
  </link>
  <joint name="elbow" type="continuous">
    <parent link="upper"/>
    <child link="forearm"/>
    <limit effort="7" velocity="1"/>
  </joint>
  <link name="forearm">
    <beam elements="4" order="3">
      <centerline>
        <line to="1 0 0" twist="0.5"/>
        <arc to="2 1 0" center="1 1 0"/>
      </centerline>
      <orientation y="0 2 0"/>
      <tube outer_radius="0.02" inner_radius="0.01"/>
      <material young="70e9" poisson="0.33" density="2700"/>
      <damping stiffness_proportional="1e-4" mass_proportional="0.1"/>
    </beam>
  </link>
  <joint name="wrist" type="floating">
    <parent link="forearm"/>
    <child link="hand"/>
    <axis xyz="0 1 0"/>
    <axis2 xyz="0 0 3"/>
    <release kind="universal"/>
  </joint>
  <link name="hand"> <gazebo anything="goes"/> </link>
  <joint name="finger" type="prismatic">
    <parent link="hand"/> <child link="tip"/>
    <limit lower="0" upper="1" effort="0" velocity="0"/>
    <mimic joint="elbow" multiplier="-2" offset="0.5"/>
  </joint>
  <link name="tip">
    <beam>
      <centerline> <line to="0 0 1"/> </centerline>
      <section ea="1" ga2="2" ga3="3" gj="4" ei2="5" ei3="6" mass="7" j1="8" j2="9" j3="10"/>
    </beam>
  </link>
  <simulation>
    <gravity xyz="0 0 -1.62"/>
    <integrator scheme="edmc2" step="0.002" tolerance="1e-9" max_iterations="11" max_halvings="3" rho_infinity="0.9"/>
    <initial joint="shoulder" position="0.3" velocity="0.4"/>
    <initial link="forearm" linear="1 2 3" angular="4 5 6"/>
    <load link="forearm" at="1 0 0" force="0 0 50" moment="1 2 3" frame="follower" history="0:0 1:50"/>
    <distributed_load link="tip" force="0 0 1" frame="world" history="t*t"/>
    <motion joint="wrist/2" position="sin(t)"/>
    <effort joint="elbow" history="t &lt; 1 ? 3 : 4"/>
    <probe name="end" link="tip" at="0 0 1"/>
  </simulation>
  <transmission name="left alone"/>
</robot>
)xml";

/// The good scene with `from`, which must be there once, replaced.
inline std::string good_scene_with(const std::string& from, const std::string& to) {
  std::string text = kGoodScene;
  const std::size_t found = text.find(from);
  if (found == std::string::npos || text.find(from, found + 1) != std::string::npos) {
    ADD_FAILURE() << "'" << from << "' must be in the scene once";
    return text;
  }
  return text.replace(found, from.size(), to);
}

inline ReadResult read(const std::string& text) {
  return read_scene_text(text, "scene.urdf");
}

/// Expects exactly one error, at this line, whose text contains the fragment.
inline void expect_one_error(const std::string& text, int line, const std::string& fragment) {
  const ReadResult result = read(text);
  EXPECT_FALSE(result.scene);
  ASSERT_EQ(result.diagnostics.size(), 1u) << "expected: " << fragment << "\n" << to_text(result.diagnostics);
  EXPECT_EQ(result.diagnostics[0].line, line) << result.diagnostics[0].text();
  EXPECT_NE(result.diagnostics[0].text().find(fragment), std::string::npos) << "expected: " << fragment << "\n"
                                                                            << result.diagnostics[0].text();
}

/// Expects a scene, and among its warnings one at this line whose text contains the fragment.
inline void expect_warning(const ReadResult& result, int line, const std::string& fragment) {
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  for (const Diagnostic& finding : result.diagnostics)
    if (finding.line == line && finding.text().find(fragment) != std::string::npos) return;
  ADD_FAILURE() << "expected at line " << line << ": " << fragment << "\n" << to_text(result.diagnostics);
}

}  // namespace flexarm::scene
