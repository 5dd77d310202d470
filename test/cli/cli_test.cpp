/// Tests the command line as a whole by running the program: usage errors, help, completion, and the subcommands
/// simulate, static and modes.
#include <regex>
#include <string>

#include "cli/program.h"
#include "math/pi.h"

namespace flexarm::cli {
TEST(CommandLine, UsageErrors) {
  for (const char* arguments : {"", "fly", "check", "simulate", "check a b", "simulate --step"}) {
    const Outcome outcome = shell("flexarm " + std::string(arguments));
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.errors, "") << arguments;
    EXPECT_EQ(outcome.output, "") << arguments;
  }
  const std::string scene = example("cantilever");
  for (const char* option : {"--step 0", "--step 1e-300", "--step nan", "--step 1x", "--until -1", "--tolerance 0",
                             "--tolerance 1e300", "--every 0", "--scheme euler"})
    EXPECT_EQ(shell("flexarm simulate " + scene + " " + option).status, 2) << option;
  EXPECT_EQ(shell("flexarm static " + scene + " --load-steps 0").status, 2);
  EXPECT_EQ(shell("flexarm modes " + scene + " --count 0").status, 2);
}

TEST(CommandLine, Help) {
  const Outcome outcome = shell("flexarm --help && flexarm simulate --help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"check", "static", "modes", "--until", "--every", "--resume", "--checkpoint", "--quiet"})
    expect_contains(outcome.output, word);
}

TEST(CommandLine, MistypedCommandsAndOptionsAreGuessed) {
  const Outcome command = shell("flexarm simulat " + example("cantilever"));
  EXPECT_EQ(command.status, 2);
  EXPECT_EQ(command.output, "");
  expect_contains(command.errors, "flexarm: there is no subcommand 'simulat'; did you mean 'simulate'?");
  const Outcome option = shell("flexarm simulate --unitl 1 " + example("cantilever"));
  EXPECT_EQ(option.status, 2);
  expect_contains(option.errors, "flexarm simulate: there is no option '--unitl'; did you mean '--until'?");
  expect_contains(shell("flexarm bench haard").errors,
                  "flexarm bench: there is no subcommand 'haard'; did you mean 'hard'?");
  expect_contains(shell("flexarm").errors, "expected one of check, simulate,");
}

TEST(CommandLine, Version) {
  const Outcome outcome = shell("flexarm --version");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(std::regex_match(outcome.output, std::regex("flexarm [0-9]+\\.[0-9]+\\.[0-9]+\n"))) << outcome.output;
}

// Completes words like a shell does when the tab key is pressed.
TEST(CommandLine, BashCompletes) {
  const auto completed = [](const std::string& words, int last) {
    const Outcome outcome =
        shell("bash -c 'eval \"$(\"" + program() + "\" completion bash)\"; COMP_WORDS=(\"" + program() + "\" " + words +
              "); COMP_CWORD=" + std::to_string(last) + "; _flexarm \"" + program() + "\"; echo \"${COMPREPLY[@]}\"'");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.errors, "");
    return outcome.output;
  };
  EXPECT_EQ(completed("si", 1), "simulate\n");
  EXPECT_EQ(completed("simulate --st", 2), "--start --step\n");
  EXPECT_EQ(completed("simulate scene.urdf --start \"\"", 4), "clamp equilibrium\n");
  EXPECT_EQ(completed("bench hard --gr", 3), "--group\n");
  EXPECT_EQ(completed("simulate sc", 2), "\n") << "files, which bash finds itself";
}

TEST(CommandLine, SceneErrorsGoToTheErrorOutput) {
  const std::string path = scene_file("<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\"/></robot>");
  for (const char* command : {"check", "simulate", "static", "modes"}) {
    const Outcome outcome = shell("flexarm " + std::string(command) + " " + path);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_EQ(outcome.output, "") << command;
    expect_contains(outcome.errors, path + ":3: <link> 'b': must be the child of a joint");
  }
  EXPECT_EQ(shell("flexarm check /no/such/scene.urdf").status, 2);
}

TEST(Simulate, WritesRowsAndASummary) {
  const std::string csv = temporary("out.csv");
  const Outcome outcome = shell("flexarm simulate " + example("rigid_double_pendulum") +
                                " --until 0.1 --step 0.01 --every 4 --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, "10 steps");
  EXPECT_EQ(outcome.errors, "") << "no progress bar in a pipe";
  EXPECT_EQ(outcome.output.find("--output"), std::string::npos) << "there are results";
  Columns columns = read_csv(csv);
  const std::vector<double> times = columns["time"];
  ASSERT_EQ(times.size(), 4u);  // the start, steps 4 and 8, and the end
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(times[i], (std::vector<double>{0, 0.04, 0.08, 0.1}[i]), 1e-12);
  for (const char* name : {"joint/shoulder/position", "joint/elbow/velocity", "joint/elbow/effort", "frame/world/qw",
                           "frame/forearm/x", "probe/tip/x", "probe/tip/qw", "probe/tip/vz", "energy/kinetic",
                           "energy/strain", "energy/potential", "energy/total", "energy/work", "energy/dissipated",
                           "momentum/z", "angular_momentum/y", "solver/step", "solver/iterations", "solver/halvings"})
    EXPECT_EQ(columns[name].size(), 4u) << name;
  EXPECT_EQ(columns["solver/step"][1], 0.01);
  EXPECT_EQ(columns["solver/iterations"][0], 0);
  EXPECT_GE(columns["solver/iterations"][1], 4) << "counts all steps since the row before";
}

TEST(Simulate, SaysThatNothingIsKept) {
  const std::string run = "flexarm simulate " + example("cantilever") + " --until 0.01";
  const Outcome outcome = shell(run);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(std::regex_search(outcome.output, std::regex("real time\nno results are kept: --output FILE .*\n$")))
      << outcome.output;
  const Outcome kept = shell(run + " --checkpoint " + temporary("state"));
  expect_contains(kept.output, "real time\n");
  EXPECT_EQ(kept.output.find("no results"), std::string::npos);
}

TEST(Simulate, NumbersAreReadBackBitForBit) {
  const std::string csv = temporary("out.csv");
  ASSERT_EQ(
      shell("flexarm simulate " + example("rigid_double_pendulum") + " --until 0.02 --quiet --output " + csv).status,
      0);
  std::ifstream file(csv);
  std::string line;
  while (std::getline(file, line)) {
  }
  for (const std::string& field : split(line)) {
    char again[40];
    std::snprintf(again, sizeof again, "%.17g", std::stod(field));
    EXPECT_EQ(field, again);
  }
}

// So many additions of 0.05 s give a sum that differs from 0.05 s times their number by more than a millionth of a
// step.
TEST(Simulate, RoundOffOfManyStepsIsNoStep) {
  const std::string csv = temporary("many.csv");
  const Outcome outcome = shell("flexarm simulate " + scene_file(R"(<robot name="r"> <link name="world"/>
    <link name="wheel"> <inertial> <mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <joint name="shaft" type="continuous"> <parent link="world"/> <child link="wheel"/> <axis xyz="0 0 1"/> </joint>
    </robot>)") + " --step 0.05 --until 13073.65 --every 10000000 --quiet --output " +
                                csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NEAR(read_csv(csv)["time"].back(), 261473 * 0.05, 1e-6);
}

TEST(Simulate, QuietSaysNothing) {
  const Outcome outcome = shell("flexarm simulate " + example("cantilever") + " --until 0.01 --quiet");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output + outcome.errors, "");
}

/// Whether a table of numbers of order one shows any below 1e-12.
bool has_round_off(const std::string& table) {
  return std::regex_search(table, std::regex("e-(1[3-9]|[2-9][0-9])"));
}

TEST(Static, FindsTheEquilibrium) {
  const std::string csv = temporary("out.csv");
  const Outcome outcome = shell("flexarm static " + example("cantilever") + " --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, "arm/tip");
  EXPECT_FALSE(has_round_off(outcome.output)) << outcome.output;
  Columns columns = read_csv(csv);
  EXPECT_EQ(columns["time"].size(), 1u);
  EXPECT_EQ(columns.count("solver/step"), 0u);
  // The strain energy of a clamped beam under its weight q per length is q^2 L^5 / (40 EI). The tolerance covers shear
  // (a relative share of 20/3 EI / (GA L^2) < 1e-3) and the change of geometry (relative deflection squared < 1e-3).
  const double q = 2700 * kPi * 1e-4 * 9.81, ei = 70e9 * kPi * 1e-8 / 4;
  EXPECT_NEAR(columns["energy/strain"][0], q * q / (40 * ei), 2e-3 * q * q / (40 * ei));
}

TEST(Modes, FrequenciesAndShapes) {
  const Outcome outcome = shell("flexarm modes " + example("cantilever") + " --count 3");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  // Euler-Bernoulli: 1.87510^2 / (2 pi L^2) sqrt(EI / mass) = 14.247 Hz; rotary inertia and shear lower it slightly.
  expect_contains(outcome.output, "mode 1: 14.24");
  expect_contains(outcome.output, "mode 3: 89.");
  expect_contains(outcome.output, "arm/tip");
  EXPECT_EQ(outcome.output.find("mode 4"), std::string::npos);
  EXPECT_FALSE(has_round_off(outcome.output)) << outcome.output;
}

TEST(Modes, JsonAndCsvHaveAllDigits) {
  const std::string scene = example("flexible_two_link_arm");
  const std::string json = temporary("modes.json"), csv = temporary("modes.csv");
  const std::string command = "flexarm modes " + scene + " --count 8 ";
  ASSERT_EQ(shell(command + "--json > " + json + " && " + command + "--csv > " + csv).status, 0);
  const Outcome outcome = shell("python3 -c \"import json; modes = json.load(open('" + json +
                                "'))['modes']; print(len(modes), repr(modes[7]['frequency']), "
                                "repr(modes[7]['frames']['forearm/tip']['real'][1]), modes[0]['kind'])\"");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  Columns columns = read_csv(csv);
  ASSERT_EQ(columns["mode"].size(), 8u);
  for (const char* name : {"rate", "damping_ratio", "joint/elbow", "joint/elbow/imaginary", "frame/forearm/tip/rz",
                           "frame/forearm/tip/imaginary/rz", "probe/payload/x"})
    EXPECT_EQ(columns.count(name), 1u) << name;
  // Python's text of a frequency, printed without loss, equals the number in the CSV table to the last bit.
  std::size_t count = 0;
  std::string frequency, motion, kind;
  std::stringstream(outcome.output) >> count >> frequency >> motion >> kind;
  EXPECT_EQ(count, 8u);
  EXPECT_EQ(kind, "free");
  EXPECT_GT(std::stod(frequency), 0);
  EXPECT_EQ(std::stod(frequency), columns["frequency"][7]);
  EXPECT_EQ(std::stod(motion), columns["frame/forearm/tip/y"][7]);
  EXPECT_EQ(shell(command + "--json --csv").status, 2);
}

TEST(Modes, FlutterIsNamed) {
  const std::string scene = scene_file(R"(<robot name="beck">
  <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="column"/> </joint>
  <link name="column">
    <beam order="4" elements="8"> <centerline> <line to="1 0 0"/> </centerline>
      <section ea="1e6" ga2="1e6" ga3="1e10" gj="1e4" ei2="1e4" ei3="1" mass="1" j1="2e-6" j2="1e-6" j3="1e-6"/> </beam>
  </link>
  <simulation> <gravity xyz="0 0 0"/> <load link="column" at="1 0 0" force="-21 0 0" frame="follower"/> </simulation>
</robot>)");
  // Values of a slender column: 1.740734 Hz and 2.12494 1/s (test/reference/modes_follower_test.cpp).
  const Outcome modes = shell("flexarm modes " + scene + " --count 2");
  expect_contains(modes.output, "mode 1: 1.7407");
  expect_contains(modes.output, " Hz, grows by 2.125");
  expect_contains(modes.output, "1/s (flutter), damping ratio -0.19");
  expect_contains(modes.output, "a quarter period later");
  expect_contains(shell("flexarm check " + scene).output, "not stable: flutter at 1.7407");
}

TEST(Modes, FreeMechanismIsExplained) {
  const std::string scene = scene_file(R"(<robot name="r">
  <link name="world"/>
  <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 0 1"/> </joint>
  <link name="rod">
    <beam> <centerline> <line to="1 0 0"/> </centerline>
      <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam>
  </link>
  <simulation> <gravity xyz="0 0 0"/> <effort joint="shoulder" history="1"/> </simulation>
</robot>)");
  const std::string sentence =
      "no equilibrium: nothing holds joint 'shoulder' in the initial configuration (1 motion is free; a <motion> would "
      "hold it)";
  const Outcome modes = shell("flexarm modes " + scene), check = shell("flexarm check " + scene);
  for (const Outcome& outcome : {modes, check}) {
    EXPECT_EQ(outcome.status, 0);
    expect_contains(outcome.errors, sentence + "; the modes are those of the initial configuration");
  }
  expect_contains(modes.output, "mode 1: 0 Hz (free: nothing holds this motion)");
  expect_contains(check.output, "(and 1 free motion)");
  const Outcome statics = shell("flexarm static " + scene);
  EXPECT_EQ(statics.status, 1);
  expect_contains(statics.errors, sentence);
}

// A beam stands upright on a hinge. The load steps lead to this unstable equilibrium, and the beam falls from there.
TEST(Statics, FallsFromAnUnstableEquilibrium) {
  const std::string scene = scene_file(R"(<robot name="r">
  <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
  <link name="rod">
    <beam> <centerline> <line to="0 0 1"/> </centerline>
      <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam>
  </link>
</robot>)");
  const Outcome falls = shell("flexarm static " + scene), stays = shell("flexarm static --unstable " + scene);
  for (const Outcome& outcome : {falls, stays}) {
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_contains(outcome.errors, "the equilibrium to which the loads lead is not stable: link 'rod'");
  }
  expect_contains(falls.errors, "falls from it; this is the equilibrium in which it comes to rest");
  expect_contains(falls.output, "hinge                          3.14159");
  expect_contains(stays.errors, "would fall from it");
  EXPECT_EQ(stays.output.find("hinge                          3.14159"), std::string::npos) << stays.output;
  // Other commands use the same equilibrium.
  expect_contains(shell("flexarm modes " + scene).errors,
                  "falls from it; this is the equilibrium in which it comes to rest");
  EXPECT_EQ(shell("flexarm modes " + scene).output.find("divergence"), std::string::npos);
  expect_contains(shell("flexarm modes --unstable " + scene).output, "(divergence)");
}

TEST(CommandLine, RingOfOneLink) {
  const std::string scene = scene_file(R"(<robot name="r">
  <link name="world"/>
  <link name="ring">
    <beam elements="16">
      <centerline> <arc to="-1 1 0" center="-1 0 0"/> <arc to="-2 0 0" center="-1 0 0"/>
                   <arc to="-1 -1 0" center="-1 0 0"/> <arc to="0 0 0" center="-1 0 0"/> </centerline>
      <circle radius="0.01"/> <material young="70e9" poisson="0.33" density="2700"/> </beam>
  </link>
  <joint name="stand" type="fixed"> <parent link="world"/> <child link="ring"/> </joint>
  <loop_joint name="weld" type="fixed"> <parent link="ring"/> <child link="ring"/> </loop_joint>
</robot>)");
  for (const char* command : {"check", "modes", "static", "simulate --until 0.01 --quiet"}) {
    const Outcome outcome = shell("flexarm " + std::string(command) + " " + scene);
    EXPECT_EQ(outcome.status, 0) << command;
    EXPECT_EQ(outcome.errors, "") << command;
  }
}

}  // namespace flexarm::cli
