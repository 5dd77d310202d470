/// Tests the reader of <hydraulics>: its numbers, its pump, and every error, word for word.
#include "flexarm/scene/hydraulics.h"

#include "math/pi.h"
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// A scene with a cylinder from line 5 on, <hydraulics> in line 6: its attributes and children; children of
/// <simulation> in line 7.
std::string oil_scene(const std::string& hydraulics, const std::string& simulation = "",
                      const std::string& limit = "<limit lower='0.5' upper='1.5'/>") {
  return "<robot name='crane'>\n<link name='base'/>\n"
         "<link name='jib'><inertial><mass value='1'/>"
         "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
         "<joint name='hinge' type='continuous'><parent link='base'/><child link='jib'/><axis xyz='0 1 0'/></joint>\n\n"
         "<cylinder name='lift' from='base' from_at='0 0 -1' to='jib' to_at='1 0 0'>" +
         limit + "\n<hydraulics " + hydraulics + "</hydraulics></cylinder>\n<simulation>" + simulation +
         "</simulation></robot>";
}

const HydraulicsDescription& oil_of(const SceneDescription& scene) {
  return dynamic_cast<const HydraulicsDescription&>(*scene.force_elements.at(0));
}

const std::string kOil = "bore='0.1' rod='0.06' bulk_modulus='1e9'";

}  // namespace

TEST(HydraulicsReader, ReadsAllNumbers) {
  const ReadResult result =
      read(oil_scene(kOil + " dead_volume='1e-4 2e-4' pressure='2e6 3e6' relief_pressure='2e7 1e7' makeup='false' "
                            "flow='1e-3*t'><pump name='feed'><limit effort='9'/><drive rotor_inertia='2'/>"
                            "<servo mode='velocity' kp='1'/></pump>",
                     "<effort joint='feed' history='3'/>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  const SceneDescription& scene = *result.scene;
  const HydraulicsDescription& oil = oil_of(scene);
  EXPECT_EQ(oil.name, "lift");
  EXPECT_EQ(oil.barrel, "lift_barrel");
  EXPECT_EQ(oil.rod, "lift_rod");
  EXPECT_EQ(oil.reel, "feed_reel");
  EXPECT_EQ(oil.lower, 0.5);
  EXPECT_EQ(oil.upper, 1.5);
  EXPECT_EQ(oil.bulk_modulus, 1e9);
  EXPECT_FALSE(oil.makes_up);
  EXPECT_NEAR(oil.chambers[0].area, 0.25 * kPi * 0.01, 1e-15);
  EXPECT_NEAR(oil.chambers[1].area, 0.25 * kPi * (0.01 - 0.0036), 1e-15);
  EXPECT_EQ(oil.chambers[0].dead_volume, 1e-4);
  EXPECT_EQ(oil.chambers[1].dead_volume, 2e-4);
  EXPECT_EQ(oil.chambers[0].pressure, 2e6);
  EXPECT_EQ(oil.chambers[1].pressure, 3e6);
  EXPECT_EQ(oil.chambers[0].relief_pressure, 2e7);
  EXPECT_EQ(oil.chambers[1].relief_pressure, 1e7);
  ASSERT_TRUE(oil.flow);
  EXPECT_EQ((*oil.flow)(2), 2e-3);
  const JointDescription& pump = scene.joints.back();
  EXPECT_EQ(pump.name, "feed");
  EXPECT_EQ(pump.kind, JointKind::Prismatic);
  EXPECT_EQ(pump.parent, "base");
  EXPECT_EQ(pump.child, "feed_reel");
  EXPECT_EQ(pump.effort_limit, 9);
  EXPECT_EQ(scene.drives.at(0).coordinate, "feed");
  EXPECT_EQ(scene.servos.at(0).coordinate, "feed");
  EXPECT_EQ(scene.cylinders.at(0).pump, "feed");
}

TEST(HydraulicsReader, HasDefaults) {
  const ReadResult result = read(oil_scene(kOil + ">"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const HydraulicsDescription& oil = oil_of(*result.scene);
  EXPECT_EQ(oil.reel, "");
  EXPECT_TRUE(oil.makes_up);
  EXPECT_FALSE(oil.flow);
  EXPECT_EQ(result.scene->joints.size(), 3u);
  for (const HydraulicsDescription::Chamber& chamber : oil.chambers) {
    EXPECT_NEAR(chamber.dead_volume, 0.1 * chamber.area, 1e-15);  // of a stroke of 1 m
    EXPECT_FALSE(chamber.relief_pressure);
    EXPECT_NEAR(chamber.pressure * chamber.area, 1e6 * oil.chambers[0].area, 1e-8);
  }
  const ReadResult soft = read(oil_scene("bore='0.1' bulk_modulus='1e6' dead_volume='1e-3' relief_pressure='2e4'>"));
  ASSERT_TRUE(soft.scene) << to_text(soft.diagnostics);
  for (const HydraulicsDescription::Chamber& chamber : oil_of(*soft.scene).chambers) {
    EXPECT_EQ(chamber.pressure, 1e4);
    EXPECT_EQ(chamber.dead_volume, 1e-3);
    EXPECT_EQ(chamber.relief_pressure, 2e4);
  }
}

TEST(HydraulicsReader, RefusesWithExactlyTheseWords) {
  const std::string start = "scene.urdf:6: <hydraulics> of cylinder 'lift': ";
  const std::pair<std::string, std::string> cases[] = {
      {"bulk_modulus='1e9'>", start + "attribute 'bore' is missing"},
      {"bore='0.1'>", start + "attribute 'bulk_modulus' is missing"},
      {"bore='0' bulk_modulus='1e9'>", start + "bore must be from 1e-6 to 1e3, got '0'"},
      {"bore='0.1' rod='0.1' bulk_modulus='1e9'>", start + "rod must be less than bore, which is 0.1, got '0.1'"},
      {"bore='0.1' rod='-1' bulk_modulus='1e9'>", start + "rod must be >= 0, got '-1'"},
      {"bore='0.1' bulk_modulus='0'>", start + "bulk_modulus must be > 0 and at most 1e15, got '0'"},
      {kOil + " dead_volume='0'>", start + "dead_volume must be one or two numbers > 0 and at most 1e9, got '0'"},
      {kOil + " dead_volume='1 2 3'>", start + "dead_volume must be at most 2 finite numbers, got '1 2 3'"},
      {kOil + " pressure=''>", start + "pressure must be one or two numbers >= 0, got ''"},
      {kOil + " pressure='1e6 -1'>", start + "pressure must be one or two numbers >= 0, got '1e6 -1'"},
      {kOil + " pressure='6e8 0'>",
       start + "pressures must be at most half the bulk modulus, 5e+08 Pa, got '6e+08' Pa at the start"},
      {kOil + " relief_pressure='9e8'>",
       start + "relief_pressure must be at most half the bulk modulus, 5e+08 Pa, got '9e8'"},
      {kOil + " pressure='2e6 0' relief_pressure='1e6'>",
       start + "pressures at the start must be at most relief_pressure, 1e+06 Pa, got '2e+06' Pa"},
      {kOil + " makeup='yes'>", start + "makeup must be one of true, false, got 'yes'"},
      {kOil + " flow='1/0'>", start + "flow must be finite at t = 0, got '1/0'"},
      {kOil + " stroke='1'>", start + "unknown attribute, expected bore, rod, bulk_modulus, dead_volume, pressure, "
                                      "relief_pressure, makeup, flow, got 'stroke'"},
      {kOil + "><valve/>", "scene.urdf:6: <valve> of cylinder 'lift': unknown element, expected pump"},
      {kOil + "><pump/>", "scene.urdf:6: <pump> of cylinder 'lift': attribute 'name' is missing"},
      {kOil + "><pump name='hinge'/>",
       "scene.urdf:6: <pump> 'hinge': the name of its coordinate is taken by a joint, got 'hinge'"},
      {kOil + "><pump name='a'><servo joint='a' mode='effort'/></pump>",
       "scene.urdf:6: <servo> of pump 'a': it acts on its <pump>; leave this out, got 'a'"},
  };
  for (const auto& [hydraulics, expected] : cases) EXPECT_EQ(findings_of(oil_scene(hydraulics)), expected);
  const std::string stroke =
      start + "needs the stroke of the cylinder: <limit lower=\"\" upper=\"\"/> with lower < upper";
  EXPECT_EQ(findings_of(oil_scene(kOil + ">", "", "")), stroke);
  EXPECT_EQ(findings_of(oil_scene(kOil + ">", "", "<limit effort='3'/>")), stroke);
}

TEST(HydraulicsReader, RefusesTheInitialPositionOfAPump) {
  EXPECT_EQ(
      findings_of(oil_scene(kOil + "><pump name='feed'/>", "<initial joint='feed' position='1'/>")),
      "scene.urdf:7: <initial> of simulation: a <pump> has no initial position: it starts with the length that the "
      "positions of the other joints give it, got 'feed'");
}

}  // namespace flexarm::scene
