/// Tests `flexarm bench`: runs its reports in their quick form, and checks files, messages and exit statuses.
#include <filesystem>

#include "cli/program.h"

namespace flexarm::cli {
namespace {

TEST(Bench, UsageErrors) {
  for (const char* arguments : {"bench", "bench fly", "bench properties --fast", "bench thesis --fast",
                                "bench speed --fast", "bench scaling --fast", "bench accuracy --fast",
                                "bench hard --fast", "bench hard --scheme guess", "bench hard --group soft"})
    EXPECT_EQ(shell(std::string("flexarm ") + arguments).status, 2) << arguments;
}

TEST(Bench, HelpIsThatOfTheCommand) {
  const Outcome outcome = shell("flexarm bench --help");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output.find("Measures the simulator itself\nUsage: flexarm bench [OPTIONS] SUBCOMMAND\n"), 0u)
      << outcome.output;
  expect_contains(shell("flexarm bench speed --help").output, "Usage: flexarm bench speed [OPTIONS]");
}

TEST(Bench, WithoutItsProgram) {
  // A copy of the program without its neighbour files, so that the program for benchmarks is missing.
  const std::string folder = temporary("alone");
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(program(), folder + "/flexarm", std::filesystem::copy_options::overwrite_existing);
  const Outcome outcome = shell("'" + folder + "/flexarm' bench speed --quick");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.errors, "flexarm: bench: its program flexarm_benchmarks is not installed beside this program\n");
}

TEST(Bench, PropertiesReport) {
  const std::string folder = temporary("reports");
  const Outcome outcome = shell("flexarm bench properties --quick --output '" + folder + "/new'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/new/properties.md");
  for (const char* row : {"\n| em |", "\n| newmark |", "\n| newmark, total, additive |", "\n| hht3, incremental |"})
    EXPECT_NE(report.find(row), std::string::npos) << row;
  const std::string data = read_file(folder + "/new/properties_dissipation.csv");
  EXPECT_EQ(data.substr(0, data.find('\n')), "scheme,omega_h,spectral_radius");
  // The picture is drawn if matplotlib is installed. Otherwise the report does not mention a picture.
  const bool is_drawn = std::filesystem::exists(folder + "/new/properties_dissipation.png");
  EXPECT_EQ(report.find("properties_dissipation.png") != std::string::npos, is_drawn);
  EXPECT_EQ(outcome.errors.empty(), is_drawn) << outcome.errors;

  // Only measured times differ from run to run.
  ASSERT_EQ(shell("flexarm bench properties --quick --output '" + folder + "/again'").status, 0);
  EXPECT_EQ(read_file(folder + "/again/properties_dissipation.csv"), data);
}

TEST(Bench, ThesisReport) {
  const std::string folder = temporary("thesis");
  const Outcome outcome = shell("flexarm bench thesis --quick --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/thesis.md");
  for (const char* line : {"\n## 12.1 ", "\n## 12.5 ", "\n| H2, alg3 |", "\n| em, sm_em, smooth line |"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  const std::string data = read_file(folder + "/thesis_12_2.csv");
  EXPECT_EQ(data.substr(0, data.find("travel")), "run,step,time,energy_defect,angular_momentum_defect,");
  EXPECT_EQ(report.find("thesis_12_2.png") != std::string::npos, std::filesystem::exists(folder + "/thesis_12_2.png"));

  const Outcome nowhere = shell("flexarm bench thesis --quick --output '" + folder + "' --scenes /nowhere");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_NE(nowhere.errors.find("/nowhere/12_1_screw_node_to_node.urdf"), std::string::npos) << nowhere.errors;
}

TEST(Bench, SpeedReport) {
  const std::string folder = temporary("speed");
  const Outcome outcome =
      shell("flexarm bench speed --quick --problem spin_up --problem double_pendulum --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/speed.md");
  for (const char* line : {"\n## Targets\n", "\n## Spin-up of a flexible beam\n", "\n## Flexible double pendulum\n"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  EXPECT_EQ(report.find("\n## Right-angle"), std::string::npos);
  const std::string data = read_file(folder + "/speed.csv");
  EXPECT_EQ(data.substr(0, data.find("order")), "problem,program,scheme,");
  EXPECT_EQ(report.find("speed.png") != std::string::npos, std::filesystem::exists(folder + "/speed.png"));
}

TEST(Bench, SpeedOfAProblemThatIsNone) {
  const Outcome outcome = shell("flexarm bench speed --quick --problem spaghetti");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("spaghetti"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("flying_spaghetti"), std::string::npos) << outcome.errors;
}

TEST(Bench, ScalingReport) {
  const std::string folder = temporary("scaling");
  const Outcome outcome = shell("flexarm bench scaling --quick --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/scaling.md");
  for (const char* line : {"\n| cantilever, order 1 | 10 elements |", "\n| rigid chain | 10 links |", "\n## tree\n"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  for (const char* word : {"nan", "inf", "fails"}) EXPECT_EQ(report.find(word), std::string::npos) << word;
  const std::string data = read_file(folder + "/scaling.csv");
  EXPECT_EQ(data.substr(0, data.find('\n')), "family,unit,size,unknowns,read,first_build,build,step,bytes,iterations");
  EXPECT_EQ(report.find("scaling.png") != std::string::npos, std::filesystem::exists(folder + "/scaling.png"));
}

TEST(Bench, HardReport) {
  const std::string folder = temporary("hard");
  const Outcome outcome = shell(
      "flexarm bench hard --quick --group mimic --group equilibrium --scheme em --scheme m1 --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/hard.md");
  for (const char* line : {"\n| em |", "\n| m1 |", "\n## mimic\n", "\n## equilibrium\n", "\n| ratio 1e+06 |"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  const std::string data = read_file(folder + "/hard.csv");
  EXPECT_EQ(data.substr(0, data.find("time")), "group,case,sound,scheme,verdict,end,part,");
  EXPECT_EQ(report.find("hard.png") != std::string::npos, std::filesystem::exists(folder + "/hard.png"));
}

TEST(Bench, HardScenesCanBePrintedAndRun) {
  const std::string file = temporary("hard.urdf");
  ASSERT_EQ(shell("flexarm bench hard --print --case 'triple rocker driven beyond its reach' > '" + file + "'").status,
            0);
  EXPECT_NE(read_file(file).find("<!-- dead point: triple rocker driven beyond its reach; until 2 s -->"),
            std::string::npos);
  EXPECT_EQ(shell("flexarm simulate --quiet --until 2 '" + file + "'").status, 1);
  ASSERT_EQ(shell("flexarm bench hard --print --case 'door on two hinges' > '" + file + "'").status, 0);
  EXPECT_EQ(shell("flexarm simulate --quiet --until 0.5 '" + file + "'").status, 0);
  EXPECT_EQ(shell("flexarm bench hard --print --case 'no such case'").status, 1);
}

TEST(Bench, AccuracyReport) {
  const std::string folder = temporary("accuracy");
  const Outcome outcome = shell("flexarm bench accuracy --quick --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/accuracy.md");
  for (const char* line : {"\n| **smooth** | 3 | 3 | 3 | 0 |", "\n| **cornered** | 1 | 1 | 1 |",
                           "\nCornered: true error", "\n| forces: jump at sqrt(0.1) | cornered | 0.01 |",
                           "\n| speed: six_joint_arm | smooth | 0.01 |", "\n| random: arm 1, 2 joints |"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  // The two lines of the summary are followed by the name of the report.
  EXPECT_EQ(outcome.output.find("Cornered: true error at most the requested one in "), 0u) << outcome.output;
  expect_contains(outcome.output, "\nSmooth: true error at most the requested one in 100.0 % of 3 judged runs");
  const std::string data = read_file(folder + "/accuracy.csv");
  EXPECT_EQ(data.substr(0, data.find("until")), "group,scene,corners,reference,");
  EXPECT_EQ(report.find("accuracy.png") != std::string::npos, std::filesystem::exists(folder + "/accuracy.png"));

  // References of bad quality are refused, and so is a name that is not the name of a scene.
  const std::string command = "flexarm bench accuracy --quick --output '" + folder + "' ";
  std::filesystem::create_directories(folder + "/references");
  std::ofstream(folder + "/references/index.csv") << "file,group,name,cornered,until,intervals,disagreement,events,"
                                                     "reference\nfall,forces,fall,1,1,4,1e-6,0,outside\n";
  const Outcome refused = shell(command + "--references '" + folder + "/references'");
  EXPECT_EQ(refused.status, 1);
  expect_contains(refused.errors, "index.csv:2: the reference of 'fall' is not good");
  std::ofstream(folder + "/references/index.csv")
      << "file,group,name,cornered,until,intervals,disagreement,events,reference\n";
  const Outcome nothing = shell(command + "--only nowhere --references '" + folder + "/references'");
  EXPECT_EQ(nothing.status, 1);
  expect_contains(nothing.errors, "there is no scene with 'nowhere' in its name");
}

TEST(Bench, AccuracyOfOtherRandomArms) {
  const std::string folder = temporary("other_arms");
  const Outcome outcome = shell("flexarm bench accuracy --quick --random-arms 34 2 --output '" + folder + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder + "/accuracy.md");
  for (const char* line : {"Random arms 34 to 35,", "\n| **smooth** | 2 | 2 |", "\n| random: arm 34, 7 joints |",
                           "\n| random: arm 35, 1 joints |"})
    EXPECT_NE(report.find(line), std::string::npos) << line;
  for (const char* arms : {"-1 2", "3", "3 x", "3 0"})
    EXPECT_NE(shell(std::string("flexarm bench accuracy --random-arms ") + arms).status, 0) << arms;
}

TEST(Bench, FolderThatCannotBeWritten) {
  const std::string file = temporary("file");
  std::ofstream(file) << "x";
  const Outcome outcome = shell("flexarm bench properties --quick --output '" + file + "'");
  EXPECT_EQ(outcome.status, 2);
  expect_contains(outcome.errors, "cannot write '" + file + "/properties.md': Not a directory");
}

TEST(Bench, SignalsEndItAndLeaveTheReportOfBefore) {
  const std::string folder = temporary("interrupted");
  std::filesystem::remove_all(folder);
  for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    const Outcome outcome = shell(interruptible_program() + "bench hard --group column --output '" + folder +
                                  "' & sleep 1; kill -" + signal + " $!; wait $!");
    EXPECT_EQ(outcome.status, status);
    expect_contains(outcome.errors, "nothing is written");
    EXPECT_TRUE(std::filesystem::is_empty(folder));
  }
}

TEST(Bench, FullDiskLeavesTheReportOfBefore) {
  const std::string folder = temporary("full");
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/hard.md") << "before";
  const Outcome outcome =
      shell("ulimit -f 1; '" + program() + "' bench hard --quick --group mimic --scheme em --scheme m1 --output '" +
            folder + "' > /dev/null");
  EXPECT_EQ(outcome.status, 1);
  expect_contains(outcome.errors, "cannot be written");
  EXPECT_EQ(read_file(folder + "/hard.md"), "before");
}

}  // namespace
}  // namespace flexarm::cli
