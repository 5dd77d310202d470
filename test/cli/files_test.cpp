/// Tests the files that the program reads and writes. A result file is complete or stays as before, whatever happens,
/// and the exit status says which.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <unistd.h>

#include "cli/program.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

/// A rod on a hinge. Its Newton iteration gets too few iterations to converge.
const char* const kFailingScene = R"(<robot name="r">
  <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
  <link name="rod">
    <inertial> <origin xyz="1 0 0"/> <mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial>
  </link>
  <simulation> <integrator step="0.5" max_iterations="1" max_halvings="0"/> </simulation>
</robot>)";

const std::string kEndless = "simulate " + example("rigid_double_pendulum") + " --until 1e9 ";
const std::string kShort = "flexarm simulate " + example("rigid_double_pendulum") + " --until 0.01 --quiet ";

/// Runs the program in the background and ends it after a second by a shell command. The shell waits for it; its
/// outcome is returned.
Outcome ended_by(const std::string& arguments, const std::string& command) {
  return shell(interruptible_program() + arguments + " & sleep 1; " + command + "; wait $!");
}

}  // namespace

TEST(Simulate, ResumedRunEqualsAnUninterruptedOne) {
  const std::string scene = example("flexible_two_link_arm"), state = temporary("state"), end = temporary("end");
  const std::string whole = temporary("whole.csv"), half = temporary("half.csv");
  const Outcome outcome =
      shell("set -e; flexarm simulate " + scene + " --until 0.2 --checkpoint " + end + " --output " + whole +
            "; flexarm simulate " + scene + " --until 0.1 --checkpoint " + state + "; flexarm simulate " + scene +
            " --until 0.2 --resume " + state + " --output " + half);
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const Columns a = read_csv(whole), b = read_csv(half);
  EXPECT_NEAR(b.at("time").front(), 0.1, 1e-12);
  for (const auto& [name, values] : a) EXPECT_EQ(values.back(), b.at(name).back()) << name;
}

TEST(Simulate, BadStateFileIsAnInputError) {
  const std::string state = temporary("state");
  std::ofstream(state) << "nonsense";
  EXPECT_EQ(shell("flexarm simulate " + example("cantilever") + " --resume " + state).status, 2);
  EXPECT_EQ(shell("flexarm simulate " + example("cantilever") + " --resume /no/such/state").status, 2);
}

TEST(Simulate, FailureKeepsAndNamesTheLastGoodState) {
  const std::string state = temporary("state"), csv = temporary("out.csv");
  const Outcome outcome =
      shell("flexarm simulate " + scene_file(kFailingScene) + " --checkpoint " + state + " --output " + csv);
  EXPECT_EQ(outcome.status, 1);
  expect_contains(outcome.errors, "simulation failed after t = 0 s: ");
  expect_contains(outcome.errors, "joint coordinate 'hinge'");
  expect_contains(outcome.errors, "What usually helps: ");
  expect_contains(outcome.errors, "the last good state is kept in '" + state + "'");
  EXPECT_TRUE(std::filesystem::exists(state));
  EXPECT_EQ(read_csv(csv)["time"].size(), 1u);
}

TEST(Simulate, RecoveriesAndDoubtsAreSaid) {
  // A free hinge that turns by more than the allowed angle in a step. A step has 2.5 rad in the beginning, and half
  // steps are allowed.
  std::string text = kFailingScene;
  text.replace(
      text.find("<integrator"), std::string::npos,
      R"(<gravity xyz="0 0 0"/> <integrator step="0.1"/> <initial joint="hinge" velocity="25"/> </simulation> </robot>)");
  const Outcome outcome = shell("flexarm simulate " + scene_file(text) + " --until 1");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, " halvings (down to 1/2 of a step)");
  expect_contains(outcome.errors, "flexarm: warning: link 'rod'");
  expect_contains(outcome.errors, "too slow there");
  EXPECT_EQ(shell("flexarm simulate " + scene_file(text) + " --until 0.1 --on-failure dissipate").status, 0);
  EXPECT_EQ(shell("flexarm simulate " + scene_file(text) + " --on-failure hope").status, 2);
  EXPECT_EQ(shell("flexarm simulate " + scene_file(text) + " --scheme m1 --on-failure dissipate").status, 2);
}

TEST(Simulate, CheckpointsOnTheWay) {
  const std::string state = temporary("state"), way = temporary("way"), csv = temporary("out.csv");
  fs::remove(way);
  // The run is killed without notice. It leaves the state of the last checkpoint, from which another run continues.
  const Outcome outcome = ended_by(kEndless + "--checkpoint-every 0.5 --checkpoint " + way, "kill -KILL $!");
  EXPECT_NE(outcome.status, 0);
  const Outcome resumed = shell(kShort + "--resume " + way + " --output " + csv);
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  const double kept = read_csv(csv)["time"].at(0);
  EXPECT_GT(kept, 0);
  EXPECT_NEAR(std::remainder(kept, 0.5), 0, 1e-9 * kept);
  // Checkpoints during a run do not change the results.
  ASSERT_EQ(
      shell(kShort + "--checkpoint " + state + "; " + kShort + "--checkpoint-every 0.003 --checkpoint " + way).status,
      0);
  EXPECT_EQ(read_file(state), read_file(way));
  EXPECT_EQ(shell(kShort + "--checkpoint-every 1").status, 2) << "of which file?";
  EXPECT_EQ(shell(kShort + "--checkpoint-every 0 --checkpoint " + way).status, 2);
}

TEST(Simulate, PlaceOfTheCheckpointIsTriedBeforeTheRun) {
  for (const auto& [place, told] : {std::pair<std::string, std::string>("/no/such/state", "No such file or directory"),
                                    {"/dev/null", "it is not a regular file"},
                                    {testing::TempDir(), "it is not a regular file"}}) {
    const Outcome outcome = shell("'" + program() + "' " + kEndless + "--checkpoint " + place);
    EXPECT_EQ(outcome.status, 2);
    expect_contains(outcome.errors, "checkpoint '" + place + "' cannot be written: " + told);
  }
}

TEST(Simulate, StatesAreNoStreams) {
  for (const std::string option : {"--checkpoint", "--resume"}) {
    const Outcome outcome = shell(kShort + option + " -");
    EXPECT_EQ(outcome.status, 2);
    expect_contains(outcome.errors, option + ": a state must be a file");
  }
}

TEST(Simulate, FullDiskKeepsTheCheckpointThatIsThere) {
  const std::string state = temporary("state");
  ASSERT_EQ(shell(kShort + "--checkpoint " + state).status, 0);
  const std::string before = read_file(state);
  const Outcome full = shell("ulimit -f 1; '" + program() + "' " + kEndless + "--checkpoint " + state);
  EXPECT_EQ(full.status, 2);
  expect_contains(full.errors, "checkpoint '" + state + "' cannot be written: File too large");
  EXPECT_EQ(read_file(state), before);
  EXPECT_FALSE(fs::exists(state + ".partial"));
}

TEST(Simulate, CheckpointGoesWhereALinkPoints) {
  const std::string state = temporary("state"), link = temporary("link");
  fs::remove(link);
  std::ofstream(state) << "before";
  fs::create_symlink(state, link);
  ASSERT_EQ(shell(kShort + "--checkpoint " + link).status, 0);
  EXPECT_TRUE(fs::is_symlink(link));
  expect_contains(read_file(state), "flexarm-checkpoint");
}

TEST(Simulate, SignalsLeaveResultsAndStateAndAStatus) {
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143), std::pair("HUP", 129)}) {
    const std::string csv = temporary("out.csv"), state = temporary("state");
    fs::remove(state);
    const Outcome outcome = ended_by(kEndless + "--every 1000 --output " + csv + " --checkpoint " + state,
                                     "kill -" + std::string(signal) + " $!");
    EXPECT_EQ(outcome.status, status);
    expect_contains(outcome.errors, "interrupted at t = ");
    Columns columns = read_csv(csv);  // also checks the number of fields of every row
    EXPECT_GT(columns["time"].back(), 0);
    EXPECT_EQ(read_file(csv).back(), '\n');
    EXPECT_EQ(shell(kShort + "--resume " + state).status, 0);
  }
}

TEST(Simulate, IgnoredSignalsStayIgnored) {
  const Outcome outcome =
      shell("nohup '" + program() + "' " + kEndless + " & sleep 1; kill -HUP $!; sleep 0.5; kill -TERM $!; wait $!");
  EXPECT_EQ(outcome.status, 143) << "not 129";
}

// A row is one call of write. If a signal kills the program meanwhile, Linux may cut the write between two pages: once
// in sixty kills.
TEST(Simulate, KilledRunLeavesWholeRows) {
  const std::string csv = temporary("out.csv");
  ended_by(kEndless + "--output " + csv, "kill -KILL $!");
  const std::size_t whole = read_file(csv).rfind('\n') + 1;
  if (whole < fs::file_size(csv)) {
    EXPECT_EQ(fs::file_size(csv) % sysconf(_SC_PAGESIZE), 0u);
    fs::resize_file(csv, whole);
  }
  EXPECT_GT(read_csv(csv)["time"].size(), 100u);
}

TEST(Simulate, WriteErrorsAreReported) {
  const std::string scene = "flexarm simulate " + example("cantilever") + " --until 0.01 --output ";
  const Outcome full = shell(scene + "/dev/full");
  EXPECT_EQ(full.status, 2) << "the header already";
  expect_contains(full.errors, "cannot write '/dev/full': No space left on device");
  const Outcome missing = shell(scene + "/no/such/folder/out.csv");
  EXPECT_EQ(missing.status, 2);
  expect_contains(missing.errors, "cannot write '/no/such/folder/out.csv': No such file or directory");
}

TEST(Simulate, FullDiskKeepsWholeRowsAndTheState) {
  const std::string csv = temporary("out.csv"), state = temporary("state");
  fs::remove(state);
  const Outcome outcome =
      shell("ulimit -f 100; '" + program() + "' " + kEndless + "--output " + csv + " --checkpoint " + state);
  EXPECT_EQ(outcome.status, 1);
  expect_contains(outcome.errors, "cannot write '" + csv + "': File too large");
  EXPECT_GT(read_csv(csv)["time"].size(), 10u);
  EXPECT_EQ(read_file(csv).back(), '\n');
  EXPECT_EQ(shell(kShort + "--resume " + state).status, 0);
}

TEST(Simulate, StandardOutputTakesTheTableAlone) {
  const std::string csv = temporary("out.csv"), table = temporary("table.csv");
  ASSERT_EQ(shell(kShort + "--output " + csv).status, 0);
  const Outcome outcome = shell("cd " + testing::TempDir() + "; flexarm simulate " + example("rigid_double_pendulum") +
                                " --until 0.01 --output -");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output, read_file(csv));
  expect_contains(outcome.errors, " after 10 steps");
  EXPECT_FALSE(fs::exists(testing::TempDir() + "/-"));
  const Outcome equilibrium = shell("flexarm static " + example("cantilever") + " --output -");
  EXPECT_EQ(std::count(equilibrium.output.begin(), equilibrium.output.end(), '\n'), 2);
}

TEST(Simulate, ClosedPipeEndsTheRun) {
  const Outcome outcome =
      shell("{ '" + program() + "' " + kEndless + "--output -; echo status $? >&2; } | head -2 > /dev/null");
  expect_contains(outcome.errors, "cannot write the standard output: Broken pipe");
  expect_contains(outcome.errors, "status 1");
}

TEST(Static, OutputIsTriedBeforeTheSolution) {
  const std::string csv = temporary("out.csv");
  fs::remove(csv);
  const std::string command = "flexarm static " + example("cantilever") + " --output ";
  const Outcome missing = shell(command + "/no/such/folder/out.csv");
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.output, "") << "nothing has been solved";
  expect_contains(missing.errors, "cannot write '/no/such/folder/out.csv': No such file or directory");
  const Outcome full = shell(command + "/dev/full");
  EXPECT_EQ(full.status, 1);
  expect_contains(full.errors, "cannot write '/dev/full': No space left on device");
  // Without a solution no file is left: a constant moment turns the rod forever.
  std::string text = kFailingScene;
  text.replace(text.find("<integrator"), std::string::npos,
               R"(<gravity xyz="0 0 0"/> <load link="rod" at="0 0 0" moment="0 1 0"/> </simulation> </robot>)");
  EXPECT_EQ(shell("flexarm static " + scene_file(text) + " --output " + csv).status, 1);
  EXPECT_FALSE(fs::exists(csv));
}

TEST(Analyses, EndWithTheStatusesOfSignals) {
  // A scene whose modes and statics take long.
  std::string text = R"(<robot name="r"> <link name="world"/>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
    <link name="arm"> <beam elements="20000"> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
      <material young="70e9" poisson="0.33" density="2700"/> </beam> </link> </robot>)";
  const std::string scene = scene_file(text);
  for (const std::string command : {"static", "modes"})
    for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143)})
      EXPECT_EQ(ended_by(command + " " + scene, "kill -" + std::string(signal) + " $!").status, status) << command;
}

TEST(Simulate, InputIsNotOverwritten) {
  const std::string scene = scene_file(kFailingScene), link = temporary("link"), state = temporary("state");
  fs::remove(link);
  fs::create_symlink(scene, link);
  for (const std::string& arguments :
       {"--output " + scene, "--output " + link, "--checkpoint " + scene, "--output " + state + " --resume " + state,
        "--output " + state + " --checkpoint " + state}) {
    const Outcome outcome = shell("flexarm simulate " + scene + " " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    expect_contains(outcome.errors, " would overwrite '");
  }
  EXPECT_EQ(shell("flexarm static " + scene + " --output " + scene).status, 2);
  EXPECT_EQ(read_file(scene), kFailingScene);
}

TEST(Files, AnEndingThatStandsForNothingIsTold) {
  const auto errors = [](const std::string& name) {
    return shell("flexarm simulate " + example("rigid_double_pendulum") + " --until 0.01 --quiet --output " +
                 temporary(name))
        .errors;
  };
  expect_contains(errors("run.json"),
                  "gets CSV, as its ending '.json' stands for nothing else: there are .csv, .h5 (HDF5)");
  EXPECT_EQ(errors("run.csv"), "");
  EXPECT_EQ(errors("run"), "");
}

}  // namespace flexarm::cli
