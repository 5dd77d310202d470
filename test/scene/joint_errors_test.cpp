/// Tests errors and warnings about joints and about the tree that they form.
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// Returns a scene with links a, b, c and the root link w, with these joints. Each joint is on a line of its own from
/// line 2 on.
std::string tree(const std::string& joints) {
  return R"(<robot name="r"><link name="w"/><link name="a"/><link name="b"/><link name="c"/>)"
         "\n" +
         joints + "</robot>";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& type = "fixed", const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + more + "</joint>\n";
}

std::string mimic(const std::string& name) {
  return "<mimic joint=\"" + name + "\"/>";
}

}  // namespace

TEST(JointErrors, HardnessOfStops) {
  const ReadResult read_so = read(good_scene_with(R"( velocity="4")", R"( velocity="4" contact_time="0.002")"));
  ASSERT_TRUE(read_so.scene);
  EXPECT_EQ(read_so.scene->joints[0].limits->contact_time, 0.002);
  EXPECT_FALSE(read_so.scene->joints[0].limits->stiffness);
  EXPECT_EQ(read(good_scene_with(R"( velocity="4")", R"( stiffness="9")")).scene->joints[0].limits->stiffness, 9);
  expect_error(R"( velocity="4")", R"( velocity="4" contact_time="0.002" stiffness="9")", 10,
               "the stiffness determines it; leave one of them out");
  expect_error(R"( velocity="4")", R"( velocity="4" contact_time="0")", 10, "contact_time must be > 0, got '0'");
}

TEST(JointErrors, Numbers) {
  expect_error(R"(<axis xyz="0 0 2"/>)", R"(<axis xyz="0 0 0"/>)", 9,
               "<axis> of joint 'shoulder': xyz must not be zero");
  expect_error(R"(<axis xyz="0 0 2"/>)", R"(<axis xyz="0 0"/>)", 9, "xyz must be 3 finite numbers, got '0 0'");
  expect_error(R"(<axis xyz="0 0 2"/>)", R"(<axis/>)", 9, "attribute 'xyz' is missing");
  expect_error(R"(xyz="0 0 0.5")", R"(xyz="0 0 0.5m")", 6,
               "<origin> of joint 'shoulder': xyz must be 3 finite numbers");
  expect_error(R"(lower="-1")", R"(lower="low")", 10,
               "<limit> of joint 'shoulder': lower must be a finite number, got 'low'");
  expect_error(R"(effort="30")", R"(effort="x")", 10, "effort must be a finite number, got 'x'");
  expect_error(R"(damping="0.1" f)", R"(damping="-0.1" f)", 11, "damping must be >= 0");
  expect_error(R"(friction="0.2")", R"(friction="1,5")", 11, "friction must be a finite number, got '1,5'");
  expect_error(R"(multiplier="-2")", R"(multiplier="-2x")", 50, "<mimic> of joint 'finger': multiplier must be");
}

TEST(JointErrors, WhatOnlyOtherProgramsNeedIsAWarning) {
  const auto expect = [](const std::string& from, const std::string& to, const std::string& fragment) {
    const ReadResult result = read(good_scene_with(from, to));
    expect_warning(result, 5, "<joint> 'shoulder': programs that use urdfdom cannot read it, got '" + fragment);
    expect_warning(result, 1, "programs that use urdfdom refuse this file, got '" + fragment);
  };
  expect(R"(effort="30")", "", "joint limit: no effort");
  expect(R"( velocity="4")", "", "joint limit: no velocity");
  expect(R"(<dynamics damping="0.1" friction="0.2"/>)", "<dynamics/>", "joint dynamics element specified with no");
  expect(R"(<dynamics)", R"(<safety_controller k_position="1"/><dynamics)", "joint safety: no k_velocity");
  EXPECT_EQ(read(good_scene_with(R"(effort="30")", "")).scene->joints[0].effort_limit, 0);
}

TEST(JointErrors, WhatComesTwiceAlikeIsAWarning) {
  const std::string axis = R"(<axis xyz="0 0 2"/>)";
  const ReadResult result = read(good_scene_with(axis, axis + axis));
  expect_warning(result, 9, "<axis> of joint 'shoulder': at most one <axis> is allowed here; the two are identical");
  EXPECT_EQ(result.diagnostics.size(), 1u);
}

TEST(JointErrors, BulletsSphericalTypeIsAWarning) {
  const ReadResult result = read(tree(joint("i", "w", "a", "spherical") + joint("j", "a", "b") + joint("k", "b", "c")));
  expect_warning(result, 2, "<joint> 'i': programs that use urdfdom cannot read it, got");
  EXPECT_EQ(result.scene->joints[0].kind, JointKind::Spherical);
}

TEST(JointErrors, AFixedJointThatMimicsIsAWarning) {
  const ReadResult result =
      read(tree(joint("i", "w", "a", "continuous") + joint("j", "a", "b", "fixed", mimic("i")) + joint("k", "b", "c")));
  expect_warning(result, 3, "<mimic> of joint 'j': is ignored: a fixed joint has no coordinate");
  EXPECT_EQ(result.diagnostics.size(), 1u);
  EXPECT_FALSE(result.scene->joints[1].mimic);
}

TEST(JointErrors, Structure) {
  expect_error(R"(name="elbow" type="continuous")", R"(name="elbow" type="hinge")", 22,
               "<joint> 'elbow': type must be one of fixed, revolute, continuous, prismatic, planar, floating, "
               "spherical, got 'hinge'");
  expect_error(R"(name="elbow" type="continuous")", R"(name="elbow")", 22, "attribute 'type' is missing");
  expect_error(R"(<child link="upper"/>)", R"(<child link="upper"/><child link="tip"/>)", 8, "at most one <child>");
  expect_error(R"(<parent link="world"/>)", R"(<parent link="world"/><parent link="tip"/>)", 7, "at most one <parent>");
  expect_error(R"(<child link="forearm"/>)", "", 22, "<child link=\"...\"/> is missing");
  expect_error(R"(<child link="forearm"/>)", "<child/>", 24, "attribute 'link' is missing");
}

TEST(JointErrors, EqualLimitsAreAWarning) {
  const ReadResult result = read(good_scene_with(R"(lower="-1" upper="2")", ""));
  expect_warning(result, 10, "warning: <limit> of joint 'shoulder': lower and upper are equal");
  // The joint starts at 0.3.
  expect_warning(result, 61, "warning: <joint> 'shoulder': starts outside its limits, 0 to 0,");
  EXPECT_EQ(result.diagnostics.size(), 2u);
}

TEST(JointErrors, Release) {
  const std::string release = R"(<release kind="universal"/>)", axis2 = R"(<axis2 xyz="0 0 3"/>)";
  expect_error(release, R"(<release kind="ball"/>)", 44,
               "<release> of joint 'wrist': kind must be one of planar, free, spherical, universal, cylindrical, "
               "pin_slot, got 'ball'");
  expect_error(release, R"(<release/>)", 44, "attribute 'kind' is missing");
  expect_error(release, R"(<release kind="universal" axis="1 0 0"/>)", 44,
               "unknown attribute, expected kind, got 'axis'");
  expect_error(axis2, "", 39, "<joint> 'wrist': a universal joint needs a second axis");
  expect_error(axis2, R"(<axis2 xyz="0 -1 0"/>)", 43, "the axes of a universal joint must not be parallel");
  expect_error(axis2, R"(<axis2 xyz="0 0 0"/>)", 43, "xyz must not be zero");
  expect_error(R"(<limit effort="7" velocity="1"/>)",
               axis2.substr(0, axis2.size() - 2) + R"( /><limit effort="7" velocity="1"/>)", 25,
               "only a joint with <release> of kind universal or pin_slot has a second axis");
  expect_error(R"(<limit effort="7")", R"(<release kind="free"/><limit effort="7")", 25,
               "the type of the joint must be 'floating', got 'continuous'");
}

TEST(JointErrors, Friction) {
  // The shoulder is revolute, the finger prismatic.
  const auto expect_friction_error = [&](const std::string& friction, const std::string& fragment) {
    expect_error(R"(<dynamics damping)", friction + R"(<dynamics damping)", 11, fragment);
  };
  expect_friction_error(R"(<friction law="dry"/>)",
                        "<friction> of joint 'shoulder': law must be one of smooth, coulomb, got 'dry'");
  expect_friction_error(R"(<friction coefficient="-0.1" radius="1"/>)", "coefficient must be >= 0, got '-0.1'");
  expect_friction_error(R"(<friction coefficient="0.1"/>)", "needs the radius of the bearing, radius > 0");
  expect_friction_error(R"(<friction coefficient="0.1" radius="0"/>)", "radius must be > 0, got '0'");
  expect_friction_error(R"(<friction radius="0.1"/>)", "it acts with a coefficient only");
  expect_friction_error(R"(<friction mu="0.1"/>)",
                        "unknown attribute, expected law, coefficient, radius, static, stribeck, got 'mu'");
  expect_friction_error(R"(<friction/><friction law="coulomb"/>)", "at most one <friction>");
  expect_error(R"(<mimic joint="shoulder")", R"(<friction coefficient="1" radius="1"/><mimic joint="shoulder")", 50,
               "nothing turns about an axis here");
  expect_one_error(tree(joint("i", "w", "a", "floating", R"(<friction coefficient="1"/>)") + joint("j", "a", "b") +
                        joint("k", "b", "c")),
                   2, "spherical and planar joints have no normal force on which friction could depend");
}

TEST(JointErrors, Couple) {
  // The joint is the wrist: type floating, axis 0 1 0, and a second axis.
  const std::string release = R"(<release kind="universal"/>)";
  const auto expect_couple_error = [&](const std::string& couple, const std::string& fragment) {
    expect_error(release, couple, 44, fragment);
  };
  expect_couple_error(R"(<couple kind="gear"/>)", "kind must be one of screw, rack_and_pinion, worm, cam, got 'gear'");
  expect_couple_error(R"(<couple kind="screw"/>)", "<couple> of joint 'wrist': attribute 'pitch' is missing");
  expect_couple_error(R"(<couple kind="screw" pitch="0"/>)", "pitch must be different from 0, got '0'");
  expect_couple_error(R"(<couple kind="screw" pitch="1" radius="1"/>)", "unknown attribute, expected kind, pitch");
  expect_couple_error(R"(<couple kind="rack_and_pinion" radius="-1" direction="1 0 0"/>)", "radius must be > 0");
  expect_couple_error(R"(<couple kind="rack_and_pinion" radius="1" direction="1 1 0"/>)",
                      "the direction must be normal to the joint's axis, got '1 1 0'");
  expect_couple_error(R"(<couple kind="worm"/>)", "attribute 'ratio' is missing");
  expect_couple_error(R"(<couple kind="cam" direction="1 0 0"/>)", "a cam needs <profile kind=");
  const auto with_profile = [](const std::string& profile) {
    return R"(<couple kind="cam" direction="1 0 0">)" + profile + "</couple>";
  };
  expect_couple_error(with_profile(R"(<profile kind="round"/>)"), "kind must be 'eccentric' or 'table', got 'round'");
  expect_couple_error(with_profile(R"(<profile kind="eccentric" radius="0"/>)"), "radius must be > 0");
  expect_couple_error(with_profile(R"(<profile kind="table" theta="0 1 2" r="0 1"/>)"),
                      "a profile needs a travel for every angle");
  expect_couple_error(with_profile(R"(<profile kind="table" theta="0 1 x" r="0 1 2"/>)"),
                      "theta must be at most 10000 finite numbers, got '0 1 x'");
  expect_couple_error(release + R"(<couple kind="screw" pitch="1"/>)",
                      "a joint has one of <release>, <couple>, <slide>");
  expect_error(R"(<limit effort="7")", R"(<couple kind="screw" pitch="1"/><limit effort="7")", 25,
               "the type of the joint must be 'floating', got 'continuous'");
  for (const char* couple :
       {R"(<couple kind="screw" pitch="-0.1"/>)", R"(<couple kind="worm" ratio="0.1" offset="0.2"/>)",
        R"(<couple kind="rack_and_pinion" radius="0.1" direction="1 0 0"/>)",
        R"(<couple kind="cam" direction="1 0 0"><profile kind="eccentric" radius="0.1" offset="0.05"/></couple>)",
        R"(<couple kind="cam" direction="1 0 0"><profile kind="table" theta="0 1 2 4" r="0 1 2 1"/></couple>)"}) {
    const ReadResult result = read(good_scene_with(release, couple));
    // The scene refers to two coordinates of the wrist. With a couple it has only one.
    for (const Diagnostic& diagnostic : result.diagnostics)
      EXPECT_NE(diagnostic.text().find("wrist/"), std::string::npos) << diagnostic.text();
  }
}

TEST(JointErrors, Slide) {
  const std::string release = R"(<release kind="universal"/>)";
  const auto expect_slide_error = [&](const std::string& attributes, const std::string& fragment) {
    expect_error(release, "<slide " + attributes + "/>", 44, fragment);
  };
  expect_slide_error(R"(rotation="universal")", "<slide> of joint 'wrist': attribute 'start' is missing");
  expect_slide_error(R"(start="-1" rotation="universal")", "start must be >= 0, got '-1'");
  expect_slide_error(R"(start="0" rotation="universal" on_end="bounce")",
                     "on_end must be one of stop, error, free, got 'bounce'");
  expect_slide_error(R"(start="0" rotation="universal" scheme="best")",
                     "scheme must be one of sm_em, alg1, alg2, alg3, alg4, sme, got 'best'");
  expect_slide_error(R"(start="0" rotation="universal" line="curved")",
                     "line must be one of elements, smooth, got 'curved'");
  expect_slide_error(R"(start="0" rotation="universal" pitch="0.1")", "only rotation=\"screw\" has a pitch");
  // The scene's second axis does not fit these slides, which causes another message.
  const auto expect_among = [&](const std::string& slide, const std::string& fragment) {
    std::string all;
    for (const Diagnostic& diagnostic : read(good_scene_with(release, slide)).diagnostics)
      all += diagnostic.text() + "\n";
    EXPECT_NE(all.find("scene.urdf:44: " + fragment), std::string::npos) << all;
  };
  expect_among(R"(<slide start="0" rotation="screw" pitch="0"/>)",
               "<slide> of joint 'wrist': pitch must be different from 0, got '0'");
  expect_among(R"(<slide start="0" rotation="screw"><couple kind="screw" pitch="1"/></slide>)",
               "<slide> of joint 'wrist': <couple> says how it turns; leave this out, got 'screw'");
  expect_among(R"(<slide start="0"><couple kind="rack_and_pinion" radius="1" direction="0 1 0"/></slide>)",
               "<couple> of joint 'wrist': on a slide the travel is along the line, got '0 1 0'");
  expect_slide_error(R"(start="0" rotation="universal" speed="1")", "unknown attribute, expected start, rotation");
  expect_error(release, release + R"(<slide start="0.8"/>)", 44, "a joint has one of <release>, <couple>, <slide>");
}

TEST(TreeErrors, Names) {
  expect_one_error(tree(joint("i", "w", "a") + joint("i", "a", "b") + joint("k", "b", "c")), 3,
                   "<joint> 'i': name is taken, by line 2");
  expect_one_error(tree(joint("i", "x", "a") + joint("j", "a", "b") + joint("k", "b", "c")), 2,
                   "<joint> 'i': parent must be a link of the scene (w, a, b, c), got 'x'");
  expect_one_error(tree(joint("i", "w", "a") + joint("j", "a", "b") + joint("k", "b", "x")), 4,
                   "<joint> 'k': child must be a link of the scene (w, a, b, c), got 'x'");
  expect_one_error(tree(joint("i", "w", "a", "floating") + joint("i/x", "a", "b", "continuous") + joint("k", "b", "c")),
                   3, "a coordinate's name must be unique, but joint 'i' has one of this name, got 'i/x'");
}

TEST(TreeErrors, Shape) {
  expect_one_error(tree(joint("i", "w", "a") + joint("j", "a", "b") + joint("k", "a", "c") + joint("l", "w", "b")), 5,
                   "<joint> 'l': a link is the child of one joint only, and this one has 'j' (line 3), got 'b'");
  expect_one_error(tree(joint("i", "w", "a") + joint("j", "a", "b")), 1,
                   "<link> 'c': must be the child of a joint: a scene has one root link, and that is 'w'");
  expect_one_error(tree(joint("i", "w", "a") + joint("j", "b", "c") + joint("k", "c", "b")), 4,
                   "joints must form a tree, but their parents form a ring");
  EXPECT_FALSE(read(tree(joint("i", "w", "a") + joint("j", "b", "b") + joint("k", "w", "c"))).scene);
  expect_one_error(tree(joint("h", "c", "w") + joint("i", "w", "a") + joint("j", "a", "b") + joint("k", "b", "c")), 2,
                   "their parents form a ring");
}

TEST(TreeErrors, Mimic) {
  const std::string end = joint("k", "b", "c");
  expect_one_error(tree(joint("i", "w", "a", "continuous", mimic("x")) + joint("j", "a", "b") + end), 2,
                   "<joint> 'i': mimic joint must be a joint of the scene (j, k), got 'x'");
  expect_one_error(tree(joint("i", "w", "a", "continuous", mimic("i")) + joint("j", "a", "b") + end), 2,
                   "a joint must not mimic itself");
  expect_one_error(tree(joint("i", "w", "a", "floating", mimic("j")) + joint("j", "a", "b", "continuous") + end), 2,
                   "only a joint with one coordinate can mimic");
  expect_one_error(tree(joint("i", "w", "a", "continuous", mimic("j")) + joint("j", "a", "b", "floating") + end), 2,
                   "only a joint with one coordinate can be mimicked, got 'j'");
  expect_one_error(tree(joint("i", "w", "a", "continuous", "<mimic/>") + joint("j", "a", "b", "fixed") + end), 2,
                   "<mimic> of joint 'i': attribute 'joint' is missing");

  expect_one_error(
      tree(joint("i", "w", "a", "continuous", mimic("j")) + joint("j", "a", "b", "continuous", mimic("i")) + end), 2,
      "a joint must not mimic itself, directly or through others, got 'j'");

  const ReadResult chain =
      read(tree(joint("i", "w", "a", "continuous", mimic("j")) + joint("j", "a", "b", "continuous", mimic("k")) +
                joint("k", "b", "c", "continuous")));
  EXPECT_TRUE(chain.scene) << to_text(chain.diagnostics);
}

}  // namespace flexarm::scene
