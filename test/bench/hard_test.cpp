// Tests the report on hard cases: it gives the outcome of each run, whatever happens in the run.
#include "bench/hard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <set>

#include "bench/urdf.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm::bench {
namespace {

using End = HardOutcome::End;

/// A body of 1 kg on a rail, pushed by 2 N for 1 s: it moves by 1 m.
HardCase carriage() {
  using namespace urdf;
  HardCase hard;
  hard.group = "group";
  hard.name = "carriage";
  hard.scene = scene(joint("rail", "prismatic", "world", "carriage", Vector3::Zero(),
                           axis({1, 0, 0}) + "<limit lower=\"-9\" upper=\"9\" effort=\"0\" velocity=\"0\"/>") +
                         body("carriage", 1, 0.01),
                     effort("rail", "2"));
  hard.step = 0.1;
  hard.until = 1;
  return hard;
}

Target rail_at(std::optional<double> expected) {
  Target target;
  target.what = "test";
  target.observe = [](const Simulation& s) { return Vector3(s.position(0), 0, 0); };
  target.tolerance = 1e-6;
  if (expected) target.expected = Vector3(*expected, 0, 0);
  target.step = 0.05;
  return target;
}

/// The case with another action in the function that measures its bound.
HardCase with_trouble(const std::function<void()>& trouble) {
  HardCase hard = carriage();
  hard.bound = Bound{"trouble", [trouble](const Simulation&) { return trouble(), 0; }};
  return hard;
}

HardOutcome run_once(const HardCase& hard, const HardOptions& options = {}) {
  return run_hard(hard, "em", find_target(hard, options), options);
}

HardOptions one_second() {
  HardOptions options;
  options.limits.seconds = 1;
  return options;
}

TEST(HardRuns, ARightOneIsCounted) {
  HardCase hard = carriage();
  hard.target = rail_at(1);
  const HardOutcome outcome = run_once(hard);
  EXPECT_EQ(outcome.end, End::Completed);
  EXPECT_EQ(outcome.steps, 10);
  EXPECT_GE(outcome.iterations, 10);
  EXPECT_NEAR(outcome.time, 1, 1e-12);
  EXPECT_LT(outcome.error, 1e-9);
  EXPECT_LT(outcome.energy_defect, 1e-9);
  EXPECT_TRUE(std::isnan(outcome.momentum_defect)) << "it is not free";
  EXPECT_EQ(verdict(hard, outcome), Verdict::Right);
}

TEST(HardRuns, ATargetMayBeAnotherRun) {
  HardCase hard = carriage();
  hard.target = rail_at({});
  EXPECT_LT(run_once(hard).error, 1e-9);  // a constant force is exact in any step
  hard.target->scene = "<robot name=\"broken\"/>";
  EXPECT_FALSE(find_target(hard, {}));
}

TEST(HardRuns, OffTargetOrOutOfBoundsIsWrong) {
  HardCase hard = carriage();
  hard.target = rail_at(1.1);
  HardOutcome outcome = run_once(hard);
  EXPECT_EQ(verdict(hard, outcome), Verdict::Wrong);
  EXPECT_EQ(flaw(hard, outcome), "off its target (test)");
  hard = carriage();
  hard.bound = Bound{"beyond half a metre", [](const Simulation& s) { return s.position(0) / 0.5; }};
  outcome = run_once(hard);
  EXPECT_NEAR(outcome.bound, 2, 1e-9);
  EXPECT_EQ(flaw(hard, outcome), "beyond half a metre");
}

TEST(HardRuns, WrongRunThatSaysSoIsWarned) {
  HardOutcome outcome;
  outcome.end = End::Completed;
  outcome.error = 1;
  HardCase hard = carriage();
  hard.target = rail_at(1);
  EXPECT_EQ(verdict(hard, outcome), Verdict::Wrong);
  outcome.warning[0] = 'w';
  EXPECT_EQ(verdict(hard, outcome), Verdict::Warned);
  outcome.error = 0;
  EXPECT_EQ(verdict(hard, outcome), Verdict::Right) << "a warning takes nothing from what is right";
}

TEST(HardRuns, EnergyFromNowhereIsWrong) {
  HardOutcome outcome;
  outcome.end = End::Completed;
  EXPECT_EQ(verdict(carriage(), outcome), Verdict::Right);
  for (const double gain : {0.1, std::numeric_limits<double>::quiet_NaN()}) {
    outcome.energy_gain = gain;
    EXPECT_EQ(flaw(carriage(), outcome), "energy from nowhere");
  }
  outcome.energy_gain = 0;
  outcome.energy_defect = 0.9;
  EXPECT_EQ(flaw(carriage(), outcome), "") << "schemes may dissipate";
  outcome.energy_defect = 1.1;
  EXPECT_EQ(flaw(carriage(), outcome), "more energy lost than there was");
}

// A contact must not gain energy, and schemes without contact are not run.
TEST(HardRuns, WhatTouchesHasRulesOfItsOwn) {
  HardCase hard = carriage();
  hard.touches = true;
  HardOutcome outcome;
  outcome.end = End::Completed;
  outcome.energy_gain = 1e-3;
  EXPECT_EQ(flaw(carriage(), outcome), "");
  EXPECT_EQ(flaw(hard, outcome), "energy from nowhere");
  hard.scene.replace(hard.scene.find("</robot>"), 0,
                     "<ground name=\"floor\" offset=\"-5\"/> <contact first=\"carriage\" second=\"floor\"/>");
  hard.scene.replace(hard.scene.find("</inertial>"), 11,
                     "</inertial> <collision> <geometry> <sphere radius=\"0.1\"/> </geometry> </collision>");
  outcome = run_hard(hard, "newmark", {}, {});
  EXPECT_EQ(outcome.end, End::Refused);
  EXPECT_EQ(verdict(hard, outcome), Verdict::LeftOut) << outcome.reason.data();
  EXPECT_EQ(run_hard(hard, "em", {}, {}).end, End::Completed);
}

TEST(HardRuns, AFreeMotionMustKeepItsMomenta) {
  HardCase hard = carriage();
  HardOutcome outcome;
  outcome.end = End::Completed;
  outcome.momentum_defect = 0.1;
  EXPECT_EQ(flaw(hard, outcome), "");
  hard.is_free = true;
  EXPECT_EQ(flaw(hard, outcome), "momentum lost");
}

TEST(HardRuns, AFailureHasItsTimeAndReason) {
  HardCase hard = carriage();
  hard.scene.replace(hard.scene.find("history=\"2\""), 11,
                     "history=\"2 + 0*sqrt(0.42 - t)\"");  // not a number from then on
  const HardOutcome outcome = run_once(hard);
  EXPECT_EQ(outcome.end, End::Failed);
  EXPECT_GE(outcome.time, 0.4);
  EXPECT_LT(outcome.time, 0.45) << "not beyond half of the step that has no load in its middle";
  EXPECT_STREQ(outcome.reason.data(), to_string(StepResult::Reason::NotFinite));
  EXPECT_EQ(verdict(hard, outcome), Verdict::Failed);
  hard.is_sound = false;
  EXPECT_EQ(verdict(hard, outcome), Verdict::Diagnosed);
}

TEST(HardRuns, NotToConvergeIsNoDiagnosis) {
  HardCase hard = carriage();
  hard.is_sound = false;
  hard.scene.replace(hard.scene.find("<effort"), 7, "<integrator max_iterations=\"1\" max_halvings=\"0\"/> <effort");
  const HardOutcome outcome = run_once(hard);
  EXPECT_STREQ(outcome.reason.data(), to_string(StepResult::Reason::NoConvergence));
  EXPECT_EQ(verdict(hard, outcome), Verdict::Undiagnosed);
}

TEST(HardRuns, ARefusalSaysWhy) {
  HardCase hard = carriage();
  hard.is_sound = false;
  hard.scene.replace(hard.scene.find("mass value=\"1\""), 14, "mass value=\"0\"");
  hard.scene.replace(hard.scene.find("ixx=\"0.01\""), 10, "ixx=\"oops\"");
  const HardOutcome outcome = run_once(hard);
  EXPECT_EQ(outcome.end, End::Refused);
  EXPECT_NE(std::string(outcome.reason.data()).find("oops"), std::string::npos) << outcome.reason.data();
  EXPECT_EQ(verdict(hard, outcome), Verdict::Diagnosed);
}

TEST(HardRuns, UnsoundAndCompletedIsUnnoticed) {
  HardCase hard = carriage();
  hard.is_sound = false;
  EXPECT_EQ(verdict(hard, run_once(hard)), Verdict::Unnoticed);
}

TEST(HardRuns, AHangIsEnded) {
  const HardCase hard = with_trouble([] {
    for (volatile bool goes_on = true; goes_on;) continue;
  });
  const HardOutcome outcome = run_once(hard, one_second());
  EXPECT_EQ(outcome.end, End::OutOfTime);
  EXPECT_NEAR(outcome.time, 0.1, 1e-12) << "how far it had come";
  EXPECT_EQ(outcome.steps, 1);
  EXPECT_EQ(verdict(hard, outcome), Verdict::Failed);
}

TEST(HardRuns, ACrashIsOneRunsOnly) {
  const HardOutcome outcome = run_once(with_trouble([] {
    std::signal(SIGABRT, SIG_DFL);
    std::raise(SIGABRT);
  }));
  EXPECT_EQ(outcome.end, End::Crashed);
  EXPECT_STREQ(outcome.reason.data(), strsignal(SIGABRT));
  EXPECT_EQ(outcome.steps, 1);
  const HardOutcome thrown = run_once(with_trouble([] { throw std::logic_error("lost"); }));
  EXPECT_EQ(thrown.end, End::Crashed);
  EXPECT_STREQ(thrown.reason.data(), "exception: lost");
}

TEST(HardRuns, MemoryIsBounded) {
  if (!limits_memory()) GTEST_SKIP() << "a sanitizer needs all addresses for itself";
  const HardOptions options;
  const HardOutcome outcome = run_once(with_trouble([&] {
    char* volatile memory = new char[options.limits.bytes];
    delete[] memory;
  }));
  EXPECT_EQ(outcome.end, End::OutOfMemory);
}

TEST(HardCases, CanAllBeReadAndHaveNamesOfTheirOwn) {
  const std::vector<HardCase> cases = hard_cases();
  EXPECT_GE(cases.size(), 150u);
  std::set<std::string> names;
  for (const HardCase& hard : cases) {
    EXPECT_TRUE(names.insert(hard.group + hard.name).second) << hard.group << ": " << hard.name;
    const scene::ReadResult read = scene::read_scene_text(hard.scene, hard.name);
    EXPECT_TRUE(read.scene) << hard.name << "\n" << to_text(read.diagnostics);
    EXPECT_GT(hard.step, 0) << hard.name;
    EXPECT_EQ(hard.until > 0, hard.load_steps == 0) << hard.name;
  }
}

TEST(HardReports, HaveARowForEachCaseAndSayWhatFailed) {
  HardCase wrong = carriage();
  wrong.name = "wrong carriage";
  wrong.target = rail_at(3);
  HardOptions options;
  options.schemes = {"em", "newmark"};
  std::vector<double> parts;
  const HardReport report =
      measure_hard({carriage(), wrong}, options, [&](double part, const std::string&) { parts.push_back(part); });
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_EQ(parts.back(), 1);
  const std::string text = to_markdown(report, "");
  for (const char* line : {"\n| em | 1 | 0 | 1 | 0 |", "\n| newmark | 1 | 0 | 1 | 0 |",
                           "\n| group: wrong carriage | off its target (test) |", "\n| carriage | 0.1 | 10 | 1."})
    EXPECT_NE(text.find(line), std::string::npos) << text;
  const std::string data = hard_to_csv(report);
  EXPECT_NE(data.find("\n\"group\",\"wrong carriage\",1,newmark,wrong,completed,1,"), std::string::npos) << data;
  EXPECT_EQ(std::count(data.begin(), data.end(), '\n'), 5);
}

}  // namespace
}  // namespace flexarm::bench
