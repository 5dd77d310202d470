// Tests simulations of lines over many links: closed forms in statics, conservation of energy, and friction.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test {
namespace {

constexpr double kStiffness = 4e4, kMass = 5, kWeight = 5 * 9.81;  // EA [N], of the load [kg], [N]

/// A boom of 2 m on a hinge, with a load at its tip. A line runs up over five wheels on the axis above the hinge, and
/// down to the tip. Springs hold the wheels, on whose axes the line acts.
Simulation crane(const std::string& options) {
  std::string parts, guides;
  for (int i = 0; i < 5; ++i) {
    parts += fmt::format(R"(<joint name="axle{0}" type="continuous"> <parent link="world"/> <child link="wheel{0}"/>
        <origin xyz="0 0 {1}"/> <axis xyz="0 1 0"/> </joint> <spring joint="axle{0}" stiffness="1"/>
      <link name="wheel{0}"> <inertial> <mass value="0.1"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>)",
                         i, 1 + 0.25 * i);
    guides += fmt::format("<via link=\"wheel{}\"/>", i);
  }
  const std::string text = fmt::format(
      R"(<robot name="crane"> <link name="world"/>
      <joint name="hinge" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 1 0"/> </joint>
      <link name="boom"> <inertial> <origin xyz="2 0 0"/> <mass value="{}"/>
        <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/> </inertial> </link> {}
      <tendon name="line" ea="{}"> {} <via link="boom" at="2 0 0"/> </tendon>
      <simulation> <gravity xyz="0 0 -9.81"/> <integrator scheme="em" step="1e-3" tolerance="1e-12"/> </simulation>
      {} </robot>)",
      kMass, parts, kStiffness, guides, options);
  const scene::ReadResult read = scene::read_scene_text(text, "crane.urdf");
  for (const scene::Diagnostic& finding : read.diagnostics) ADD_FAILURE() << finding.text();
  return Simulation(read.scene.value());
}

double value_of(const Simulation& simulation, const std::string& name) {
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {name});
  return columns.row(simulation, {}).back();
}

/// The length of the line, and its derivative, with the boom turned downwards by an angle.
double line_length(double angle) {
  return 1 + std::hypot(2 * std::cos(angle), 2 + 2 * std::sin(angle));
}
double line_slope(double angle) {
  return 4 * std::cos(angle) / (line_length(angle) - 1);
}

// Only the line holds the boom: its moment is that of the weight.
TEST(LongLines, HoldABoomInStatics) {
  Simulation s = crane("");
  ASSERT_TRUE(s.solve_static(1).converged);
  const double rest = line_length(0);
  double low = 0, high = 0.1;
  while (high - low > 1e-15) {
    const double angle = 0.5 * (low + high), tension = kStiffness * (line_length(angle) / rest - 1);
    (tension * line_slope(angle) < 2 * kWeight * std::cos(angle) ? low : high) = angle;
    if (0.5 * (low + high) == low || 0.5 * (low + high) == high) break;
  }
  EXPECT_NEAR(value_of(s, "joint/hinge/position"), low, 1e-11);
  EXPECT_NEAR(value_of(s, "tendon/line/tension"), kStiffness * (line_length(low) / rest - 1), 1e-6);
}

// The load falls into the line, so that the boom swings up again.
TEST(LongLines, ConserveEnergy) {
  Simulation s = crane("");
  const double start = s.energies().total();
  double most = 0;
  for (int n = 0; n < 400; ++n) {
    ASSERT_TRUE(s.step().converged);
    EXPECT_NEAR(s.energies().total(), start, 1e-10);  // energies of 1 J
    most = std::max(most, value_of(s, "tendon/line/tension"));
  }
  EXPECT_GT(most, 1.5 * kWeight);
}

/// A rope over nine posts at the corners of a regular polygon, where it turns by 30 degrees each. Both ends lead on
/// straight to trolleys on rails: one is held by an effort, the other one moves steadily.
Simulation posts(double friction) {
  constexpr int kPosts = 9;
  constexpr double kTurn = M_PI / 6;
  std::string parts, guides;
  double x = 0, z = 0, direction = 0;
  for (int i = 0; i < kPosts; ++i) {
    parts += fmt::format(R"(<joint name="rail{0}" type="prismatic"> <parent link="world"/> <child link="post{0}"/>
        <origin xyz="{1:.17g} 0 {2:.17g}"/> <axis xyz="0 1 0"/> <limit lower="-1" upper="1" effort="1e3" velocity="1"/> </joint>
      <spring joint="rail{0}" stiffness="100"/>
      <link name="post{0}"> <inertial> <mass value="1"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>)",
                         i, x, z);
    guides += fmt::format("<via link=\"post{}\" friction=\"{}\"/>", i, friction);
    direction += kTurn;
    x += std::cos(direction), z += std::sin(direction);
  }
  const std::string text = fmt::format(
      R"(<robot name="posts"> <link name="world"/> {}
      <joint name="pull" type="prismatic"> <parent link="world"/> <child link="trolley"/>
        <origin xyz="{:.17g} 0 {:.17g}"/> <axis xyz="{:.17g} 0 {:.17g}"/> <limit lower="-1" upper="1" effort="1e3" velocity="1"/> </joint>
      <link name="trolley"> <inertial> <mass value="1"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
      <joint name="hold" type="prismatic"> <parent link="world"/> <child link="weight"/> <origin xyz="-1 0 0"/>
        <axis xyz="-1 0 0"/> <limit lower="-1" upper="1" effort="1e3" velocity="1"/> </joint>
      <link name="weight"> <inertial> <mass value="1"/>
        <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
      <tendon name="rope" ea="1e4" damping="200"> <via link="weight"/> {} <via link="trolley"/> </tendon>
      <simulation> <integrator scheme="em" step="1e-2" tolerance="1e-12"/> <effort joint="hold" history="20"/>
        <motion joint="pull" position="0.025*exp(-4*t)+0.1*t-0.025"/> </simulation> </robot>)",
      parts, x, z, std::cos(direction), std::sin(direction), guides);
  const scene::ReadResult read = scene::read_scene_text(text, "posts.urdf");
  for (const scene::Diagnostic& finding : read.diagnostics) ADD_FAILURE() << finding.text();
  return Simulation(read.scene.value());
}

// Euler and Eytelwein: the tensions at both ends have the ratio exp(friction * angle), over nine posts that are nine
// links. What the pull does more than the effort takes is dissipated. The weight moves almost as steadily as the
// trolley, so that the tension behind it is the effort.
TEST(LongLines, SlipOverManyPosts) {
  constexpr double kFriction = 0.15;
  Simulation s = posts(kFriction);
  const double start = s.energies().total();
  for (int n = 0; n < 500; ++n) {
    ASSERT_TRUE(s.step().converged);
    const Energies now = s.energies();
    EXPECT_NEAR(now.total() + now.dissipated - now.work, start, 1e-9);  // works of up to 40 J
  }
  const double ratio = std::exp(kFriction * 9 * M_PI / 6);
  EXPECT_NEAR(value_of(s, "tendon/rope/tension"), 20, 20 * 1e-6);
  EXPECT_NEAR(value_of(s, "tendon/rope/last_tension"), 20 * ratio, 20 * ratio * 1e-6);
  const double slipped = 20 * (ratio - 1) * 0.475;
  EXPECT_NEAR(s.energies().dissipated, slipped, 0.01 * slipped);  // but for the start
}

}  // namespace
}  // namespace flexarm::test
