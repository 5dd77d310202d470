/// Tests files with elements of other programs. They are read, with a warning where the meaning is clear.

#include <algorithm>
#include <vector>

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// Returns a scene with the world and the bodies a and b below it; `more` has their joints and more, from line 2 on.
std::string scene_of(const std::string& more) {
  std::string text = R"(<robot name="r"><link name="world"/>)";
  for (const std::string name : {"a", "b"})
    text +=
        "<link name=\"" + name +
        R"("><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)";
  return text + "\n" + more + "</robot>\n";
}

std::string joint_to(const std::string& name, const std::string& child, const std::string& type,
                     const std::string& more) {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"world\"/><child link=\"" + child + "\"/>" +
         more + "</joint>\n";
}

const std::string kFree = joint_to("i", "a", "continuous", "") + joint_to("j", "b", "continuous", "");

std::string limit(double lower, double upper) {
  return "<limit lower=\"" + std::to_string(lower) + "\" upper=\"" + std::to_string(upper) +
         R"(" effort="1" velocity="1"/>)";
}

/// Returns all messages, and checks that all of them are warnings.
std::vector<std::string> said(const ReadResult& result) {
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
  std::vector<std::string> texts;
  for (const Diagnostic& finding : result.diagnostics) texts.push_back(finding.text());
  return texts;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST(ForeignFiles, LimitsBelowZeroAreNone) {
  const ReadResult result =
      read(scene_of(joint_to("i", "a", "revolute", R"(<limit lower="-1" upper="1" effort="-1" velocity="-1"/>)") +
                    joint_to("j", "b", "continuous", R"(<limit effort="-1" velocity="2"/>)")));
  EXPECT_EQ(said(result),
            (Texts{"scene.urdf:2: warning: <limit> of joint 'i': effort below 0 is read as no limit, got '-1'",
                   "scene.urdf:2: warning: <limit> of joint 'i': velocity below 0 is read as no limit, got '-1'",
                   "scene.urdf:3: warning: <limit> of joint 'j': effort below 0 is read as no limit, got '-1'"}));
  EXPECT_EQ(result.scene->joints[0].effort_limit, 0);
  EXPECT_EQ(result.scene->joints[0].limits->velocity, 0);
  EXPECT_EQ(result.scene->joints[0].limits->lower, -1);
}

TEST(ForeignFiles, WhatHasNoEffectIsNotJudged) {
  const std::string end = joint_to("j", "b", "continuous", "");
  EXPECT_EQ(said(read(scene_of(joint_to("i", "a", "fixed", R"(<axis xyz="0 0"/><axis xyz="2"/>)") + end))), Texts());
  EXPECT_EQ(said(read(scene_of(joint_to("i", "a", "floating", R"(<axis xyz="0 0 z"/>)") + end))), Texts());
  for (const std::string& more :
       {R"(<limit lower="1" upper="x" effort="none" velocity="2"/>)", R"(<dynamics damping="-1" friction="?"/>)"}) {
    const ReadResult result = read(scene_of(joint_to("i", "a", "fixed", more) + end));
    ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
    EXPECT_EQ(result.scene->joints[0].effort_limit, 0);
    EXPECT_EQ(result.scene->joints[0].damping, 0);
  }
  expect_warning(read(scene_of(joint_to("i", "a", "fixed", "<mimic/>") + end)), 2, "<mimic> of joint 'i': is ignored");
}

TEST(ForeignFiles, FollowersOfFixedJointsAreHeld) {
  const ReadResult result = read(scene_of(
      joint_to("drive", "a", "fixed", "") +
      joint_to("right", "b", "revolute", limit(-1, 1) + R"(<mimic joint="drive" multiplier="2" offset="0.3"/>)")));
  EXPECT_EQ(said(result),
            (Texts{"scene.urdf:3: warning: <joint> 'right': is held at 0.3, since the joint that it mimics "
                   "is fixed, got 'drive'"}));
  ASSERT_EQ(result.scene->motions.size(), 1u);
  EXPECT_EQ(result.scene->motions[0].coordinate, "right");
  EXPECT_EQ(result.scene->motions[0].position.constant(), 0.3);
}

TEST(ForeignFiles, FollowersOfTheirsAreHeldAsWell) {
  const ReadResult result =
      read(R"(<robot name="r"><link name="world"/><link name="a"/><link name="b"/><link name="c"/>)" +
           joint_to("i", "a", "continuous", R"(<mimic joint="j" multiplier="-2" offset="1"/>)") +
           joint_to("j", "b", "continuous", R"(<mimic joint="k" multiplier="7" offset="0.25"/>)") +
           joint_to("k", "c", "fixed", "") + "</robot>");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  ASSERT_EQ(result.scene->motions.size(), 2u);
  EXPECT_EQ(result.scene->motions[0].position.constant(), 0.5);  // 1 - 2 * 0.25
  EXPECT_EQ(result.scene->motions[1].position.constant(), 0.25);
}

TEST(ForeignFiles, LimitsThatAMimicDoesNotKeepAreTold) {
  const auto gripper = [](const std::string& master, const std::string& follower, const std::string& law) {
    return said(read(scene_of(joint_to("left", "a", "prismatic", master) +
                              joint_to("right", "b", "prismatic", follower + "<mimic joint=\"left\" " + law + "/>"))));
  };
  EXPECT_EQ(
      gripper(limit(-1, 1), limit(-0.02, 0.02), "multiplier=\"-1\""),
      (Texts{"scene.urdf:3: warning: <joint> 'right': its own limits are not kept, since it follows 'left' alone, "
             "which lets it go from -1 to 1, got '-0.02' to '0.02'"}));
  EXPECT_EQ(gripper(limit(0, 0.02), limit(-0.02, 0), "multiplier=\"-1\""), Texts());
  EXPECT_EQ(gripper(limit(0, 0.02), limit(0, 0.05), "multiplier=\"2\" offset=\"0.01\""), Texts());  // 0.01 to 0.05
  EXPECT_EQ(gripper(limit(0, 0.02), limit(0, 0.05), "multiplier=\"2\" offset=\"0.02\"").size(), 1u);
  EXPECT_EQ(gripper(limit(0, 1.571), limit(0, 1.57), "").size(), 0u);  // rounded limits
  const std::string hinge = joint_to("left", "a", "continuous", "");
  EXPECT_EQ(
      said(read(scene_of(hinge + joint_to("right", "b", "revolute", limit(-1, 1) + "<mimic joint=\"left\"/>")))),
      (Texts{"scene.urdf:3: warning: <joint> 'right': its own limits are not kept, since it follows 'left' alone, "
             "which has no limits, got '-1' to '1'"}));
}

TEST(ForeignFiles, LoopsOfTwoLinksAreRead) {
  const auto loop = [](const std::string& type, const std::string& more = "") {
    return read(
        scene_of(kFree + "<loop_joint name=\"close\"" + type +
                 R"(><link1 link="a" xyz="0.2 0 0" rpy="0 0 1.5707963267948966"/><link2 link="b" xyz="0 0.1 0"/>)" +
                 more + "</loop_joint>"));
  };
  const ReadResult ball = loop(R"( type="spherical")");
  EXPECT_EQ(said(ball),
            (Texts{"scene.urdf:4: warning: <loop_joint> 'close': <link1> and <link2>, the form of Drake and "
                   "Isaac Sim, are read as a loop joint of type 'spherical' with <parent> and <origin>, "
                   "<child> and <child_origin>"}));
  ASSERT_EQ(ball.scene->loop_joints.size(), 1u);
  const JointDescription& joint = ball.scene->loop_joints[0];
  EXPECT_EQ(joint.name, "close");
  EXPECT_EQ(joint.kind, JointKind::Spherical);
  EXPECT_EQ(joint.parent, "a");
  EXPECT_EQ(joint.child, "b");
  EXPECT_EQ(joint.origin.position, Vector3(0.2, 0, 0));
  EXPECT_LT((joint.origin.orientation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(joint.child_origin.position, Vector3(0, 0.1, 0));
  EXPECT_EQ(loop("").scene->loop_joints[0].kind, JointKind::Spherical);
  const ReadResult hinge = loop(R"( type="continuous")", R"(<axis xyz="0 0 2"/>)");
  EXPECT_EQ(hinge.scene->loop_joints[0].kind, JointKind::Continuous);
  EXPECT_EQ(hinge.scene->loop_joints[0].axis, Vector3::UnitZ());
}

TEST(ForeignFiles, LoopsInsideGazeboAreTold) {
  const auto inside = [](const std::string& parent, const std::string& child) {
    return said(read(scene_of(kFree + "<gazebo><joint name=\"x\" type=\"revolute\"><parent>" + parent +
                              "</parent><child>" + child + "</child></joint></gazebo>")));
  };
  const Texts told{
      "scene.urdf:4: warning: <joint> 'x': closes a loop in Gazebo only, between the links 'a' and 'b': a "
      "<loop_joint> of <robot>, which Gazebo ignores, closes it in flexarm"};
  EXPECT_EQ(inside("a", "b"), told);
  EXPECT_EQ(inside("r::a", " r::b "), told);
  EXPECT_EQ(inside("world", "b"), Texts());  // joint j again
  EXPECT_EQ(inside("a", "wheel"), Texts());  // a link that only Gazebo has
}

TEST(ForeignFiles, StrangersAreToldOnceWithTheNearestName) {
  const auto said_of = [](const std::string& element) { return said(read(scene_of(kFree + element))); };
  const auto told = [](const std::string& tag, const std::string& words) {
    return Texts{"scene.urdf:4: warning: <" + tag + "> of robot 'r': has no effect" + words};
  };
  const std::string unknown = ": no known program uses it here";
  EXPECT_EQ(said_of("<contact/><contact/>"), told("contact", " here: it belongs in <link>"));
  EXPECT_EQ(said_of("<senser name=\"s\"/>"), told("senser", unknown + "; is <sensor> meant?"));
  EXPECT_EQ(said_of("<spring_ joint=\"i\"/>"), told("spring_", unknown + "; is <spring> meant?"));
  EXPECT_EQ(said_of("<Simulation/>"), told("Simulation", unknown + "; is <simulation> meant?"));
  EXPECT_EQ(said_of("<create/>"), told("create", unknown));
  EXPECT_EQ(said_of("<axis/>"), told("axis", " here: it belongs in <joint>"));
  EXPECT_EQ(said_of("<gazebo/><transmission/><material name=\"m\"/><mujoco/><ros2_control/><group/><drake:x/>").size(),
            1u);  // the warning: urdfdom expects the material to have a color
}

TEST(ForeignFiles, MisspeltWordsOfUrdfAreToldOnceWithTheNearestOne) {
  const auto said_of = [](const std::string& in_joint, const std::string& more) {
    return said(read(scene_of(joint_to("i", "a", "continuous", in_joint + in_joint) +
                              joint_to("j", "b", "continuous", in_joint) + more)));
  };
  const auto child = [](const std::string& name, const std::string& meant) {
    return Texts{"scene.urdf:2: warning: <" + name + "> of joint 'i': has no effect: <joint> has no such child; is <" +
                 meant + "> meant?"};
  };
  const auto attribute = [](const std::string& element, const std::string& name, const std::string& meant) {
    return Texts{"scene.urdf:2: warning: <" + element + "> of joint 'i': unknown attribute; is '" + meant +
                 "' meant?, got '" + name + "'"};
  };
  EXPECT_EQ(said_of("<orign xyz=\"1 0 0\"/>", ""), child("orign", "origin"));
  EXPECT_EQ(said_of("<axs/>", ""), child("axs", "axis"));
  EXPECT_EQ(said_of("<Limit/>", ""), child("Limit", "limit"));
  EXPECT_EQ(said_of("<mimik joint=\"j\"/>", ""), child("mimik", "mimic"));
  const Texts swapped = said(read(scene_of(joint_to("i", "a", "continuous", "<origin xzy=\"1 0 0\"/>") +
                                           joint_to("j", "b", "continuous", "<origin xzy=\"1 0 0\"/>"))));
  EXPECT_EQ(swapped, attribute("origin", "xzy", "xyz"));
  EXPECT_EQ(said(read(scene_of(joint_to("i", "a", "continuous", "<dynamics friction=\"1\" dampng=\"1\"/>") +
                               joint_to("j", "b", "continuous", "")))),
            attribute("dynamics", "dampng", "damping"));
  const std::string link = joint_to("k", "c", "fixed", "") +
                           "<link name=\"c\"><inertal/><visual><orgin/><geometry><sphere radus=\"1\" "
                           "radius=\"1\"/></geometry></visual></link>";
  EXPECT_EQ(
      said_of("", link),
      (Texts{"scene.urdf:5: warning: <inertal> of link 'c': has no effect: <link> has no such child; is <inertial> "
             "meant?",
             "scene.urdf:5: warning: <orgin> of link 'c': has no effect: <visual> has no such child; is <origin> "
             "meant?",
             "scene.urdf:5: warning: <sphere> of link 'c': unknown attribute; is 'radius' meant?, got 'radus'"}));
  // A word that is not close to any word of URDF, or has a namespace, belongs to another program.
  EXPECT_EQ(said_of("<hardware interface=\"x\"/><drake:axs/>", "").size(), 0u);
}

TEST(ForeignFiles, UrdfdomRefusesOnlyWhatItRefuses) {
  const ReadResult result = read(good_scene_with(R"(<box size="1 1 1"/>)", R"(<bocks/>)"));
  EXPECT_EQ(said(result),
            (Texts{"scene.urdf:19: warning: <visual> of link 'upper': programs that use urdfdom cannot read "
                   "it, got 'Unknown geometry type 'bocks''"}));
}

TEST(ForeignFiles, SensorsThatShareATopicAreTold) {
  const auto sensor = [](const std::string& name) {
    return "<sensor name=\"" + name + "\" kind=\"imu\" link=\"a\"/>\n";
  };
  EXPECT_EQ(
      said(read(scene_of(kFree + sensor("a b") + sensor("a-b")))),
      (Texts{"scene.urdf:5: warning: <sensor> 'a-b': shares the topic 'sensors/a_b' with sensor 'a b' (line 4): in "
             "topics and bags, characters other than letters, digits and _ become _"}));
  EXPECT_EQ(said(read(scene_of(kFree + sensor("a_b") + sensor("ab")))), Texts());
}

// ---------------------------------------------------------------- what is not quite URDF, but has one plain meaning

TEST(ForeignFiles, TheFirstOfTwoElementsCounts) {
  const ReadResult result = read(
      scene_of(joint_to("i", "a", "continuous",
                        R"(<limit effort="10" velocity="1"/><dynamics damping="0.5"/><limit effort="30" velocity="1"/>)"
                        "\n"
                        R"(<dynamics damping="7"/>)") +
               joint_to("j", "b", "continuous", "")));
  EXPECT_EQ(said(result),
            (Texts{"scene.urdf:2: warning: <limit> of joint 'i': at most one <limit> is allowed here; the first one "
                   "counts, of line 2, and this one is ignored",
                   "scene.urdf:3: warning: <dynamics> of joint 'i': at most one <dynamics> is allowed here; the first "
                   "one counts, of line 2, and this one is ignored"}));
  EXPECT_EQ(result.scene->joints[0].effort_limit, 10);
  EXPECT_EQ(result.scene->joints[0].damping, 0.5);

  const std::string inertia = R"(<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/>)";
  const ReadResult two =
      read(good_scene_with(inertia, inertia + R"(<inertia ixx="9" ixy="0" ixz="0" iyy="9" iyz="0" izz="9"/>)"));
  expect_warning(two, 17, "the first one counts, of line 17, and this one is ignored");
  EXPECT_EQ(two.diagnostics.size(), 1u) << to_text(two.diagnostics);
  EXPECT_NEAR(two.scene->links[1].inertial->inertia.trace(), 0.055, 1e-15);
  const ReadResult bodies =
      read(good_scene_with("<inertial>\n", "<inertial> <mass value=\"7\"/> " + inertia + " </inertial> <inertial>\n"));
  expect_warning(bodies, 14, "<inertial> of link 'upper': at most one <inertial> is allowed here; the first one");
  EXPECT_EQ(bodies.scene->links[1].inertial->mass, 7);
}

TEST(ForeignFiles, ExchangedLimitsAreExchanged) {
  const ReadResult result =
      read(scene_of(joint_to("i", "a", "revolute", R"(<limit lower="0.5" upper="-1.5" effort="1" velocity="1"/>)") +
                    joint_to("j", "b", "continuous", "")));
  EXPECT_EQ(said(result),
            (Texts{"scene.urdf:2: warning: <limit> of joint 'i': lower must be <= upper: the two are exchanged, got "
                   "lower '0.5', upper '-1.5'"}));
  EXPECT_EQ(result.scene->joints[0].limits->lower, -1.5);
  EXPECT_EQ(result.scene->joints[0].limits->upper, 0.5);
}

TEST(ForeignFiles, JointsWithoutLimitsHaveNoStops) {
  const ReadResult result = read(scene_of(joint_to("i", "a", "revolute", "") + joint_to("j", "b", "prismatic", "")));
  expect_warning(result, 2,
                 "<joint> 'i': <limit lower=\"...\" upper=\"...\" effort=\"...\" velocity=\"...\"/> is missing: the "
                 "revolute joint has no stops");
  expect_warning(result, 3, "is missing: the prismatic joint has no stops");
  for (const JointDescription& joint : result.scene->joints) EXPECT_FALSE(joint.limits);
}

TEST(ForeignFiles, LimitsThatLookLikeDegreesAreTold) {
  const auto told = [](const std::string& type, const std::string& lower, const std::string& upper) {
    const ReadResult result = read(scene_of(
        joint_to("i", "a", type, "<limit lower=\"" + lower + "\" upper=\"" + upper + R"(" effort="1" velocity="1"/>)") +
        joint_to("j", "b", "continuous", "")));
    return said(result);
  };
  EXPECT_EQ(told("revolute", "-90", "180"),
            (Texts{"scene.urdf:2: warning: <limit> of joint 'i': lower and upper look like degrees, but are in rad, "
                   "and so 43 turns apart, got lower '-90', upper '180'"}));
  EXPECT_EQ(told("revolute", "0", "45").size(), 1u);
  EXPECT_EQ(told("revolute", "-10", "10"), Texts()) << "three turns";
  EXPECT_EQ(told("revolute", "-62.8318", "62.8318"), Texts()) << "ten turns";
  EXPECT_EQ(told("revolute", "-1000", "1000"), Texts()) << "as good as none";
  EXPECT_EQ(told("prismatic", "0", "90"), Texts()) << "metres";
}

TEST(ForeignFiles, AMassWithoutInertiaIsAPoint) {
  const ReadResult result =
      read(good_scene_with(R"(<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/>)", ""));
  expect_warning(result, 14, "<inertial> of link 'upper': <inertia> is missing: its mass is a point");
  EXPECT_EQ(result.scene->links[1].inertial->mass, 2);
  EXPECT_TRUE(result.scene->links[1].inertial->inertia.isZero(0));
}

TEST(ForeignFiles, RoundedMomentsBelowZeroBecomeZero) {
  // Principal moments -0.001, 1 and 1, turned about z by 45 degrees. The nearest inertia without a negative one has the
  // moments 0, 1 and 1.
  const auto inertia = [](const std::string& xx, const std::string& xy) {
    return "<inertia ixx=\"" + xx + "\" ixy=\"" + xy + "\" ixz=\"0\" iyy=\"" + xx + R"(" iyz="0" izz="1"/>)";
  };
  const std::string good = R"(<origin xyz="0.1 0 0" rpy="0 0 0"/>)";
  const auto scene = [&](const std::string& element) {
    return R"(<robot name="r"><link name="world"/><joint name="j" type="continuous"><parent link="world"/>)"
           R"(<child link="a"/></joint><link name="a"><inertial><mass value="1"/>)"
           "\n" +
           element + "</inertial></link></robot>";
  };
  const ReadResult result = read(scene(inertia("0.4995", "-0.5005")));
  EXPECT_EQ(result.diagnostics.size(), 1u);
  expect_warning(result, 2,
                 "<inertia> of link 'a': principal moments of inertia must be >= 0: 0.001 of the largest one below 0 "
                 "counts as rounded numbers, and 0 is taken instead, got '-0.00");
  Matrix3 nearest;
  nearest << 0.5, -0.5, 0, -0.5, 0.5, 0, 0, 0, 1;
  EXPECT_LT((result.scene->links[1].inertial->inertia - nearest).norm(), 1e-14);
  expect_one_error(scene(inertia("0.48", "-0.52")), 2, "principal moments of inertia must be >= 0");
}

TEST(ForeignFiles, TheWorldIsDeclaredIfNobodyDoesIt) {
  const auto robot = [](const std::string& base, const std::string& parent) {
    return "<robot name=\"r\">" + base + "<link name=\"a\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"" +
           parent + "\"/><child link=\"a\"/></joint></robot>";
  };
  const ReadResult result = read(robot("", "world"));
  expect_warning(result, 2,
                 "<joint> 'j': its parent is no link of the scene; <link name=\"world\"/> is added, as the root, got "
                 "'world'");
  EXPECT_EQ(result.scene->root_link, "world");
  ASSERT_EQ(result.scene->links.size(), 2u);
  expect_one_error(robot("", "map"), 2, "parent must be a link of the scene (a), got 'map'");
  expect_one_error(robot("<link name=\"base\"/>", "world"), 2, "parent must be a link of the scene");
}

TEST(ForeignFiles, PointersOfGitLfsAreNotFiles) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1\nsize 12345\n";
  EXPECT_EQ(findings_of(pointer),
            "scene.urdf:1: this is a Git LFS pointer, not the file: 'git lfs pull' fetches it, got 'version "
            "https://git-lfs.github.com/spec/v1'");
}

TEST(ForeignFiles, ShapesThatCannotTouchAreTold) {
  const auto foot = [](const std::string& shape, const std::string& contact) {
    return said(read(R"(<robot name="r"><link name="world"/><ground name="floor"/>)" + contact +
                     "<link name=\"foot\">\n<collision><geometry>" + shape + "</geometry></collision></link>" +
                     R"(<joint name="j" type="fixed"><parent link="world"/><child link="foot"/></joint></robot>)"));
  };
  const std::string contact = R"(<contact first="*" second="floor"/>)";
  const auto told = [](const std::string& shape) {
    return "scene.urdf:2: warning: <collision> of link 'foot': touches nothing: its shape must be a box, cylinder "
           "or mesh that has an extent, or a sphere, got '" +
           shape + "'";
  };
  EXPECT_EQ(foot("<sphere radius=\"0\"/>", contact), Texts()) << "a point";
  EXPECT_EQ(foot("<box size=\"1 0 1\"/>", contact), Texts{told("<box size=\"1 0 1\"/>")});
  EXPECT_EQ(foot("<box size=\"1 0 1\"/>", ""), Texts()) << "nothing could touch it";
  EXPECT_EQ(foot("<sphere radius=\"1\"/>", contact), Texts());
  const Texts capsule = foot("<capsule radius=\"1\" length=\"2\"/>", contact);
  EXPECT_EQ(std::count(capsule.begin(), capsule.end(), told("<capsule radius=\"1\" length=\"2\"/>")), 1);
}

}  // namespace flexarm::scene
