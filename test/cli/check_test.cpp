/// Tests `flexarm check` by running the program: the description of the model, its warnings, and its time for large
/// scenes.
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>

#include <fmt/format.h>

#include "cli/program.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::cli {

TEST(Check, DescribesTheModel) {
  const Outcome outcome = shell("flexarm check " + example("cantilever"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, "scene 'cantilever': 2 links, 1 joints");
  for (const char* word : {"nodes", "degrees of freedom", "EA", "GJ", "EI y", "2.1991e+07", "549.78", "flexible",
                           "fixed", "first natural frequencies there [Hz]: 14.2"})
    expect_contains(outcome.output, word);
}

TEST(Check, SaysWhichBeamsAreRigid) {
  const Outcome outcome = shell("flexarm check " + scene_file(R"(<robot name="r"> <link name="world"/>
      <joint name="hinge" type="continuous"> <parent link="world"/> <child link="arm"/> <axis xyz="0 1 0"/> </joint>
      <link name="arm"> <beam elements="0"> <centerline> <line to="1 0 0"/> </centerline>
        <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam> </link> </robot>)"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, "1 nodes, 1 degrees of freedom");
  EXPECT_TRUE(std::regex_search(outcome.output, std::regex("arm +rigid +0.84823\n"))) << outcome.output;
  EXPECT_TRUE(std::regex_search(outcome.output, std::regex("arm .* 0.84823 +rigid\n"))) << outcome.output;
}

// A pair of bodies has one line, however many contact elements it has: boxes have points in both directions, and beams
// have points for each of their elements.
TEST(Check, HasALineForEachPairThatMayTouch) {
  const auto body = [](const std::string& name, const std::string& start) {
    return fmt::format(R"(<joint name="of_{0}" type="floating"> <parent link="world"/> <child link="{0}"/> {1} </joint>
      <link name="{0}"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial>
        <collision> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link>)",
                       name, "<origin xyz=\"" + start + "\"/>");
  };
  const Outcome outcome =
      shell("flexarm check " + scene_file(R"(<robot name="r"> <link name="world"/> <ground name="floor"/>)" +
                                          body("low", "0 0 0.049") + body("high", "0 0 0.149") +
                                          R"(<joint name="clamp" type="fixed"> <parent link="world"/>
      <child link="arm"/> <origin xyz="0 0 0.5"/> </joint>
      <link name="arm"> <beam elements="4"> <centerline> <line to="1 0 0"/> </centerline>
        <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
      <contact first="floor" second="low" restitution="0.5" friction="0.25" stiffness="3e4"/>
      <contact first="high" second="*"/> </robot>)"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::regex line("\ncontact +([a-z]+, [a-z]+) +(.*?)  +([0-9]+ points, .*)");
  std::map<std::string, std::pair<std::string, std::string>> found;
  for (std::sregex_iterator i(outcome.output.begin(), outcome.output.end(), line), end; i != end; ++i)
    EXPECT_TRUE(found.emplace((*i)[1], std::pair((*i)[2], (*i)[3])).second) << "two lines of " << (*i)[1];
  ASSERT_EQ(found.size(), 4u) << outcome.output;
  EXPECT_TRUE(std::regex_match(found["floor, low"].first, std::regex("[0-9]+ points inside, 0.001 m deep")))
      << outcome.output;
  EXPECT_TRUE(std::regex_match(found["floor, low"].second,
                               std::regex("[0-9]+ points, 3e\\+04 N/m each, restitution 0.5, friction 0.25")))
      << outcome.output;
  EXPECT_EQ(found["low, high"].first, "touches");
  EXPECT_EQ(found["high, floor"].first, "0.099 m apart");
  EXPECT_EQ(found["high, arm"].first, "0.291 m apart") << "a radius less than their lines";
}

TEST(Check, HasALineForEachJointWithPlay) {
  const Outcome outcome = shell("flexarm check " + test::source_path("config/examples/loose_crank.urdf"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(std::regex_search(outcome.output,
                                std::regex("\nclearance .* points, 1.5e\\+08 N/m each, restitution 0.9, friction 0\n")))
      << outcome.output;
}

namespace {

/// Returns the path of a scene: a flexible arm in a plane, with the given drive of its elbow, and more content for its
/// beam.
std::string driven_arm(const std::string& drive, const std::string& of_beam = "") {
  return scene_file(
      R"(<robot name="r"> <link name="world"/>
      <joint name="elbow" type="continuous"> <parent link="world"/> <child link="arm"/> <axis xyz="0 1 0"/> </joint>
      <link name="arm"> <beam> <centerline> <line to="1 0 0"/> </centerline> )" +
      of_beam + R"(
        <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam> </link> )" +
      drive + R"( <simulation> <gravity xyz="0 0 0"/> <effort joint="elbow" history="0"/> </simulation> </robot>)");
}

/// Returns the largest speed of the elbow in the last tenth of a run, which may end early.
double last_speed(const std::string& scene) {
  const std::string csv = temporary("servo.csv");
  shell("cd '" + testing::TempDir() + "' && flexarm simulate " + scene + " --until 1 --quiet --output " + csv);
  const std::vector<double> speeds = read_csv(csv)["joint/elbow/velocity"];
  double largest = 0;
  for (std::size_t i = speeds.size() * 9 / 10; i < speeds.size(); ++i) largest = std::max(largest, std::abs(speeds[i]));
  return largest;
}

}  // namespace

// A flexible link, unlike a rigid one, has no inertia at the very point where the drive acts. A controller outside the
// program that damps once per step must therefore know how much damping is allowed. A hub or a rotor provides inertia.
TEST(Check, SaysWhatResistsADriveWithinAStep) {
  const auto found = [](const std::string& scene) {
    const Outcome outcome = shell("flexarm check " + scene);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("shake"), std::string::npos) << "nothing in the scene suffers";
    std::smatch row;
    const std::regex line("\nelbow +([0-9.e-]+) +([0-9.e-]+) +([0-9.e-]+)\n");
    return std::regex_search(outcome.output, row, line) ? std::vector<double>{std::stod(row[1]), std::stod(row[3])}
                                                        : std::vector<double>();
  };
  const std::vector<double> bare = found(driven_arm("")),
                            rotor = found(driven_arm(R"(<drive joint="elbow" rotor_inertia="1e-3"/>)"));
  ASSERT_EQ(bare.size(), 2u);
  ASSERT_EQ(rotor.size(), 2u);
  EXPECT_NEAR(rotor[0] - bare[0], 1e-3, 0.01 * rotor[0]) << "three digits";
  EXPECT_TRUE(found(driven_arm("", R"(<hub at="start" mass="0.5" inertia="2e-2 4e-2 2e-2"/>)")).empty());

  // A controller outside the program calms a damped beam with 0.3 of the printed limit, and shakes it with 1.1 of the
  // limit.
  const std::string damped = driven_arm("", R"(<damping stiffness_proportional="0.0001"/>)");
  const double limit = found(damped).at(1);
  for (const double part : {0.3, 1.1}) {
    Simulation simulation(*scene::read_scene_file(damped).scene);
    simulation.command_effort(0, 1);
    double last = 0;
    for (int n = 0; n < 400 && simulation.step().converged; ++n) {
      last = simulation.velocity(0);
      simulation.command_effort(0, -part * limit * last);
    }
    EXPECT_EQ(std::abs(last) < 0.01, part < 1) << part << ": " << last;
  }
}

// If only topics drive a joint, its <limit effort> shows that something may drive it. Robots of rigid links have such
// limits at every joint, and nothing bends there.
TEST(Check, CountsJointsAtBeamsWithALimitedEffortAsDriven) {
  const auto has_table = [](const std::string& of_joint, const std::string& of_arm, const std::string& more = "") {
    const std::string shaft =
        R"(<inertial> <mass value="1"/> <inertia ixx="1" iyy="1e-4" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial>)";
    const Outcome outcome = shell("flexarm check " + scene_file(R"(<robot name="r"> <link name="world"/>
      <joint name="elbow" type="continuous"> <parent link="world"/> <child link="shaft"/> <axis xyz="0 1 0"/> )" +
                                                                of_joint + R"(</joint> <link name="shaft">)" + shaft +
                                                                "</link>" + of_arm + more + "</robot>"));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return std::regex_search(outcome.output, std::regex("\nelbow( +[0-9.e-]+){3}\n"));
  };
  const std::string limit = R"(<limit effort="100" velocity="1"/>)", unlimited = R"(<limit effort="0" velocity="1"/>)";
  const std::string beam = R"(
      <joint name="weld" type="fixed"> <parent link="shaft"/> <child link="arm"/> </joint>
      <link name="arm"> <beam> <centerline> <line to="2 0 0"/> </centerline>
        <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>)";
  EXPECT_TRUE(has_table(limit, beam));
  EXPECT_FALSE(has_table(unlimited, beam));
  EXPECT_FALSE(has_table("", beam));
  // On the same axis a heavy body turns freely.
  const std::string body = R"(
      <joint name="wrist" type="continuous"> <parent link="shaft"/> <child link="arm"/> <axis xyz="0 1 0"/> </joint>
      <link name="arm"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
      </inertial> </link>)";
  EXPECT_FALSE(has_table(limit, body));
  EXPECT_TRUE(has_table("", body, R"(<simulation> <effort joint="elbow" history="0"/> </simulation>)"))
      << "a joint that an <effort> names is always in the table";
}

// There is one warning if a servo of the scene itself is affected. The number in the warning is large enough.
TEST(Check, WarnsOfSampledServosThatShakeABeam) {
  const auto servo = [](const std::string& drive) {
    return driven_arm(drive + R"(<servo joint="elbow" mode="velocity" kp="20" set_point="0.2" sample_time="0.004"/>)");
  };
  const std::string bare = servo("");  // the file is replaced by the next scene
  const Outcome shaken = shell("flexarm check " + bare);
  EXPECT_EQ(shaken.status, 0);
  std::smatch told;
  ASSERT_TRUE(std::regex_search(
      shaken.errors, told,
      std::regex(
          "flexarm: warning: sampled servos may shake .*: (<drive joint=\"elbow\" rotor_inertia=\"[0-9.]+\"/>)\n")))
      << shaken.errors;
  EXPECT_GT(last_speed(bare), 10) << "instead of 0.2 rad/s";
  const std::string calm = servo(told[1]);
  EXPECT_EQ(shell("flexarm check " + calm).errors.find("shake"), std::string::npos);
  EXPECT_NEAR(last_speed(calm), 0.2, 0.02);
  EXPECT_EQ(
      shell("flexarm check " + driven_arm(R"(<servo joint="elbow" mode="velocity" kp="20"/>)")).errors.find("shake"),
      std::string::npos)
      << "it is not sampled";
}

// An effort pushes the arm against its stop. The modes are those at that position.
TEST(Check, SaysWhereTheArmIs) {
  const std::string scene = scene_file(R"(<robot name="r"> <link name="world"/>
      <joint name="elbow" type="revolute"> <parent link="world"/> <child link="arm"/> <axis xyz="0 1 0"/>
        <limit lower="-1" upper="0.5" effort="9" velocity="9"/> </joint>
      <link name="arm"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
      <simulation> <gravity xyz="0 0 0"/> <effort joint="elbow" history="4"/> <probe name="arm" link="arm"/> </simulation> </robot>)");
  const std::regex where(
      "equilibrium under gravity and the loads at t = 0: joints at \\[m, rad\\]\n  elbow +0.5[0-9]*  pressed on its "
      "upper limit, 0.5\n");
  for (const char* command : {"check", "modes"}) {
    const Outcome outcome = shell("flexarm " + std::string(command) + " " + scene);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(std::regex_search(outcome.output, where)) << outcome.output;
  }
  for (const char* command : {"static", "modes"}) {
    const std::string output = shell("flexarm " + std::string(command) + " " + scene).output;
    expect_contains(output, "  link arm ");
    expect_contains(output, "  probe arm ");
  }
}

TEST(Check, NamesLoopsOfBeamsAtDeadPoints) {
  const auto beam = [](const std::string& link, double length) {
    return "<link name=\"" + link + "\"><beam elements=\"2\"><centerline><line to=\"" + std::to_string(length) +
           " 0 0\"/></centerline><circle radius=\"0.01\"/><material young=\"70e9\" poisson=\"0.33\" "
           "density=\"2700\"/></beam></link>\n";
  };
  const auto joint = [](const std::string& tag, const std::string& links, const std::string& name, double place) {
    return "<" + tag + " name=\"" + name + "\" type=\"continuous\">" + links + "<axis xyz=\"0 1 0\"/><origin xyz=\"" +
           std::to_string(place) + " 0 0\"/>";
  };
  const auto links = [](const std::string& parent, const std::string& child) {
    return "<parent link=\"" + parent + "\"/><child link=\"" + child + "\"/>";
  };
  const auto parallelogram = [&](const std::string& initial) {
    return scene_file("<robot name=\"flat\">\n<link name=\"world\"/>\n" + beam("left", 1) + beam("coupler", 2) +
                      beam("right", 1) + joint("joint", links("world", "left"), "left_foot", 0) + "</joint>\n" +
                      joint("joint", links("left", "coupler"), "left_head", 1) + "</joint>\n" +
                      joint("joint", links("world", "right"), "right_foot", 2) + "</joint>\n" +
                      joint("loop_joint", links("coupler", "right"), "right_head", 2) +
                      "<child_origin xyz=\"1 0 0\"/></loop_joint>\n<simulation>" + initial + "</simulation></robot>\n");
  };
  const Outcome flat = shell("flexarm check " + parallelogram(""));
  EXPECT_EQ(flat.status, 0);
  expect_contains(flat.output, "at a dead point: the loop that joint 'right_head' closes");
  const Outcome open = shell("flexarm check " + parallelogram("<initial joint=\"left_foot\" position=\"-0.5\"/>"
                                                              "<initial joint=\"left_head\" position=\"0.5\"/>"
                                                              "<initial joint=\"right_foot\" position=\"-0.5\"/>"));
  EXPECT_EQ(open.status, 0);
  EXPECT_EQ(open.output.find("dead point"), std::string::npos);
}

namespace {

/// A hinge with a body, whose inertia about the axis is 0.11 kg m^2; `more` has its damping, and elements of the robot.
std::string spun_arm(const std::string& dynamics, const std::string& more) {
  return scene_file(R"(<robot name="r"> <link name="world"/> <link name="arm"> <inertial> <origin xyz="0.1 0 0"/>
      <mass value="1"/> <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>
      <joint name="hinge" type="continuous"> <parent link="world"/> <child link="arm"/> <axis xyz="0 1 0"/> )" +
                    dynamics + "</joint> " + more + "</robot>");
}

}  // namespace

TEST(Check, WarnsOfAStepThatIsLongForTheFirstMode) {
  const auto with_step = [](const std::string& step) {
    return shell("flexarm check " +
                 spun_arm("", R"(<spring joint="hinge" stiffness="4000"/> <simulation> <gravity xyz="0 0 0"/>
        <integrator scheme="em" step=")" +
                                  step + R"("/> </simulation>)"))
        .errors;
  };
  // Its period is 2 pi sqrt(0.11 / 4000).
  expect_contains(with_step("0.004"),
                  "warning: the step, 0.004 s, is long for the first mode, whose period is 0.0329 s: take ten steps");
  EXPECT_EQ(with_step("0.003"), "");
}

TEST(Check, AndSimulateWarnOfAnExplicitStepThatMakesMotionsGrow) {
  const std::string scene =
      spun_arm(R"(<dynamics damping="2000"/>)", R"(<simulation> <integrator scheme="rk4"/> </simulation>)");
  const std::string told =  // 2.785 * 0.11 / 2000
      "warning: the step, 0.001 s, is too long for the explicit scheme rk4, so that motions grow: damping of joint "
      "coordinate 'hinge' needs steps below 0.00015 s";
  expect_contains(shell("flexarm check " + scene).errors, told);
  const Outcome run = shell("flexarm simulate " + scene + " --until 1 --checkpoint " + temporary("state"));
  EXPECT_EQ(run.status, 1);
  expect_contains(run.errors, told);
  expect_contains(run.errors, "the step is too long for an explicit scheme, so that the motion grows");
  const Outcome good = shell("flexarm simulate " + scene + " --until 0.01 --step 0.0001");
  EXPECT_EQ(good.status, 0);
  EXPECT_EQ(good.errors.find("too long"), std::string::npos) << good.errors;
}

TEST(Check, WarnsOfAJointFarBeyondItsBeam) {
  const auto errors = [](const std::string& x) {
    return shell("flexarm check " + scene_file(R"(<robot name="r"> <link name="world"/>
        <link name="rod"> <beam elements="2"> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
          <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
        <link name="load"> <inertial> <mass value="1"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
          </inertial> </link>
        <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint>
        <joint name="flange" type="fixed"> <parent link="rod"/> <child link="load"/> <origin xyz=")" +
                                               x + R"( 0.2 0"/> </joint> </robot>)"))
        .errors;
  };
  expect_contains(
      errors("1.3"),
      "warning: <joint> 'flange': its place on link 'rod' is beyond the end of the line, which is 1 m long: a "
      "rigid offset connects them, got '0.3' m");
  expect_contains(errors("-2"), "got '2' m");
  EXPECT_EQ(errors("1.2"), "");
  EXPECT_EQ(errors("0.5"), "");
}

TEST(Check, TakesEveryExample) {
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("config/examples")))
    EXPECT_EQ(shell("flexarm check " + entry.path().string()).status, 0) << entry.path();
}

// Algorithms of cubic cost would take hours, and those of quadratic cost minutes.
TEST(Check, LargeScenesTakeSeconds) {
  std::string chain = R"(<robot name="r"> <link name="l0"/>)";
  for (int i = 1; i < 10000; ++i)
    chain += fmt::format(R"(<joint name="j{0}" type="continuous"> <parent link="l{1}"/> <child link="l{0}"/>
      <origin xyz="1 0 0"/> <axis xyz="0 1 0"/> </joint> <link name="l{0}"> <inertial> <mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>)",
                         i, i - 1);
  const std::string rod = R"(<robot name="r"> <link name="world"/> <link name="rod"> <beam elements="100000" order="1">
    <centerline> <line to="2 0 0"/> </centerline> <circle radius="0.003"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint> </robot>)";
  for (const std::string& scene : {chain + "</robot>", rod}) {
    const Outcome outcome = shell("ulimit -v 2000000; timeout 30 '" + program() + "' check " + scene_file(scene));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_contains(outcome.output, "natural frequencies are not computed");
  }
  expect_contains(shell("timeout 30 '" + program() + "' static " + scene_file(chain + "</robot>")).errors,
                  "no equilibrium found");
}

}  // namespace flexarm::cli
