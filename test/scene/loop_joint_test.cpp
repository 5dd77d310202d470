// Tests <loop_joint>: how it is read, and its errors.
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// Returns a portal of a post, a lintel and a second post, whose foot is held by the loop joint. The loop joint starts
/// on line 7.
std::string portal(const std::string& loop, const std::string& simulation = "") {
  return R"(<robot name="portal">
  <link name="world"/> <link name="post"/> <link name="lintel"/>
  <link name="leg"> <beam> <centerline> <line to="0 0 -1"/> </centerline> <circle radius="0.01"/> <material young="70e9" poisson="0" density="2700"/> </beam> </link>
  <joint name="a" type="continuous"> <parent link="world"/> <child link="post"/> </joint>
  <joint name="b" type="continuous"> <parent link="post"/> <child link="lintel"/> <origin xyz="0 0 1"/> </joint>
  <joint name="c" type="continuous"> <parent link="lintel"/> <child link="leg"/> <origin xyz="1 0 0"/> </joint>
)" + loop +
         "\n<simulation>\n" + simulation + "</simulation></robot>";
}

std::string loop(const std::string& attributes, const std::string& children) {
  return "<loop_joint " + attributes + ">" + children + "</loop_joint>";
}

const std::string kLinks = R"(<parent link="world"/> <child link="leg"/>)";
const std::string kHinge = loop(R"(name="foot" type="continuous")", kLinks);

}  // namespace

TEST(LoopJoint, IsReadLikeAJoint) {
  const ReadResult result =
      read(portal(loop(R"(name="foot" type="floating")",
                       kLinks + R"(<origin xyz="1 0 0" rpy="0 0 0.5"/> <child_origin xyz="0 0 -1" rpy="0.1 0.2 0.3"/>
                     <axis xyz="0 2 0"/> <axis2 xyz="0 0 3"/> <release kind="universal"/>
                     <limit effort="5" velocity="1"/> <dynamics damping="0.1" friction="0.2"/>)")));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->joints.size(), 3u);
  ASSERT_EQ(result.scene->loop_joints.size(), 1u);
  const JointDescription& joint = result.scene->loop_joints[0];
  EXPECT_EQ(joint.name, "foot");
  EXPECT_EQ(joint.kind, JointKind::Universal);
  EXPECT_EQ(joint.parent, "world");
  EXPECT_EQ(joint.child, "leg");
  EXPECT_EQ(joint.origin.position, Vector3(1, 0, 0));
  EXPECT_NEAR(joint.origin.orientation.angularDistance(Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitZ()))), 0, 1e-7);
  EXPECT_EQ(joint.child_origin.position, Vector3(0, 0, -1));
  const Quaternion rpy =
      Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitZ()) * Eigen::AngleAxisd(0.2, Vector3::UnitY()) *
                 Eigen::AngleAxisd(0.1, Vector3::UnitX()));
  EXPECT_NEAR(joint.child_origin.orientation.angularDistance(rpy), 0, 1e-7);
  EXPECT_EQ(joint.axis, Vector3::UnitY());
  EXPECT_EQ(joint.axis2, Vector3::UnitZ());
  EXPECT_EQ(joint.effort_limit, 5);
  EXPECT_EQ(joint.damping, 0.1);
  EXPECT_EQ(joint.friction, 0.2);
  EXPECT_EQ(joint.location.line, 7);
  EXPECT_EQ(joint.location.file, "scene.urdf");
}

TEST(LoopJoint, EveryKind) {
  const auto kind_of = [](const std::string& type, const std::string& more) {
    const ReadResult result = read(portal(loop("name=\"foot\" type=\"" + type + "\"", kLinks + more)));
    // No other program reads a <loop_joint>, so nothing is said about them.
    EXPECT_TRUE(result.scene && result.diagnostics.empty()) << to_text(result.diagnostics);
    return result.scene ? result.scene->loop_joints[0].kind : JointKind::Slide;
  };
  const std::string limit = R"(<limit lower="-1" upper="1" effort="0" velocity="0"/>)", axis = R"(<axis xyz="0 0 1"/>)";
  EXPECT_EQ(kind_of("fixed", ""), JointKind::Fixed);
  EXPECT_EQ(kind_of("revolute", limit), JointKind::Revolute);
  EXPECT_EQ(kind_of("revolute", R"(<limit lower="-1" upper="1"/>)"), JointKind::Revolute);
  EXPECT_EQ(kind_of("prismatic", limit), JointKind::Prismatic);
  EXPECT_EQ(kind_of("planar", ""), JointKind::Planar);
  EXPECT_EQ(kind_of("spherical", ""), JointKind::Spherical);
  EXPECT_EQ(kind_of("floating", R"(<release kind="spherical"/>)"), JointKind::Spherical);
  EXPECT_EQ(kind_of("floating", R"(<release kind="cylindrical"/>)"), JointKind::Cylindrical);
  EXPECT_EQ(kind_of("floating", R"(<axis2 xyz="0 0 1"/> <release kind="pin_slot"/>)"), JointKind::PinSlot);
  EXPECT_EQ(kind_of("floating", axis + R"(<couple kind="screw" pitch="0.1"/>)"), JointKind::Screw);
}

TEST(LoopJoint, ItsCoordinatesHaveNames) {
  const ReadResult result = read(portal(kHinge, R"(<initial joint="foot" velocity="1"/>
    <effort joint="foot" history="2"/>)"));
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
  expect_one_error(portal(kHinge, R"(<effort joint="foot/1" history="2"/>)"), 9, "the name of a joint's coordinate");
  expect_one_error(portal(loop(R"(name="foot" type="floating")", kLinks + R"(<release kind="spherical"/>)"),
                          R"(<effort joint="foot" history="2"/>)"),
                   9, "joint must be one of 'foot/rx', 'foot/ry', 'foot/rz', got 'foot'");
}

TEST(LoopJoint, StartsAtZero) {
  const std::string message = "a <loop_joint> starts at 0, which is where the tree of joints places its links";
  expect_one_error(portal(kHinge, R"(<initial joint="foot" position="0.1"/>)"), 9, message);
  expect_one_error(portal(kHinge, R"x(<motion joint="foot" position="cos(t)"/>)x"), 9, message);
  EXPECT_TRUE(read(portal(kHinge, R"x(<motion joint="foot" position="sin(t)"/>)x")).scene);
}

TEST(LoopJoint, Structure) {
  const std::string name = R"(name="foot" type="fixed")";
  expect_one_error(portal(loop(name, R"(<parent link="world"/>)")), 7, "<child link=\"...\"/> is missing");
  expect_one_error(portal(loop(name, R"(<parent link="world"/> <child link="nobody"/>)")), 7,
                   "<loop_joint> 'foot': child must be a link of the scene (world, post, lintel, leg), got 'nobody'");
  expect_one_error(portal(loop(R"(name="b" type="fixed")", kLinks)), 7, "<loop_joint> 'b': name is taken, by line 5");
  expect_one_error(portal(loop(R"(name="foot" type="hinge")", kLinks)), 7, "type must be one of fixed, revolute");
  expect_one_error(portal(loop(R"(name="foot")", kLinks)), 7, "attribute 'type' is missing");
  expect_one_error(portal(loop(name + " kind=\"x\"", kLinks)), 7, "unknown attribute");
  expect_one_error(portal(loop(name, kLinks + "<releases/>")), 7, "unknown element");
  expect_one_error(portal(loop(name, kLinks + R"(<child_origin xyz="0 0"/>)")), 7,
                   "<child_origin> of loop_joint 'foot': xyz must be 3 finite numbers");
  expect_one_error(portal(loop(name, kLinks + R"(<child_origin/><child_origin xyz="1 0 0"/>)")), 7,
                   "at most one <child_origin>");
  expect_one_error(portal(loop(name, kLinks + R"(<mimic joint="a"/>)")), 7, "a <loop_joint> cannot have a <mimic>");
  expect_one_error(portal(loop(R"(name="foot" type="floating")", kLinks + R"(<slide start="0"/>)")), 7,
                   "a <loop_joint> cannot have a <slide>");
  expect_one_error(portal(loop(R"(name="foot" type="floating")", kLinks)), 7,
                   "a <loop_joint> must constrain something");
  expect_one_error(portal(loop(R"(name="foot" type="floating")", kLinks + R"(<release kind="free"/>)")), 7,
                   "a <loop_joint> must constrain something");
}

TEST(LoopJoint, Places) {
  expect_one_error(
      portal(
          R"(<link name="l"> <loop_joint/> </link> <joint name="d" type="fixed"> <parent link="world"/> <child link="l"/> </joint>)"),
      7, "<loop_joint> must be a child of <robot>");
  expect_one_error(
      portal(
          R"(<link name="l"/> <joint name="d" type="fixed"> <parent link="world"/> <child link="l"/> <child_origin/> </joint>)"),
      7, "<child_origin> must be a child of <loop_joint>");
}

TEST(LoopJoint, CannotBeMimicked) {
  expect_one_error(
      portal(
          kHinge +
          R"(<link name="l"/> <joint name="d" type="continuous"> <parent link="world"/> <child link="l"/> <mimic joint="foot"/> </joint>)"),
      7, "a <loop_joint> cannot be mimicked, got 'foot'");
}

}  // namespace flexarm::scene
