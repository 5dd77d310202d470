/// Tests `--set`, which sets parameters of a scene on the command line: every subcommand obeys it.

#include <cmath>

#include <fmt/format.h>

#include "cli/program.h"

namespace flexarm::cli {
namespace {

/// Returns a pendulum scene. The arguments are texts that stand in the places of its expressions.
std::string pendulum(const std::string& head, const std::string& mass, const std::string& length,
                     const std::string& inertia, const std::string& angle) {
  return "<robot name=\"pendulum\">" + head + R"(<link name="base"/>
  <joint name="hinge" type="continuous"> <parent link="base"/> <child link="bob"/> <axis xyz="0 1 0"/> </joint>
  <link name="bob"> <inertial> <origin xyz="0 0 -)" +
         length + "\"/> <mass value=\"" + mass + "\"/> <inertia ixx=\"" + inertia + "\" ixy=\"0\" ixz=\"0\" iyy=\"" +
         inertia + "\" iyz=\"0\" izz=\"" + inertia + R"("/> </inertial> </link>
  <simulation> <integrator step="0.01"/> <initial joint="hinge" position=")" +
         angle + R"("/> <probe name="bob" link="bob" at="0 0 -)" + length + R"("/> </simulation> </robot>)";
}

const std::string kWithParameters = pendulum(R"(<parameter name="mass" value="3" min="0"/>
<parameter name="length" value="0.7" min="0.1" max="2"/>)",
                                             "${mass}", "${length}", "${mass*length/8}", "${pi/6}");

std::string results_of(const std::string& scene, const std::string& options = "") {
  const std::string csv = temporary("results.csv");
  const Outcome outcome = shell("flexarm simulate " + scene + " --until 1 --quiet --output " + csv + " " + options);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  return read_file(csv);
}

}  // namespace

TEST(Parameters, GiveTheBytesOfTheirNumbers) {
  const std::string parameters = temporary("parameters.urdf");
  std::ofstream(parameters) << kWithParameters;
  const std::string angle = fmt::format("{}", M_PI / 6);
  const std::string numbers = scene_file(pendulum("", "3", "0.7", fmt::format("{}", 3 * 0.7 / 8), angle));
  EXPECT_EQ(results_of(parameters), results_of(numbers));
  const std::string others = scene_file(pendulum("", "5", "1.25", "0.78125", angle));
  EXPECT_EQ(results_of(parameters, "--set mass=5 length=1.25"), results_of(others));
  EXPECT_EQ(results_of(parameters, "--set mass=5 --set length=1.25"), results_of(others));
  EXPECT_NE(results_of(parameters), results_of(others));
}

TEST(Parameters, EverySubcommandTakesThem) {
  const std::string scene = scene_file(kWithParameters);
  for (const std::string command :
       {"simulate --until 0.1 --quiet", "static", "modes", "check", "tune --accuracy 1e-2 --until 0.1"}) {
    const std::string output = command[0] == 't' ? " --output " + temporary("tuned.urdf") : "";
    const Outcome good = shell("flexarm " + command + output + " --set length=1.5 mass=1 -- " + scene);
    EXPECT_EQ(good.status, 0) << command << good.errors;
    const Outcome bad = shell("flexarm " + command + output + " " + scene + " --set length=3");
    EXPECT_EQ(bad.status, 2) << command;
    expect_contains(bad.errors, ":2: <parameter> 'length': the value that is set must be from 0.1 to 2, got '3'");
  }
  EXPECT_EQ(shell("flexarm check --set mass=1 " + scene).status, 0);
}

TEST(Parameters, AreListedByCheck) {
  const Outcome outcome = shell("flexarm check " + scene_file(kWithParameters) + " --set mass=4");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output,
                  "\nparameter                       value  limits\n"
                  "mass                                4  at least 0\n"
                  "length                            0.7  at least 0.1 and at most 2\n");
  EXPECT_EQ(shell("flexarm check " + example("cantilever")).output.find("parameter"), std::string::npos);
}

TEST(Parameters, WrongSettings) {
  const std::string scene = scene_file(kWithParameters);
  const auto expect_error = [&](const std::string& arguments, const std::string& told) {
    const Outcome outcome = shell("flexarm check " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    expect_contains(outcome.errors, told);
  };
  expect_error(scene + " --set mess=2", "scene: a parameter must be one of mass, length, got 'mess'");
  expect_error(scene + " --set mass", "must be NAME=VALUE, got 'mass'");
  expect_error(scene + " --set =2", "must be NAME=VALUE, got '=2'");
  expect_error(scene + " --set mass=", "must be a finite number, got 'mass='");
  expect_error(scene + " --set mass=1kg", "must be a finite number, got 'mass=1kg'");
  expect_error(scene + " --set mass=nan", "must be a finite number, got 'mass=nan'");
  expect_error(scene + " --set mass=1 length=1 mass=2", "'mass' must be set once");
  expect_error(scene + " --set mass=1 --set mass=1", "'mass' must be set once");
  expect_error("--set mass=1 " + scene + " --massless lock", "write the scene before --set");
  expect_error(example("cantilever") + " --set mass=1", "scene: it has no <parameter>, got 'mass'");
}

TEST(Parameters, MakeOtherScenesOfWhichStatesAreRefused) {
  const std::string scene = scene_file(kWithParameters), state = temporary("state");
  ASSERT_EQ(shell("flexarm simulate " + scene + " --set mass=5 --until 0.1 --quiet --checkpoint " + state).status, 0);
  const std::string resume = "flexarm simulate " + scene + " --until 0.2 --quiet --resume " + state;
  const Outcome other = shell(resume);
  EXPECT_EQ(other.status, 2);
  expect_contains(other.errors,
                  "it belongs to another scene, scheme or step: parameter 'mass': expected '3', found '5'; ");
  expect_contains(other.errors, "link 'bob'");
  const Outcome same = shell(resume + " --set mass=5");
  EXPECT_EQ(same.status, 0) << same.errors;
}

TEST(Parameters, ExpandGivesTheSameSceneToProgramsThatKnowNone) {
  const std::string scene = scene_file(kWithParameters), plain = temporary("plain.urdf");
  const Outcome outcome = shell("flexarm expand " + scene + " --set mass=5 length=1.25 --output " + plain);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string text = read_file(plain);
  for (const char* left : {"${", "<parameter"}) EXPECT_EQ(text.find(left), std::string::npos) << text;
  expect_contains(text, R"(<mass value="5"/>)");
  EXPECT_EQ(results_of(plain), results_of(scene, "--set mass=5 length=1.25"));
  EXPECT_EQ(shell("flexarm expand " + scene + " --set mass=5 length=1.25").output, text);
  // A scene without expressions stays as it is, to the byte. Errors are reported.
  EXPECT_EQ(shell("flexarm expand " + example("cantilever")).output, read_file(example("cantilever")));
  EXPECT_EQ(shell("flexarm expand " + scene + " --output " + scene).status, 2);
  const Outcome bad = shell("flexarm expand " + scene + " --set mass=-1");
  EXPECT_EQ(bad.status, 2);
  EXPECT_EQ(bad.output, "");
  expect_contains(bad.errors, "the value that is set must be at least 0, got '-1'");
}

TEST(Parameters, StayInATunedScene) {
  const std::string scene = scene_file(R"(<robot name="rod"> <parameter name="length" value="1"/>
  <parameter name="n" value="8"/> <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="rod"/> </joint>
  <link name="rod"> <beam elements="${n}"> <centerline> <line to="${length} 0 0"/> </centerline> <circle radius="0.02"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <simulation> <integrator step="${0.01/n}"/> <probe name="tip" link="rod" at="${length} 0 0"/> </simulation> </robot>)");
  const std::string tuned = temporary("tuned.urdf");
  const Outcome outcome =
      shell("flexarm tune " + scene + " --set length=1.5 n=10 --accuracy 1e-2 --until 0.1 --output " + tuned);
  ASSERT_EQ(outcome.status, 0) << outcome.errors << outcome.output;
  const std::string text = read_file(tuned);
  expect_contains(text, R"(<line to="${length} 0 0"/>)");
  expect_contains(text, R"(<parameter name="length" value="1"/>)");
  EXPECT_EQ(text.find("elements=\"${n}\""), std::string::npos)
      << "ten elements are more than an error of 1e-2 asks for";
  EXPECT_EQ(shell("flexarm check " + tuned + " --set length=1.5 n=10").status, 0);
}

}  // namespace flexarm::cli
