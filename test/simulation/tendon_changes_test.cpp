// Tests that lines keep what they have wound up and slipped when a program changes the mechanism in a run.
#include <cmath>
#include <string>

#include "flexarm/model/model_error.h"
#include "flexarm/simulation/payloads.h"
#include "math/pi.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kRadius = 0.1;  // of drums [m]

scene::SceneDescription line_scene(const std::string& parts, const std::string& scheme = "em",
                                   const std::string& more = "") {
  return scene_of_parts(parts, gravity({0, 0, -9.81}) + more, 1e-3, scheme);
}

std::string small_body(const std::string& name, double mass) {
  return body(name, mass, Vector3::Constant(0.001));
}

std::string free_body(const std::string& name, double mass, const std::string& at) {
  return joint(name + "_flight", "floating", "world", name, "<origin xyz='" + at + "'/>") + small_body(name, mass);
}

/// A drum that turns about the y axis at the world's origin. Its line leaves it downwards at x = 0.1 m.
std::string drum() {
  return joint("drum", "continuous", "world", "drum", "<axis xyz='0 1 0'/>") + small_body("drum", 2);
}
const char* const kOnDrum = R"(<pulley link="drum" axis="0 1 0" radius="0.1" grips="true"/>)";

/// A line between the drum and a point of the world 2 m below it.
const std::string kHeldLine =
    drum() + fmt::format(R"(<tendon name="line" ea="10"> {} <via link="world" at="0.1 0 -2"/> </tendon>)", kOnDrum);

}  // namespace

TEST(TendonChanges, DrumsWindUpWholeTurnsWhenTheyAreSet) {
  Simulation s(line_scene(kHeldLine));
  double start = energy_account(s);
  for (const double angle : {-6 * kPi, 40.0, 0.0, -0.6 * kPi, 0.6 * kPi, -6 * kPi}) {
    s.set_joint_state({{0, angle, 0.0}});
    const double rest = 2 + kRadius * angle;
    EXPECT_NEAR(column(s, "tendon/line/tension"), rest < 2 ? 10 * (2 - rest) / rest : 0, 1e-10) << angle;
    EXPECT_NEAR(column(s, "tendon/line/length"), 2, 1e-14);
  }
  EXPECT_NEAR(energy_account(s), start, 1e-10);  // what is set from outside counts as work
  run(s, 100);
  EXPECT_NEAR(energy_account(s), start, 1e-9);
}

TEST(TendonChanges, WhatHasSlippedStays) {
  const std::string parts = free_body("ball", 1, "1 0 -1") + R"(<tendon name="line" ea="2000">
      <via link="world" at="-1 0 0"/> <via link="world" friction="0.3"/> <via link="ball"/> </tendon>)";
  Simulation s(line_scene(parts));
  run(s, 700);
  const double first = column(s, "tendon/line/tension"), last = column(s, "tendon/line/last_tension");
  ASSERT_GT(std::abs(last - first), 0.01 * last);
  ASSERT_GT(s.energies().dissipated, 1e-3);  // it has slipped
  const double strain = s.energies().strain;
  const auto expect_same = [&](const Simulation& other) {
    EXPECT_NEAR(column(other, "tendon/line/tension"), first, 1e-9 * last);
    EXPECT_NEAR(column(other, "tendon/line/last_tension"), last, 1e-9 * last);
    EXPECT_NEAR(other.energies().strain, strain, 1e-9 * strain);
  };
  Simulation other(line_scene(parts, "newmark"));
  other.take_over(s);
  expect_same(other);
  s.set_joint_state({});
  expect_same(s);
}

TEST(TendonChanges, APayloadThatComesAndGoesLeavesTheLine) {
  Simulation s(line_scene(
      drum() + free_body("hook", 1, "0.1 0 -2") + free_body("load", 3, "0.1 0.2 -6") +
      fmt::format(R"(<tendon name="line" ea="2e4" damping="20"> {} <via link="hook"/> </tendon>)", kOnDrum)));
  run(s, 900);  // the drum is turned by the falling hook, several times
  ASSERT_GT(std::abs(s.position(0)), 10.0);
  const double start = energy_account(s), tension = column(s, "tendon/line/tension");
  ASSERT_GT(tension, 0.5);
  const auto expect_continued = [&](double expected) {
    EXPECT_NEAR(column(s, "tendon/line/length"), 2 + kRadius * s.position(0), 0.01);  // but for its stretch
    EXPECT_NEAR(column(s, "tendon/line/tension"), expected, 1e-6 * expected);
    EXPECT_NEAR(energy_account(s), start, 1e-8);
  };
  const double length = column(s, "tendon/line/length");
  attach(s, "load", "hook");
  EXPECT_NEAR(column(s, "tendon/line/length"), length, 1e-12);
  // The damper's part has changed, since the hook's velocity has.
  run(s, 400);
  const double before = column(s, "tendon/line/tension");
  detach(s, "load");
  expect_continued(before);
  run(s, 100);
  EXPECT_NEAR(energy_account(s), start, 1e-8);
}

// The line is as long as at the start of the scene. In the scene that attaching makes, the ball starts 0.3 m farther
// away.
TEST(TendonChanges, AnAttachedBallDoesNotMeasureItsLineAnew) {
  Simulation s(line_scene(rail("slide", "carriage", "0 0 1") + small_body("carriage", 1) +
                          free_body("ball", 1, "0 0 -2") +
                          R"(<tendon name="line" ea="400"> <via link="world"/> <via link="ball"/> </tendon>)"));
  s.set_joint_state({{*s.find_coordinate("ball_flight/z"), -0.3, 0.0}});
  EXPECT_NEAR(column(s, "tendon/line/tension"), 400 * 0.3 / 2, 1e-10);
  attach(s, "ball", "carriage");
  EXPECT_NEAR(column(s, "tendon/line/tension"), 400 * 0.3 / 2, 1e-10);
  const double start = energy_account(s);
  run(s, 100);
  detach(s, "ball");
  run(s, 200);
  EXPECT_NEAR(energy_account(s), start, 1e-9);
}

TEST(TendonChanges, AFailureNamesTheLine) {
  const auto explained = [](const std::string& tendon) {
    Simulation s(line_scene(free_body("ball", 1, "0 0 -1") + tendon));
    StepResult result;
    for (int n = 0; n < 1000 && (n == 0 || result.converged); ++n) result = s.step();
    EXPECT_EQ(result.reason, StepResult::Reason::NotFinite);
    return s.explain(result);
  };
  // Nothing is left of the line; its function is not finite; the ball falls into the rim of a pulley below it.
  for (
      const char* tendon :
      {R"(<tendon name="line" ea="1" rest_length="0.5-t"> <via link="world"/> <via link="ball"/> </tendon>)",
       R"(<tendon name="line" ea="1" rest_length="t < 0.01 ? 1 : sqrt(-1) "> <via link="world"/> <via link="ball"/> </tendon>)",
       R"(<tendon name="line" ea="1"> <via link="world" at="1 0 -1.5"/> <pulley link="world" at="0 0 -1.5" axis="0 1 0"
             radius="0.2" side="left" friction="0.1"/> <via link="ball"/> </tendon>)"}) {
    const std::string text = explained(tendon);
    expect_contains(text, "not finite: at <tendon> 'line'");
    expect_contains(text, "guides outside the rims");
  }
}

// No unknown belongs to the line then.
// The second of two lines without names is the first one afterwards.
TEST(TendonChanges, LinesWithoutNamesAreNotMistaken) {
  const auto winch_drum = [](const std::string& name, const std::string& y) {
    return joint(name, "continuous", "world", name, "<origin xyz='0 " + y + " 0'/><axis xyz='0 1 0'/>") +
           small_body(name, 2) +
           fmt::format(R"(<tendon ea="10"> <pulley link="{0}" axis="0 1 0" radius="0.1" grips="true"/>
                            <via link="world" at="0.1 {1} -2"/> </tendon>)",
                       name, y);
  };
  Simulation s(line_scene(winch_drum("first", "0") + winch_drum("second", "1")));
  s.set_joint_state({{0, -2.0, 0.0}, {1, -5 * kPi, 0.0}});
  const auto energy = [](double angle) { return 0.5 * 10 * std::pow(kRadius * angle, 2) / (2 + kRadius * angle); };
  EXPECT_NEAR(s.energies().strain, energy(-2.0) + energy(-5 * kPi), 1e-11);
  remove(s, "first");
  EXPECT_NEAR(s.energies().strain, energy(-5 * kPi), 1e-11);
}

TEST(TendonChanges, LinesWithoutNamesOnTheSameBodiesKeepTheirOwn) {
  const std::string line = R"(<tendon ea="2000"> <via link="world" at="-1 {0} 0"/> <via link="world" at="0 {0} 0"
                                friction="{1}"/> <via link="ball"/> </tendon>)";
  Simulation s(line_scene(free_body("ball", 1, "1 0 -1") + free_body("other", 1, "9 0 0") +
                          fmt::format(line, 0.0, 0.1) + fmt::format(line, 0.5, 0.6)));
  run(s, 700);
  ASSERT_GT(s.energies().dissipated, 1e-3);  // they have slipped
  const double strain = s.energies().strain;
  remove(s, "other");
  EXPECT_NEAR(s.energies().strain, strain, 1e-9 * strain);
}

TEST(TendonChanges, AnEmptyLineFailsAlsoWhereNothingMoves) {
  Simulation s(line_scene(rail("rail", "mass", "1 0 0") + small_body("mass", 1) +
                              R"(<tendon name="line" ea="10" rest_length="1-10*t"> <via link="world" at="0 0 1"/>
                               <via link="mass"/> </tendon>)",
                          "em", "<motion joint=\"rail\" position=\"1\"/>"));
  StepResult result;
  for (int n = 0; n < 200 && (n == 0 || result.converged); ++n) result = s.step();
  EXPECT_EQ(result.reason, StepResult::Reason::NotFinite);
  EXPECT_NE(s.explain(result).find("<tendon> 'line'"), std::string::npos) << s.explain(result);
  EXPECT_TRUE(std::isfinite(s.energies().strain));
}

TEST(TendonChanges, FrictionHasNoBackwardSteps) {
  const std::string parts = free_body("ball", 1, "0 0 -1") +
                            R"(<tendon name="line" ea="1"> <via link="world" at="1 0 0"/>
                                 <via link="world"{}/> <via link="ball"/> </tendon>)";
  const auto with = [&](const std::string& friction) {
    std::string text = parts;
    return text.replace(text.find("{}"), 2, friction);
  };
  EXPECT_NO_THROW(Simulation(line_scene(with(""), "em4")));
  EXPECT_NO_THROW(Simulation(line_scene(with(" friction=\"0.1\""), "em")));
  expect_contains(refusal<ModelError>([&] { Simulation(line_scene(with(" friction=\"0.1\""), "em4")); }),
                  "scheme 'em4' has no <tendon> with friction");
}

namespace {

/// A pendulum on a rope that a winch takes in, beside a spring and a tendon between it and the world.
scene::SceneDescription hoisted_pendulum() {
  scene::SceneDescription out = line_scene(free_body("bob", 1, "0.5 0.2 -1") +
                                           R"(<tendon name="rope" ea="1e4" damping="5"> <via link="world" at="0 0 0.3"/>
           <pulley link="world" at="0.1 0 0" axis="0 1 0" radius="0.05" side="left" wrap="1"/> <via link="bob"/> </tendon>
         <winch name="hoist" tendon="rope"> <drive rotor_inertia="0.5"/> </winch>
         <spring name="side" from="world" from_at="0 1 -1" to="bob" stiffness="20"/>
         <tendon name="stay" ea="100"> <via link="world" at="1 1 -1"/> <via link="bob" at="0.01 0 0"/> </tendon>)");
  return out;
}

}  // namespace

TEST(TendonChanges, AModelWithLinesIsSpawnedAnywhere) {
  Simulation alone(hoisted_pendulum());
  Simulation s(line_scene(free_body("other", 1, "30 0 0")));
  const Quaternion turn(Eigen::AngleAxisd(2.2, Vector3::UnitZ()));
  for (const std::string prefix : {"a_", "b_"})
    spawn(s, hoisted_pendulum(),
          {{{prefix == "a_" ? 4.0 : -3.0, 1, 2}, turn}, Vector3::Zero(), Vector3::Zero(), prefix});
  run(alone, 300);
  run(s, 300);
  for (const std::string prefix : {"a_", "b_"}) {
    for (const std::string name : {"rope", "stay"})
      EXPECT_NEAR(column(s, "tendon/" + prefix + name + "/tension"), column(alone, "tendon/" + name + "/tension"), 1e-7)
          << prefix << name;
    EXPECT_NEAR(column(s, "spring/" + prefix + "side/length"), column(alone, "spring/side/length"), 1e-9);
    EXPECT_NEAR(column(s, "joint/" + prefix + "hoist/position"), column(alone, "joint/hoist/position"), 1e-9);
  }
  remove(s, "a_bob");  // its lines and their winch go with it
  EXPECT_NEAR(column(s, "joint/b_hoist/position"), column(alone, "joint/hoist/position"), 1e-9);
  for (const std::string& name : s.coordinate_names()) EXPECT_NE(name, "a_hoist");
  run(s, 10);
}

}  // namespace flexarm::test
