/// Tests options and elements about the start of a scene (--start, clamp, equilibrium, floating root) by running the
/// program.

#include "cli/program.h"

namespace flexarm::cli {
namespace {

/// Returns the link `name` of 1 kg, with its centre of mass 0.2 m below its origin; without inertia if `is_ghost`.
std::string link(const std::string& name, bool is_ghost = false) {
  return "<link name=\"" + name + "\">" + (is_ghost ? "" : R"(<inertial> <origin xyz="0 0 -0.2"/> <mass value="1"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/> </inertial>)") +
         "</link>\n";
}

/// Returns a leg whose knee starts 0.75 rad outside its limits.
std::string leg(bool is_ghost = false) {
  return "<robot name=\"leg\"> <link name=\"trunk\"/>\n" + link("thigh") + link("shank", is_ghost) +
         R"(<joint name="hip" type="continuous"> <parent link="trunk"/> <child link="thigh"/> <axis xyz="0 1 0"/> </joint>
<joint name="knee" type="revolute"> <parent link="thigh"/> <child link="shank"/> <origin xyz="0 0 -0.4"/>
  <axis xyz="0 1 0"/> <limit lower="-2.5" upper="-0.75" effort="0" velocity="0"/> </joint> </robot>)";
}

bool contains(const std::string& text, const std::string& fragment) {
  return text.find(fragment) != std::string::npos;
}

}  // namespace

TEST(Start, ClampBeginsWithoutEnergyInStops) {
  const std::string simulate = "flexarm simulate " + scene_file(leg()) + " --until 0.001 --quiet --output ";
  const std::string given = temporary("given.csv"), clamped = temporary("clamped.csv");
  const Outcome thrown = shell(simulate + given);
  EXPECT_EQ(thrown.status, 0);
  EXPECT_TRUE(contains(thrown.errors, "<joint> 'knee': starts outside its limits, -2.5 to -0.75")) << thrown.errors;
  EXPECT_GT(read_csv(given)["energy/strain"][0], 0);
  const Outcome calm = shell(simulate + clamped + " --start clamp");
  EXPECT_EQ(calm.status, 0);
  EXPECT_EQ(calm.errors, "");
  EXPECT_EQ(read_csv(clamped)["energy/strain"][0], 0);
  EXPECT_EQ(read_csv(clamped)["joint/knee/position"][0], -0.75);
}

TEST(Start, EverySubcommandTakesTheOptions) {
  const std::string ghost = scene_file(leg(true));
  for (const char* command : {"simulate", "static", "modes", "check"}) {
    const std::string program = "flexarm " + std::string(command) + " " + ghost;
    const Outcome refused = shell(program + " --start clamp");
    EXPECT_EQ(refused.status, 2) << command;
    EXPECT_TRUE(contains(refused.errors, "joint coordinate 'knee' moves nothing that has inertia")) << refused.errors;
    const std::string until = command == std::string("simulate") ? " --until 0.01 --quiet" : "";
    const Outcome held = shell(program + until + " --start clamp --massless lock");
    EXPECT_EQ(held.status, 0) << command << held.errors;
    EXPECT_TRUE(contains(held.errors, ":6: warning: <joint> 'knee': is held where it starts")) << held.errors;
    EXPECT_FALSE(contains(held.errors, "limits")) << held.errors;
    EXPECT_EQ(shell(program + " --start now").status, 2) << command;
    EXPECT_EQ(shell(program + " --massless fly").status, 2) << command;
  }
}

// The shank hangs on its stop. The whole leg leans so that it is in equilibrium.
TEST(Start, EquilibriumStaysAtRest) {
  const std::string csv = temporary("rest.csv");
  const Outcome outcome =
      shell("flexarm simulate --start clamp,equilibrium " + scene_file(leg()) + " --until 0.5 --quiet --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  Columns columns = read_csv(csv);
  EXPECT_GT(columns["joint/hip/position"][0], 0.1);
  // The tolerance is the round-off of 500 steps, for angles of about one radian.
  EXPECT_NEAR(columns["joint/hip/position"].back(), columns["joint/hip/position"][0], 500 * 2.2e-16);
  EXPECT_LT(columns["energy/kinetic"].back(), 1e-20);
}

TEST(Start, WithoutEquilibriumNamesTheJoint) {
  const std::string floats =
      "<robot name=\"stone\">" + link("stone") +
      "<simulation> <root type=\"floating\"/> <initial equilibrium=\"true\"/> </simulation> </robot>";
  const Outcome outcome = shell("flexarm simulate " + scene_file(floats) + " --until 0.5");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.errors, "nothing holds joint 'root'")) << outcome.errors;
}

TEST(Start, WhatFallsWithEverythingIsNamedFirst) {
  const auto body = [](const std::string& name, const std::string& centre) {
    return "<link name=\"" + name + "\"> <inertial> <origin xyz=\"" + centre + R"("/> <mass value="1"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>)";
  };
  const Outcome outcome =
      shell("flexarm static " + scene_file("<robot name=\"stone\">" + body("stone", "0 0 0") + body("flag", "0.1 0 0") +
                                           R"(<joint name="pole" type="continuous">
      <parent link="stone"/> <child link="flag"/> <axis xyz="0 1 0"/> </joint>
      <simulation> <root type="floating"/> </simulation> </robot>)"));
  EXPECT_TRUE(contains(outcome.errors, "nothing holds joints 'root', ") ||
              contains(outcome.errors, "nothing holds joint 'root' "))
      << outcome.errors;
}

TEST(Start, AFloatingRootFalls) {
  const std::string path = scene_file("<robot name=\"stone\">" + link("stone") +
                                      "<simulation> <root type=\"floating\"/> </simulation> </robot>");
  const std::string csv = temporary("out.csv");
  const Outcome outcome = shell("flexarm simulate " + path + " --until 0.5 --quiet --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  Columns columns = read_csv(csv);
  // The result is exact for a constant force, except for round-off. Each of n steps adds the round-off of a position x
  // to the velocity, which is eps x / h, and this error acts for n steps at most.
  const double depth = 0.5 * 9.81 * 0.25, round_off = 500 * 500 * 2.2e-16 * depth;
  EXPECT_NEAR(columns["frame/stone/z"].back(), -depth, round_off);
  EXPECT_NEAR(columns["joint/root/z/position"].back(), -depth, round_off);
}

}  // namespace flexarm::cli
