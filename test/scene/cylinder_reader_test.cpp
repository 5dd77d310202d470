/// Tests the reader of <cylinder>: its parts, and every error, word for word.
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// A scene with one cylinder in line 7: its attributes and children, and children of <simulation>.
std::string scene_with(const std::string& cylinder, const std::string& simulation = "") {
  return "<robot name='crane'>\n<link name='base'/>\n"
         "<link name='jib'><inertial><mass value='1'/>"
         "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n"
         "<joint name='hinge' type='continuous'>\n<parent link='base'/><child link='jib'/><axis xyz='0 1 0'/></joint>\n"
         "\n<cylinder " +
         cylinder + "</cylinder>\n<simulation>" + simulation + "</simulation></robot>";
}
const std::string kEnds = "name='lift' from='base' from_at='0 0 -1' to='jib' to_at='1 0 0'>";

}  // namespace

TEST(CylinderReader, AddsBarrelRodAndJoints) {
  const ReadResult result = read(scene_with(
      kEnds +
          "<limit lower='1' upper='2' effort='5e3' velocity='1' restitution='0.5'/><dynamics damping='3' friction='4'/>"
          "<friction law='coulomb'/><barrel mass='12' length='1' radius='0.1'/><rod mass='6' length='0.8'/>"
          "<spring stiffness='7'/><drive rotor_inertia='0.1'/><servo mode='position' kp='10'/>",
      "<effort joint='lift' history='2'/>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  const SceneDescription& scene = *result.scene;
  ASSERT_EQ(scene.links.size(), 4u);
  const RigidInertia &barrel = scene.links[2].inertial.value(), &rod = scene.links[3].inertial.value();
  EXPECT_EQ(scene.links[2].name, "lift_barrel");
  EXPECT_EQ(scene.links[3].name, "lift_rod");
  EXPECT_EQ(barrel.mass, 12);
  EXPECT_TRUE(barrel.center_of_mass.isApprox(Vector3(0.5, 0, 0)));
  EXPECT_TRUE(barrel.inertia.diagonal().isApprox(Vector3(0.06, 1.03, 1.03)));
  EXPECT_TRUE(rod.center_of_mass.isApprox(Vector3(-0.4, 0, 0)));
  EXPECT_TRUE(rod.inertia.diagonal().isApprox(Vector3(0, 0.32, 0.32)));
  ASSERT_EQ(scene.joints.size(), 3u);
  const JointDescription& travel = scene.joints[2];
  EXPECT_EQ(travel.name, "lift");
  EXPECT_EQ(travel.kind, JointKind::Prismatic);
  EXPECT_FALSE(travel.is_hidden);
  EXPECT_EQ(travel.limits.value().upper, 2);
  EXPECT_EQ(travel.limits->restitution, 0.5);
  EXPECT_EQ(travel.effort_limit, 5e3);
  EXPECT_EQ(travel.damping, 3);
  EXPECT_EQ(travel.friction, 4);
  EXPECT_EQ(travel.friction_law.law, FrictionDescription::Law::Coulomb);
  EXPECT_TRUE(scene.joints[1].is_hidden && scene.loop_joints.at(0).is_hidden);
  EXPECT_EQ(scene.joints[1].parent, "base");
  EXPECT_EQ(scene.loop_joints[0].child, "jib");
  EXPECT_EQ(scene.springs.at(0).coordinate, "lift");
  EXPECT_EQ(scene.drives.at(0).coordinate, "lift");
  EXPECT_EQ(scene.servos.at(0).coordinate, "lift");
  EXPECT_EQ(scene.efforts.at(0).coordinate, "lift");
}

TEST(CylinderReader, HasNoStopsWithoutBothLimits) {
  const ReadResult result = read(scene_with(kEnds + "<limit effort='100'/>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_FALSE(result.scene->joints[2].limits);
  EXPECT_EQ(result.scene->joints[2].effort_limit, 100);
}

TEST(CylinderReader, RefusesWithExactlyTheseWords) {
  const std::string start = "scene.urdf:7: <cylinder> 'lift': ";
  const std::pair<std::string, std::string> cases[] = {
      {"from='base' to='jib'>", "scene.urdf:7: <cylinder> of robot 'crane': attribute 'name' is missing"},
      {"name='lift' to='jib'>", start + "attribute 'from' is missing"},
      {"name='lift' from='base'>", start + "attribute 'to' is missing"},
      {"name='lift' from='base' to='hook'>",
       start + "to must be a link of the scene, and no part of a cylinder, got 'hook'"},
      {"name='lift' from='lift_rod' to='jib'>",
       start + "from must be a link of the scene, and no part of a cylinder, got 'lift_rod'"},
      {"name='lift' from='jib' to='jib'>", start + "from and to must be different links, got 'jib'"},
      {"name='lift' from='base' to='jib' at='0 0 0'>",
       start + "unknown attribute, expected name, from, from_at, to, to_at, got 'at'"},
      {"name='lift' from='base' from_at='0 0' to='jib'>", start + "from_at must be 3 finite numbers, got '0 0'"},
      {"name='hinge' from='base' to='jib'>",
       "scene.urdf:7: <cylinder> 'hinge': the name of its coordinate is taken, by line 4, got 'hinge'"},
      {kEnds + "<limit lower='1'/>", "scene.urdf:7: <limit> of cylinder 'lift': attribute 'upper' is missing"},
      {kEnds + "<limit lower='-1' upper='1'/>",
       "scene.urdf:7: <limit> of cylinder 'lift': lower must be >= 0, got '-1'"},
      {kEnds + "<limit lower='2' upper='1'/>",
       "scene.urdf:7: <limit> of cylinder 'lift': lower must be <= upper, got lower '2', upper '1'"},
      {kEnds + "<limit effort='1' restitution='0.3'/>",
       "scene.urdf:7: <limit> of cylinder 'lift': there are no stops without lower and upper, got '0.3'"},
      {kEnds + "<dynamics damping='-1'/>",
       "scene.urdf:7: <dynamics> of cylinder 'lift': damping must be >= 0, got '-1'"},
      {kEnds + "<friction coefficient='0.1' radius='1'/>",
       "scene.urdf:7: <friction> of cylinder 'lift': nothing turns about an axis here; leave this out, got '1'"},
      {kEnds + "<rod mass='1'/>",
       "scene.urdf:7: <rod> of cylinder 'lift': a part with a mass needs its length, for its inertia: length > 0"},
      {kEnds + "<barrel mass='1' length='0'/>",
       "scene.urdf:7: <barrel> of cylinder 'lift': length must be > 0, got '0'"},
      {kEnds + "<servo joint='lift' mode='effort'/>",
       "scene.urdf:7: <servo> of cylinder 'lift': it acts on its <cylinder>; leave this out, got 'lift'"},
      {kEnds + "<piston/>",
       "scene.urdf:7: <piston> of cylinder 'lift': unknown element, expected limit, dynamics, friction, barrel, rod, "
       "spring, drive, servo, hydraulics"},
  };
  for (const auto& [cylinder, expected] : cases) EXPECT_EQ(findings_of(scene_with(cylinder)), expected) << cylinder;
}

TEST(CylinderReader, RefusesItsPositionAndItsHiddenJoints) {
  const std::string own =
      "scene.urdf:8: <initial> of simulation: a <cylinder> has no initial position: it starts with the length that the "
      "positions of the other joints give it, got 'lift'";
  EXPECT_EQ(findings_of(scene_with(kEnds, "<initial joint='lift' position='1'/>")), own);
  EXPECT_EQ(findings_of(scene_with(kEnds + "<limit lower='1' upper='2'/>", "<initial joint='lift' position='clamp'/>")),
            own);
  EXPECT_EQ(findings_of(scene_with(kEnds, "<effort joint='lift_hinge/1' history='1'/>")),
            "scene.urdf:8: <effort> of simulation: joint must be the name of a joint's coordinate (hinge, lift), got "
            "'lift_hinge/1'");
  EXPECT_TRUE(read(scene_with(kEnds, "<initial joint='lift' velocity='1'/>")).scene);
}

TEST(CylinderReader, RefusesTheNamesOfItsParts) {
  EXPECT_EQ(findings_of(scene_with(kEnds + "</cylinder><cylinder " + kEnds)),
            "scene.urdf:7: <cylinder> 'lift': the name of its coordinate is taken, by line 7, got 'lift'");
  EXPECT_EQ(findings_of(scene_with("name='lift' from='base' to='jib'></cylinder><link name='lift_rod'/><joint name='j' "
                                   "type='fixed'><parent link='jib'/><child link='lift_rod'/></joint><cylinder "
                                   "name='other' from='jib' to='base'>")),
            "scene.urdf:7: <cylinder> 'lift': the name of its rod is taken, by line 7, got 'lift_rod'");
}

}  // namespace flexarm::scene
