/// Tests runs that are repeated since elements of a beam wound up (refine="auto"), by running the program.

#include <cmath>
#include <string>

#include "cli/program.h"
#include "math/pi.h"

namespace flexarm::cli {
namespace {

constexpr double kMoment = 9 * kPi;  // four and a half turns [N m]

/// Two elements, slowly bent by a moment at the tip, by one radian for each N m. Damping keeps the beam at rest.
std::string wound_beam(const std::string& attributes, double moment) {
  return "<robot name=\"r\"> <link name=\"world\"/> <link name=\"arm\"> <beam elements=\"2\" " + attributes + R"(>
    <centerline> <line to="1 0 0"/> </centerline>
    <section ea="1e5" ga2="3.5e4" ga3="3.5e4" gj="0.8" ei2="1" ei3="1" mass="1" j1="2e-5" j2="1e-5" j3="1e-5"/>
    <damping stiffness_proportional="3e-3"/> </beam> </link>
    <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
    <simulation> <gravity xyz="0 0 0"/> <integrator step="0.02"/> <probe name="tip" link="arm" at="1 0 0"/>
    <load link="arm" at="1 0 0" moment="0 )" +
         std::to_string(moment) + R"( 0" history="(1 - cos(_pi*min(t, 20)/20))/2"/>
    </simulation> </robot>)";
}

/// Simulates the beam; results go to `csv`.
Outcome simulated(const std::string& attributes, const std::string& csv, const std::string& options = "",
                  double moment = kMoment) {
  return shell("cd " + testing::TempDir() + "; flexarm simulate " + scene_file(wound_beam(attributes, moment)) +
               " --until 20 --quiet --every 100 --output " + csv + " " + options);
}

}  // namespace

TEST(Refine, RunInWhichElementsWindUpIsRepeated) {
  const std::string repeated = temporary("repeated.csv"), refined = temporary("refined.csv");
  for (const char* open : {"", "refine=\"auto\""}) {
    const Outcome outcome = simulated(open, repeated);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_contains(outcome.errors, "an element is bent by nearly a turn, or more, between its nodes");
    expect_contains(outcome.errors, "of 2 of link 'arm'");
    expect_contains(outcome.errors, "flexarm: warning: the run is repeated from its beginning with refine=\"true\"");
  }
  const Outcome asked = simulated("refine=\"true\"", refined);
  EXPECT_EQ(asked.status, 0);
  EXPECT_EQ(asked.errors.find("repeated"), std::string::npos) << asked.errors;
  EXPECT_EQ(read_file(repeated), read_file(refined));
  // On a circle the tip has turned by 9 pi. The bound on the turning of an element is for an error of 1 %.
  Columns columns = read_csv(repeated);
  EXPECT_NEAR(columns["probe/tip/x"].back(), 0, 0.01);
  EXPECT_NEAR(columns["probe/tip/z"].back(), -2 / (9 * kPi), 0.01);
}

TEST(Refine, RepetitionThatFailsSaysHowToReadItsState) {
  const Outcome outcome = simulated("", temporary("hopeless.csv"), "", 100 * kMoment);
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  expect_contains(outcome.errors, "flexarm: warning: the run is repeated from its beginning with refine=\"true\"");
  expect_contains(outcome.errors, "; to read it, write refine=\"true\" in the beams of the scene");
}

TEST(Refine, OtherwiseTheRunFailsAsBefore) {
  const std::string csv = temporary("failed.csv");
  const auto expect_fails = [](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 1) << outcome.errors;
    expect_contains(outcome.errors, "an element is bent by nearly a turn, or more, between its nodes");
    expect_contains(outcome.errors, "or refine=\"true\" of its <beam>");
    EXPECT_EQ(outcome.errors.find("repeated"), std::string::npos) << outcome.errors;
  };
  expect_fails(simulated("refine=\"false\"", csv));
  expect_fails(simulated("", "-"));  // its reader has got the rows already
  const std::string pipe = temporary("pipe");
  ASSERT_EQ(shell("rm -f " + pipe + "; mkfifo " + pipe).status, 0);
  expect_fails(simulated("", pipe + " & cat " + pipe + " > /dev/null; wait $!"));
  expect_fails(simulated("", csv, "--checkpoint " + temporary("state")));
  expect_fails(simulated("", csv, "--error-estimate"));
}

}  // namespace flexarm::cli
