/// Tests the start of a mechanism: outside limits, at the nearest limit, and with a floating root link.

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// Returns a leg whose knee (line 5) starts outside its limits, unless <initial> (line 9) or another element changes
/// this.
std::string leg(const std::string& entries, const std::string& simulation = "<simulation>") {
  return R"(<robot name="leg">
  <link name="trunk"/> <link name="thigh"/> <link name="shank"/>
  <joint name="hip" type="revolute"> <parent link="trunk"/> <child link="thigh"/>
    <limit lower="-1" upper="1" effort="0" velocity="0"/> </joint>
  <joint name="knee" type="revolute"> <parent link="thigh"/> <child link="shank"/>
    <limit lower="-2.5" upper="-0.75" effort="0" velocity="0"/> </joint>
  )" + simulation +
         "\n\n    " + entries + "\n  </simulation>\n</robot>\n";
}

std::optional<double> initial_position(const SceneDescription& scene, const std::string& coordinate) {
  for (const InitialJoint& initial : scene.initial_joints)
    if (initial.coordinate == coordinate) return initial.position;
  return std::nullopt;
}

void expect_silent(const ReadResult& result) {
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
}

}  // namespace

TEST(Start, OutsideLimitsIsAWarning) {
  const ReadResult silent = read(leg(""));
  EXPECT_EQ(silent.diagnostics.size(), 1u);
  expect_warning(silent, 5, "<joint> 'knee': starts outside its limits, -2.5 to -0.75, and its stop will push it back");
  expect_warning(silent, 5, "got '0'");
  const ReadResult given = read(leg(R"(<initial joint="knee" position="-3"/>)"));
  EXPECT_EQ(given.diagnostics.size(), 1u);
  expect_warning(given, 9, "got '-3'");
  EXPECT_EQ(initial_position(*given.scene, "knee"), -3);
}

TEST(Start, OnALimitOrWithoutStopsIsNone) {
  expect_silent(read(leg(R"(<initial joint="knee" position="-0.75"/>)")));
  expect_silent(read(leg(R"(<motion joint="knee" position="0"/>)")));
  std::string mimicking = leg("");
  const std::string limit = R"(<limit lower="-2.5")";
  mimicking.replace(mimicking.find(limit), limit.size(), R"(<mimic joint="hip"/>)" + limit);
  const ReadResult follower = read(mimicking);  // only of its own limits
  EXPECT_EQ(follower.diagnostics.size(), 1u) << to_text(follower.diagnostics);
  expect_warning(follower, 5, "its own limits are not kept, since it follows 'hip' alone");
}

TEST(Start, VelocityLeavesASliderAtItsStart) {
  const auto runner = [](const std::string& initial) {
    const ReadResult result = read(R"(<robot name="r"> <link name="world"/> <link name="line"> <beam>
      <centerline> <line to="2 0 0"/> </centerline> <circle radius="0.01"/>
      <material young="70e9" poisson="0.33" density="2700"/> </beam> </link> <link name="bead"/>
      <joint name="clamp" type="fixed"> <parent link="world"/> <child link="line"/> </joint>
      <joint name="run" type="floating"> <parent link="line"/> <child link="bead"/> <slide start="1.5"/> </joint>
      <simulation>)" + initial + "</simulation> </robot>");
    return initial_position(result.scene.value(), "run/s");
  };
  EXPECT_EQ(runner(R"(<initial joint="run/s" velocity="2"/>)"), 1.5);
  EXPECT_EQ(runner(R"(<initial joint="run/s" position="0.5" velocity="2"/>)"), 0.5);
  EXPECT_EQ(runner(R"(<initial joint="run/s" position="0" velocity="2"/>)"), 0);
}

TEST(Start, ClampOfOneJoint) {
  const ReadResult result = read(leg(R"(<initial joint="knee" position="clamp" velocity="1"/>)"));
  expect_silent(result);
  EXPECT_EQ(initial_position(*result.scene, "knee"), -0.75);
  EXPECT_EQ(result.scene->initial_joints.at(0).velocity, 1);
  EXPECT_EQ(initial_position(*read(leg(R"(<initial joint="hip" position="clamp"/>)")).scene, "hip"), 0);
}

TEST(Start, ClampOfAllJointsLeavesGivenPositions) {
  const auto read_clamped = [](const std::string& entries) {
    return read_scene_text(leg(entries), "scene.urdf", {true, false});
  };
  for (const ReadResult& result : {read_clamped(""), read(leg("", R"(<simulation start="clamp">)")),
                                   read_clamped(R"(<initial joint="knee" velocity="1"/>)")}) {
    expect_silent(result);
    EXPECT_EQ(initial_position(*result.scene, "knee"), -0.75);
    EXPECT_EQ(initial_position(*result.scene, "hip"), std::nullopt);
  }
  const ReadResult given = read_clamped(R"(<initial joint="knee" position="-3"/>)");
  EXPECT_EQ(initial_position(*given.scene, "knee"), -3);
  expect_warning(given, 9, "starts outside its limits");
}

TEST(Start, ClampErrors) {
  const auto expect = [](const std::string& entry, const std::string& fragment) {
    expect_one_error(good_scene_with("  </simulation>", entry + "</simulation>"), 68, fragment);
  };
  expect(R"(<initial joint="wrist/1" position="clamp"/>)", "only for a joint with lower and upper limits");
  expect(R"(<initial joint="finger" position="clamp"/>)",
         "a joint that mimics another one, 'shoulder', has no coordinate");
  expect(R"(<initial joint="knee" position="clamp"/>)", "joint must be the name of a joint's coordinate (elbow, ");
  expect_one_error(good_scene_with("<simulation>", R"(<simulation start="here">)"), 58,
                   "start must be one of given, clamp, got 'here'");
  expect_one_error(good_scene_with("<simulation>", R"(<simulation massless="yes">)"), 58,
                   "massless must be one of refuse, lock, got 'yes'");
}

TEST(Start, MasslessJointsAreLockedOnDemand) {
  EXPECT_FALSE(read(kGoodScene).scene->lock_massless);
  EXPECT_TRUE(read(good_scene_with("<simulation>", R"(<simulation massless="lock">)")).scene->lock_massless);
  EXPECT_TRUE(read_scene_text(kGoodScene, "scene.urdf", {false, true}).scene->lock_massless);
}

TEST(Start, EquilibriumIsOnDemand) {
  EXPECT_FALSE(read(leg("")).scene->starts_in_equilibrium);
  EXPECT_FALSE(read(leg(R"(<initial equilibrium="false"/>)")).scene->starts_in_equilibrium);
  EXPECT_TRUE(read(leg(R"(<initial equilibrium="true"/>)")).scene->starts_in_equilibrium);
  EXPECT_TRUE(read_scene_text(leg(""), "scene.urdf", {false, false, true}).scene->starts_in_equilibrium);
  const auto expect = [](const std::string& entry, const std::string& fragment) {
    expect_one_error(good_scene_with("<simulation>", "<simulation> " + entry), 58, fragment);
  };
  expect(R"(<initial equilibrium="yes"/>)", "equilibrium must be one of true, false, got 'yes'");
  expect(R"(<initial equilibrium="true" joint="knee"/>)", "unknown attribute");
  expect(R"(<initial velocity="1"/>)", "one of the attributes 'joint', 'link' and 'equilibrium' is expected");
}

namespace {

/// Returns a base of 3 kg with a hand.
std::string base(const std::string& entries, const std::string& hand = "hand") {
  return R"(<robot name="drone">
  <link name="base"> <inertial> <mass value="3"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <link name=")" +
         hand + R"("/> <joint name="grip" type="fixed"> <parent link="base"/> <child link=")" + hand +
         "\"/> </joint>\n  <simulation>\n    " + entries + "\n  </simulation>\n</robot>\n";
}

}  // namespace

TEST(Start, AClampedRootLinkWithAMassIsAWarning) {
  const ReadResult result = read(base(""));
  EXPECT_EQ(result.diagnostics.size(), 1u);
  expect_warning(result, 2, "<link> 'base': the root link is clamped, though it and what is fixed to it have a mass");
  expect_warning(result, 2, "got '3' kg");
  EXPECT_EQ(result.scene->root_link, "base");
  expect_silent(read(base(R"(<root type="clamped"/>)")));
  // With exchanged names, 3 kg are fixed to a root without mass, which needs a warning, and then to a root called
  // "world", which needs none.
  const auto below = [](const std::string& root) {
    std::string text = base("", root);
    const std::string parent = "<parent link=\"base\"/> <child link=\"" + root + "\"/>";
    return read(
        text.replace(text.find(parent), parent.size(), "<parent link=\"" + root + "\"/> <child link=\"base\"/>"));
  };
  expect_warning(below("footprint"), 4, "<link> 'footprint': the root link is clamped");
  expect_silent(below("world"));
}

TEST(Start, FloatingRoot) {
  const ReadResult result = read(base(R"(<root type="floating"/> <initial joint="root/z" position="2"/>)"));
  expect_silent(result);
  const SceneDescription& scene = *result.scene;
  EXPECT_EQ(scene.root_link, "world");
  EXPECT_EQ(scene.links.back().name, "world");
  EXPECT_EQ(scene.joints.back().name, "root");
  EXPECT_EQ(scene.joints.back().kind, JointKind::Floating);
  EXPECT_EQ(scene.joints.back().parent, "world");
  EXPECT_EQ(scene.joints.back().child, "base");
  expect_silent(read(base(R"(<root type="floating"/> <initial link="base" linear="1 0 0"/>)")));
}

TEST(Start, RootErrors) {
  expect_one_error(base(R"(<root/>)"), 6, "<root> of simulation: attribute 'type' is missing");
  expect_one_error(base(R"(<root type="free"/>)"), 6, "type must be one of clamped, floating, got 'free'");
  expect_one_error(base(R"(<root type="floating"/>)", "world"), 6,
                   "a floating root link needs the name 'world' for a link, which is already used in line 4");
  expect_one_error(good_scene_with("<!-- 2 -->", R"(<root type="floating"/>)"), 2, "<root> must be a child of");
}

}  // namespace flexarm::scene
