/// Tests the readers of <tendon> and <winch>: what they make, and their errors, word for word.
#include "flexarm/scene/tendon.h"
#include "flexarm/simulation/simulation.h"
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// A scene with one tendon in line 5, and what comes behind it in line 6.
std::string scene_of(const std::string& tendon, const std::string& behind = "") {
  return "<robot name='crane'>\n<link name='base'/>\n"
         "<link name='load'><inertial><mass value='1'/>"
         "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\n"
         "<joint name='flight' type='floating'><parent link='base'/><child link='load'/><origin xyz='0 0 "
         "-2'/></joint>\n"
         "<tendon " +
         tendon + "</tendon>\n" + behind + "</robot>";
}
const std::string kVias = "<via link='base'/><via link='load' at='0 0 0.1'/>";

const TendonDescription& tendon_of(const ReadResult& result) {
  return dynamic_cast<const TendonDescription&>(*result.scene.value().force_elements.at(0));
}

}  // namespace

TEST(TendonReader, ReadsGuides) {
  const ReadResult result = read(
      scene_of("name='rope' ea='2e4' damping='5' rest_length='2-0.1*t'><via link='base' at='0 0 1' friction='0.2'/>"
               "<pulley link='base' at='1 0 0' axis='0 2 0' radius='0.3' side='right' wrap='3'/>"
               "<vias link='load' from='0 0 0' to='0 0 0.2' count='3' radius='0.1' twist='3.14159265358979'/>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const TendonDescription& tendon = tendon_of(result);
  EXPECT_EQ(tendon.name, "rope");
  EXPECT_EQ(tendon.stiffness, 2e4);
  EXPECT_EQ(tendon.damping, 5);
  EXPECT_EQ((*tendon.rest_length)(10), 1);
  ASSERT_EQ(tendon.guides.size(), 5u);
  EXPECT_EQ(tendon.guides[0].friction, 0.2);
  EXPECT_EQ(tendon.guides[0].radius, 0);
  EXPECT_EQ(tendon.guides[1].axis, Vector3(0, 1, 0));
  EXPECT_EQ(tendon.guides[1].radius, 0.3);
  EXPECT_EQ(tendon.guides[1].wrap, 3);
  EXPECT_FALSE(tendon.guides[1].turns_left);
  // A helix about z that begins on y and turns by half a turn about z: to -x and -y.
  EXPECT_TRUE(tendon.guides[2].at.isApprox(Vector3(0, 0.1, 0)));
  EXPECT_TRUE(tendon.guides[3].at.isApprox(Vector3(-0.1, 0, 0.1)));
  EXPECT_TRUE(tendon.guides[4].at.isApprox(Vector3(0, -0.1, 0.2)));
}

TEST(TendonReader, PulleysTurnLeftAboutZIfNothingElseIsGiven) {
  const ReadResult result = read(scene_of("ea='1'><via link='base'/><pulley link='load' radius='0.1' grips='true'/>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(tendon_of(result).guides.at(1).axis, Vector3::UnitZ());
  EXPECT_TRUE(tendon_of(result).guides[1].turns_left);
}

TEST(TendonReader, AWinchIsAJointThatPaysOut) {
  const ReadResult result = read(scene_of("name='rope' ea='100'>" + kVias,
                                          "<winch name='hoist' tendon='rope'><limit lower='-1' upper='2' effort='9'"
                                          " velocity='1'/><drive rotor_inertia='0.2'/></winch>"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(tendon_of(result).reels.at(0), "hoist_reel");
  const JointDescription& joint = result.scene->joints.at(1);
  EXPECT_EQ(joint.name, "hoist");
  EXPECT_EQ(joint.kind, JointKind::Prismatic);
  EXPECT_EQ(joint.parent, "base");
  EXPECT_EQ(joint.limits.value().lower, -1);
  EXPECT_EQ(result.scene->drives.at(0).coordinate, "hoist");
  const Simulation simulation(*result.scene);
  EXPECT_TRUE(simulation.find_coordinate("hoist"));
}

TEST(TendonReader, ReportsErrors) {
  const std::string in = "scene.urdf:5: ", named = "<tendon> 'rope'";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {scene_of("name='rope' ea='1'><via link='base'/>"), in + named + ": needs at least two <via> or <pulley>"},
      {scene_of("name='rope'>" + kVias), in + named + ": attribute 'ea' is missing"},
      {scene_of("name='rope' ea='-1'>" + kVias), in + named + ": ea must be > 0, got '-1'"},
      {scene_of("name='rope' ea='1' rest_length='-1'>" + kVias),
       in + named + ": rest_length must be > 0 at t = 0, got '-1'"},
      {scene_of("name='rope' tension='1' damping='3'>" + kVias),
       in + named + ": a tendon of given tension has no such attribute, got '3'"},
      {scene_of("name='rope' ea='1'><via link='base'/><pulley link='load' axis='0 1 0' radius='0.1'/>"),
       in + named + ": must not begin or end on a pulley without grips=\"true\""},
      {scene_of("name='rope' ea='1'>" + kVias, "<winch name='w' tendon='tope'/>"),
       "scene.urdf:6: <winch> 'w': tendon must be the name of a <tendon> (rope), got 'tope'"},
      {scene_of("name='rope' tension='1'>" + kVias, "<winch name='w' tendon='rope'/>"),
       "scene.urdf:6: <winch> 'w': a tendon of given tension has no length to pay out: give it ea, got 'rope'"},
      {scene_of("name='rope' ea='1'>" + kVias, "<winch name='flight' tendon='rope'/>"),
       "scene.urdf:6: <winch> 'flight': the name of its coordinate is taken by a joint, got 'flight'"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(findings_of(text), expected);
  }
}

}  // namespace flexarm::scene
