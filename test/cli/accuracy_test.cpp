// Tests `flexarm simulate --accuracy` and its estimates of errors by running the program.
#include <cmath>
#include <regex>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace flexarm::cli {
namespace {

TEST(SimulateAccuracy, WritesTheRowsOfTheRunThatMetIt) {
  const std::string csv = temporary("accurate.csv"), fine = temporary("fine.csv");
  const std::string scene = example("rigid_double_pendulum");
  const Outcome outcome =
      shell("flexarm simulate " + scene + " --until 1 --accuracy 1e-4 --interval 0.1 --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_contains(outcome.output, "accuracy 0.0001 requested, error ");
  Columns columns = read_csv(csv);
  ASSERT_EQ(columns["time"].size(), 11u);
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(columns["time"][i], 0.1 * i, 1e-12);
  ASSERT_EQ(shell("flexarm simulate " + scene + " --until 1 --step 1e-4 --every 1000 --quiet --output " + fine).status,
            0);
  Columns reference = read_csv(fine);
  double way = 0, sum = 0;
  for (int i = 0; i <= 10; ++i) {
    double error = 0, moved = 0;
    for (const char* axis : {"probe/tip/x", "probe/tip/y", "probe/tip/z"}) {
      error += std::pow(columns[axis][i] - reference[axis][i], 2);
      moved += std::pow(reference[axis][i] - reference[axis][0], 2);
    }
    sum += (i == 0 || i == 10 ? 0.05 : 0.1) * error;
    way = std::max(way, std::sqrt(moved));
  }
  EXPECT_LE(std::sqrt(sum) / way, 1e-4);
  // The estimate in the last row is for the time of that row, not for the whole run.
  EXPECT_GT(columns["solver/error_estimate"][10], 0);
  EXPECT_LT(columns["solver/error_estimate"][10], 1e-3 * way);
}

// If the scene leaves the choice of the scheme open, the run may take another scheme than the scene's default. Both
// lines of the report name the scheme that ran.
TEST(SimulateAccuracy, NamesTheSchemeThatRan) {
  const Outcome outcome =
      shell("flexarm simulate " + example("rigid_double_pendulum") + " --until 1 --scheme auto --accuracy 1e-6");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(outcome.output, found, std::regex(R"((\d+) steps of (\w+);)"))) << outcome.output;
  EXPECT_TRUE(found[2] == "rk4" || found[2] == "dop853") << found[2];
  expect_contains(outcome.output,
                  found[2].str() + " conserves no energy: energy - work + dissipation drifted by up to ");
  expect_contains(outcome.output, "after " + found[1].str() + " steps (" + found[2].str() + ", ");
}

// The rod of one metre turns freely by 1e-8 rad only. Errors are then relative to the mechanism's size, and the report
// says so.
TEST(SimulateAccuracy, SaysWhereErrorsAreNotRelativeToTheWay) {
  const auto run = [](const std::string& velocity) {
    return shell("flexarm simulate --until 1 --accuracy 1e-3 " + scene_file(R"(<robot name="r"> <link name="world"/>
      <link name="rod"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1"/>
        <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
      <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
      <simulation> <gravity xyz="0 0 0"/> <initial joint="hinge" velocity=")" +
                                                                            velocity + R"("/>
        <probe name="tip" link="rod" at="1 0 0"/> </simulation> </robot>)"));
  };
  const Outcome rest = run("1e-8"), motion = run("1e-2");
  EXPECT_EQ(rest.status, 0) << rest.errors;
  expect_contains(rest.output, " m (the mechanism's size, since points move by only 1e-08 m); ");
  EXPECT_EQ(motion.status, 0) << motion.errors;
  expect_contains(motion.output, ", relative to 0.01 m; ");
}

TEST(SimulateAccuracy, SaysWhatWasReachedWhereItIsNotMet) {
  const Outcome outcome =
      shell("flexarm simulate " + example("rigid_double_pendulum") + " --until 0.5 --interval 0.1 --accuracy 1e-16");
  EXPECT_EQ(outcome.status, 1);
  expect_contains(outcome.errors, "the accuracy 1e-16 was not met: ");
  expect_contains(outcome.errors, "estimated error ");
}

TEST(SimulateAccuracy, RefusesWhatContradictsIt) {
  const std::string start = "flexarm simulate " + example("rigid_double_pendulum") + " --until 1 --accuracy ";
  for (const auto& [arguments, text] :
       {std::pair("2", "between 0 and 1"),
        {"1e-3 --interval 0.3", "--interval: expected the 1 s until --until divided by a whole number"},
        {"1e-3 --every 2", "--every cannot be used with an accuracy: use --interval"},
        {"1e-3 --output -", "a file is expected"},
        {"1e-3 --checkpoint x.state --checkpoint-every 0.1", "--checkpoint-every cannot be used with an accuracy"}}) {
    const Outcome outcome = shell(start + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    expect_contains(outcome.errors, text);
  }
}

TEST(SimulateAccuracy, IsTakenFromTheSceneUnlessThereIsAStep) {
  const std::string scene = scene_file(R"(<robot name="r"> <link name="world"/>
    <link name="rod"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/> </joint>
    <simulation> <integrator accuracy="1e-3"/> </simulation> </robot>)");
  expect_contains(shell("flexarm simulate " + scene + " --until 1").output, "accuracy 0.001 requested");
  const std::string fixed = shell("flexarm simulate " + scene + " --until 1 --step 0.01").output;
  expect_contains(fixed, "after 100 steps");
  EXPECT_EQ(fixed.find("accuracy"), std::string::npos);
}

TEST(SimulateAccuracy, EqualStepsHaveAnEstimateOnRequest) {
  const std::string csv = temporary("estimate.csv");
  const Outcome outcome = shell("flexarm simulate " + example("rigid_double_pendulum") +
                                " --until 1 --step 0.01 --error-estimate --quiet --output " + csv);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::vector<double> estimates = read_csv(csv)["solver/error_estimate"];
  ASSERT_EQ(estimates.size(), 101u);
  EXPECT_TRUE(std::isnan(estimates[1])) << "of the first step nothing is known";
  for (std::size_t i = 3; i < estimates.size(); ++i) EXPECT_GE(estimates[i], estimates[i - 1]);
}

}  // namespace
}  // namespace flexarm::cli
