/// Tests parameters and their expressions: their values, and all their errors.

#include <cmath>
#include <limits>

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// A scene with parameters on lines 2 to 4, and expressions of them in all kinds of elements.
const std::string kArm = R"x(<robot name="arm">
  <parameter name="length" value="2" min="0.5" max="4"/>
  <parameter name="payload" value="120"/>
  <parameter name="half" value="${length/2}" max="${2 * length}"/>
  <link name="world"/>
  <joint name="hinge" type="revolute">
    <parent link="world"/> <child link="boom"/>
    <origin xyz="0 ${half} ${length}" rpy="0 ${pi/2} 0"/> <axis xyz="0 1 ${length - 2*half}"/>
    <limit lower="${-pi/4}" upper="${pi/4}" effort="${10*payload}" velocity="0"/>
    <dynamics damping="${payload/1000}"/>
  </joint>
  <link name="boom">
    <inertial>
      <origin xyz="${half} 0 0"/> <mass value="${payload}"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="${payload*length^2/12}" iyz="0" izz="${payload*length^2/12}"/>
    </inertial>
    <visual> <geometry> <box size="${length} 0.1 0.1"/> </geometry> </visual>
  </link>
  <joint name="weld" type="fixed"> <parent link="boom"/> <child link="rod"/> <origin xyz="${length} 0 0"/> </joint>
  <link name="rod">
    <beam elements="${2*half}">
      <centerline> <line to="${length} 0 0"/> </centerline>
      <circle radius="${length &gt; 1 ? length/100 : 0.01}"/> <material young="70e9" poisson="0.33" density="2700"/>
    </beam>
    <visual> <geometry> <box size="${length} 0.1 0.1"/> </geometry> </visual>
  </link>
  <simulation>
    <load link="boom" force="0 0 ${-payload}" history="${half}*sin(t)"/>
    <probe name="tip_${2 + 1}" link="rod" at="${length} 0 0"/>
  </simulation>
</robot>
)x";

ReadResult read_with(const ParameterValues& values, const std::string& text = kArm) {
  ReadOptions options;
  options.parameters = values;
  return read_scene_text(text, "scene.urdf", options);
}

std::string arm_with(const std::string& from, const std::string& to) {
  std::string text = kArm;
  const std::size_t found = text.find(from);
  EXPECT_NE(found, std::string::npos) << from;
  return text.replace(found, from.size(), to);
}

/// Expects these messages and no scene.
void expect_findings(const ReadResult& result, const std::string& expected) {
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(to_text(result.diagnostics), expected + "\n");
}

void expect_mass_error(const std::string& value, const std::string& expected) {
  expect_findings(read(arm_with(R"(mass value="${payload}")", "mass value=\"" + value + "\"")),
                  "scene.urdf:14: <mass> of link 'boom': " + expected);
}

/// Expects errors of these parameters, which start on line 2.
void expect_parameter_errors(const std::string& parameters, const std::string& expected) {
  expect_findings(read("<robot name=\"r\"> <link name=\"a\"/>\n" + parameters + "</robot>"), expected);
}

}  // namespace

TEST(Parameters, AreNumbersInAnyAttribute) {
  const ReadResult result = read(kArm);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  const SceneDescription& scene = *result.scene;
  const JointDescription& hinge = scene.joints.at(0);
  EXPECT_EQ(hinge.origin.position, Vector3(0, 1, 2));
  EXPECT_EQ(hinge.axis, Vector3(0, 1, 0));
  EXPECT_EQ(hinge.limits->lower, -M_PI / 4);
  EXPECT_EQ(hinge.limits->upper, M_PI / 4);
  EXPECT_EQ(hinge.effort_limit, 1200);
  EXPECT_EQ(hinge.damping, 0.12);
  const RigidInertia& inertial = *scene.links.at(1).inertial;
  EXPECT_EQ(inertial.mass, 120);
  EXPECT_EQ(inertial.center_of_mass, Vector3(1, 0, 0));
  EXPECT_EQ(inertial.inertia(1, 1), 40);
  const BeamDescription& beam = *scene.links.at(2).beam;
  EXPECT_EQ(beam.elements, 2);
  EXPECT_EQ(beam.centreline.at(0).to, Vector3(2, 0, 0));
  EXPECT_EQ(std::get<Circle>(std::get<GeometricSection>(beam.section).shape).radius, 0.02);
  EXPECT_EQ(std::get<BoxShape>(scene.links.at(2).visuals.at(0).shape).size, Vector3(2, 0.1, 0.1));
  EXPECT_EQ(scene.loads.at(0).force, Vector3(0, 0, -120));
  EXPECT_EQ(scene.loads.at(0).history.text(), "1*sin(t)");
  EXPECT_EQ(scene.probes.at(0).name, "tip_3");
}

TEST(Parameters, AreListedInTheirOrder) {
  const ReadResult result = read_with({{"length", 3}});
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const std::vector<ParameterDescription>& all = result.scene->parameters;
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].name, "length");
  EXPECT_EQ(all[0].value, 3);
  EXPECT_EQ(all[0].min, 0.5);
  EXPECT_EQ(all[0].max, 4);
  EXPECT_EQ(all[1].name, "payload");
  EXPECT_EQ(all[1].value, 120);
  EXPECT_FALSE(all[1].min || all[1].max);
  EXPECT_EQ(all[2].name, "half");
  EXPECT_EQ(all[2].value, 1.5);
  EXPECT_FALSE(all[2].min);
  EXPECT_EQ(all[2].max, 6);
}

TEST(Parameters, ThatAreGivenTakeThePlaceOfTheFiles) {
  const ReadResult result = read_with({{"length", 3}, {"half", 1}});
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->joints.at(0).origin.position, Vector3(0, 1, 3));
  EXPECT_EQ(result.scene->loads.at(0).history.text(), "1*sin(t)");
}

TEST(Parameters, KeepAllBitsOfANumber) {
  for (const double value : {1.0 / 3, -1e-300, std::nextafter(2.0, 3.0), 1e22, 5e-324}) {
    const ReadResult result = read_with({{"x", value}}, R"(<robot name="r"> <parameter name="x" value="0"/>
      <link name="a"/> <simulation> <gravity xyz="0 0 ${x}"/> </simulation> </robot>)");
    ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
    EXPECT_EQ(result.scene->gravity.z(), value);
  }
}

TEST(Parameters, ConstantsNeedNone) {
  const ReadResult result = read(
      R"(<robot name="r"> <link name="a"/> <simulation> <gravity xyz="${sqrt(2)} ${cos(pi)} 0"/> </simulation> </robot>)");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->gravity, Vector3(std::sqrt(2.0), -1, 0));
}

TEST(Parameters, OtherProgramsKeepTheirExpressions) {
  const ReadResult result = read(arm_with("</simulation>", R"x(</simulation> <gazebo path="${anything}"/>)x"));
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
}

TEST(Parameters, ExpressionsWithoutAValue) {
  expect_mass_error("${payloud/2 + length}",
                    "'payloud' is not a parameter of the scene (length, payload, half), no function, nor pi, got "
                    "'${payloud/2 + length}' with length = 2");
  expect_mass_error("${payload/(length - 2*half)}",
                    "an expression must be a finite number, got 'inf' of '${payload/(length - 2*half)}' with payload = "
                    "120, length = 2, half = 1");
  expect_mass_error("${sqrt(-length)}",
                    "an expression must be a finite number, got '-nan' of '${sqrt(-length)}' with length = 2");
  expect_mass_error("${payload", "'${' must be closed by '}', got '${payload'");
  expect_mass_error("${payload} ${", "'${' must be closed by '}', got '${'");
  expect_mass_error("${}", "an expression must be between '${' and '}', got '${}'");
  expect_mass_error("1${ }", "an expression must be between '${' and '}', got '${ }'");
  expect_mass_error("${payload = 3}",
                    "must be an expression, got expression 'payload = 3', at character 9: assignment (== compares); "
                    "expected parameters, numbers, functions and pi with payload = 120");
  expect_mass_error("${payload, 3}",
                    "must be an expression, got expression 'payload, 3', at character 8: several values separated by "
                    "commas; expected parameters, numbers, functions and pi with payload = 120");
  expect_mass_error("${2*}",
                    "must be an expression, got expression '2*', at character 3: Unexpected end of expression at "
                    "position 3; expected parameters, numbers, functions and pi");
}

TEST(Parameters, ValuesOfExpressionsThatCannotBeAreToldWithTheirOrigin) {
  expect_mass_error("${length - payload}",
                    "value must be >= 0, got '-118' of '${length - payload}' with length = 2, payload = 120");
  expect_mass_error("${length} ${half}",
                    "value must be a finite number, got '2 1' of '${length} ${half}' with length = 2, half = 1");
  expect_findings(
      read(arm_with("${half}*sin(t)", "${half}*sin(x)")),
      "scene.urdf:28: <load> of simulation: history is not a function of time, got expression '1*sin(x)', at "
      "character 7: Unexpected token \"x\" found at position 6.; expected an expression of t, or a table "
      "TIME:VALUE TIME:VALUE ... of '${half}*sin(x)' with half = 1");
  expect_findings(
      read(arm_with("${half}*sin(t)", "sine(t)")),
      "scene.urdf:28: <load> of simulation: history is not a function of time, got expression 'sine(t)', at character "
      "1: "
      "Unexpected token \"sine\" found at position 0.; did you mean 'sin'?; expected an expression of t, or a table "
      "TIME:VALUE TIME:VALUE ...");
}

TEST(Parameters, Declarations) {
  expect_parameter_errors(R"(<parameter name="a" value="1"/> <parameter value="2"/>)",
                          "scene.urdf:2: <parameter> of robot 'r': attribute 'name' is missing");
  expect_parameter_errors(R"(<parameter name="2a" value="1"/>)",
                          "scene.urdf:2: <parameter> of robot 'r': name must be a letter or '_', then letters, digits "
                          "and '_', got '2a'");
  expect_parameter_errors(R"(<parameter name="${pi}" value="1"/>)",
                          "scene.urdf:2: <parameter> of robot 'r': name must be a letter or '_', then letters, digits "
                          "and '_', got '${pi}'");
  const std::string longest(100, 'p');
  EXPECT_TRUE(
      read(arm_with(R"(name="length")", "name=\"" + longest + R"(" value="1"/> <parameter name="length")")).scene);
  expect_parameter_errors("<parameter name=\"" + longest + "p\" value=\"1\"/>",
                          "scene.urdf:2: <parameter> of robot 'r': name has at most 100 characters, got '" +
                              longest.substr(0, 80) + "...'");
  for (const char* taken : {"pi", "_pi", "_e", "sin", "min", "rint"})
    expect_parameter_errors(
        "<parameter name=\"" + std::string(taken) + "\" value=\"1\"/>",
        "scene.urdf:2: <parameter> of robot 'r': name must not be that of a function or constant of "
        "expressions, got '" +
            std::string(taken) + "'");
  expect_parameter_errors("<parameter name=\"a\" value=\"1\"/>\n<parameter name=\"a\" value=\"1\"/>",
                          "scene.urdf:3: <parameter> of robot 'r': name is taken, by line 2, got 'a'");
  expect_parameter_errors(R"(<parameter name="a" default="1"/>)",
                          "scene.urdf:2: <parameter> 'a': unknown attribute, expected name, value, min, max, got "
                          "'default'\nscene.urdf:2: <parameter> 'a': attribute 'value' is missing");
  expect_parameter_errors(R"(<parameter name="a" value="heavy"/>)",
                          "scene.urdf:2: <parameter> 'a': value must be a finite number, got 'heavy'");
  expect_parameter_errors(R"(<parameter name="a" value="1" min="3" max="2"/>)",
                          "scene.urdf:2: <parameter> 'a': min must be <= max, 2, got '3'");
  expect_parameter_errors(R"(<parameter name="a" value="1" min="2" max="3"/>)",
                          "scene.urdf:2: <parameter> 'a': value must be from 2 to 3, got '1'");
  expect_parameter_errors(R"(<parameter name="a" value="1"/> <parameter name="b" value="${2*a}" max="1"/>)",
                          "scene.urdf:2: <parameter> 'b': value must be at most 1, got '2' of '${2*a}' with a = 1");
  // An expression can use only parameters above it. Consequences of an error are not reported.
  expect_parameter_errors(
      "<parameter name=\"a\" value=\"${a + b}\"/>\n<parameter name=\"b\" value=\"${a + 1}\"/>\n"
      "<parameter name=\"c\" value=\"${b}\"/>",
      "scene.urdf:2: <parameter> 'a': 'a' is not a parameter of the scene, no function, nor pi, got '${a + b}'");
}

TEST(Parameters, StandElsewhere) {
  expect_one_error(arm_with(R"(<link name="boom">)", R"(<link name="boom"> <parameter name="a" value="1"/>)"), 12,
                   "<parameter> must be a child of <robot>");
}

TEST(Parameters, GivenValuesThatCannotBe) {
  expect_findings(read_with({{"payloud", 1}}),
                  "scene.urdf: scene: a parameter must be one of length, payload, half, got 'payloud'");
  expect_findings(read_with({{"a", 1}}, "<robot name=\"r\"> <link name=\"a\"/> </robot>"),
                  "scene.urdf: scene: it has no <parameter>, got 'a'");
  expect_findings(read_with({{"length", 5}}),
                  "scene.urdf:2: <parameter> 'length': the value that is set must be from 0.5 to 4, got '5'");
  expect_findings(read_with({{"half", 5}}),
                  "scene.urdf:4: <parameter> 'half': the value that is set must be at most 4, got '5'");
  expect_findings(read_with({{"payload", std::numeric_limits<double>::infinity()}}),
                  "scene.urdf:3: <parameter> 'payload': the value that is set must be a finite number, got 'inf'");
}

TEST(Parameters, FilesWithoutThemThatNameSomethingAreXacro) {
  const ReadResult result = read(
      "<robot name=\"r\"> <link name=\"a\"/>\n"
      "<simulation> <gravity xyz=\"0 0 ${g if on_earth else 0} ${b}\"/> </simulation> </robot>");
  ASSERT_EQ(result.diagnostics.size(), 1u) << to_text(result.diagnostics);
  EXPECT_EQ(result.diagnostics[0].line, 2);
  EXPECT_NE(result.diagnostics[0].text().find("this is xacro"), std::string::npos);
  EXPECT_NE(result.diagnostics[0].text().find("or a scene's <parameter name=\"g\"> is missing"), std::string::npos);
}

TEST(Parameters, HostileExpressions) {
  const auto gravity = [](const std::string& value) {
    return read(
        "<robot name=\"r\"> <parameter name=\"a\" value=\"1\"/> <link name=\"w\"/>\n<simulation> <gravity xyz=\"" +
        value + "\"/> </simulation> </robot>");
  };
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  // Deep expressions of the greatest length, longer ones, and very many.
  EXPECT_TRUE(gravity("0 0 ${" + repeated("(", 900) + "a" + repeated(")", 900) + "}").scene);
  for (const std::string& value :
       {"${" + repeated("(", 1 << 20), "${" + repeated("(", 1 << 20) + "}", "${" + repeated("a+", 1 << 20) + "a}",
        repeated("${", 1 << 20), repeated("${a}", 200000), "${" + repeated("-", 1999) + "}",
        "${" + repeated("a?", 900) + "}", std::string("${a&#0;}"), std::string("${&#1;}"), std::string("${\xc3\xa4}"),
        std::string("${&quot;a&quot;}"), std::string("${%s%n}"), std::string("$${a}{a} 0 0"), std::string("${${a}}"),
        std::string("${a\n\n+}"), std::string("${1e999}"), std::string("${0x}"), std::string("${;}")}) {
    const ReadResult result = gravity(value);
    EXPECT_FALSE(result.scene) << value.substr(0, 100);
    ASSERT_EQ(result.diagnostics.size(), 1u) << value.substr(0, 100);
    EXPECT_EQ(result.diagnostics[0].line, 2) << value.substr(0, 100);
    EXPECT_LT(result.diagnostics[0].text().size(), 600u);
    EXPECT_EQ(result.diagnostics[0].text().find('\n'), std::string::npos);
  }
  const ReadResult names =
      read("<robot name=\"r\"> <link name=\"w\"/>\n" + repeated("<parameter/>", 1001) + "</robot>");
  ASSERT_EQ(names.diagnostics.size(), 1u);
  EXPECT_NE(names.diagnostics[0].text().find("a scene has at most 1000 parameters"), std::string::npos);
}

}  // namespace flexarm::scene
