// Derivatives of runs over stops and dry friction, against those of the exact motion.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/sensitivity_scenes.h"

namespace flexarm::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Derivative {
  double position = 0, velocity = 0;  // of the first joint, by the first direction
  std::string lost;
  std::vector<RunEvent> events;
  int count(const std::string& what) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(), [&](const RunEvent& event) { return event.what == what; }));
  }
  bool is_doubtful() const {
    return std::any_of(events.begin(), events.end(), [](const RunEvent& event) { return !event.doubt.empty(); });
  }
};

Derivative derivative_of(const Scene& scene, const SensitivityRequest& request, double until) {
  Simulation simulation = scene.simulation();
  Sensitivities sensitivities(simulation, request);
  const long steps = std::lround(until / simulation.step_size());
  for (long i = 0; i < steps; ++i) EXPECT_TRUE(sensitivities.step().converged);
  return {sensitivities.positions()(0, 0), sensitivities.velocities()(0, 0), sensitivities.lost(),
          sensitivities.events()};
}

Derivative derivative_by(const std::string& parameter, const std::string& text, double until) {
  const Scene scene{text};
  return derivative_of(scene, scene.request({parameter}), until);
}

/// The scenes in which this was found wrong: an arm of 1 kg, 0.5 m from its hinge, under gravity.
std::string arm(const std::string& parameter, const std::string& joint, const std::string& simulation) {
  return R"(<robot name="p"> )" + parameter + R"( <link name="world"/>
    <link name="a"> <inertial> <origin xyz="0.5 0 0"/> <mass value="1.0"/>
      <inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <joint name="h" )" +
         joint + R"( </joint> <simulation> )" + simulation + R"( </simulation> </robot>)";
}

std::string bouncing_arm(double step) {
  return arm(R"(<parameter name="angle" value="1"/>)",
             R"(type="revolute"> <parent link="world"/> <child link="a"/> <axis xyz="0 -1 0"/>
                <limit lower="-0.4" upper="1.6" effort="0" velocity="0"/>)",
             fmt::format(R"x(<integrator step="{}"/> <initial joint="h" position="${{angle}}"/>
                <effort joint="h" history="0.3*sin(4*t)"/>)x",
                         step));
}

std::string rubbing_arm(double step) {
  return arm(R"(<parameter name="fc" value="1.5"/>)",
             R"(type="continuous"> <parent link="world"/> <child link="a"/> <axis xyz="0 -1 0"/>
                <dynamics friction="${fc}"/> <friction law="coulomb"/>)",
             fmt::format(R"(<integrator step="{}"/> <initial joint="h" position="1"/>)", step));
}

/// Of a rod about the z axis, without gravity across it: 1.3 kg m^2. Its friction is 2 N m.
constexpr double kInertia = 1.3, kFriction = 2;
std::string pushed_rod(const std::string& parameter, const std::string& effort, double speed, double step) {
  return fmt::format(R"(<robot name="rod"> <parameter name="friction" value="2"/> <parameter name="push" value="3"/>
    <parameter name="speed" value="{}"/> {} <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/> <axis xyz="0 0 1"/>
      <dynamics friction="${{friction}}"/> <friction law="coulomb"/> </joint>
    <link name="rod"> <inertial> <origin xyz="0.8 0 0"/> <mass value="2"/>
      <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <simulation> <initial joint="hinge" velocity="${{speed}}"/> <effort joint="hinge" history="{}"/>
      <integrator scheme="em" step="{}" tolerance="1e-10"/> </simulation> </robot>)",
                     speed, parameter, effort, step);
}

// ---------------------------------------------------------------- the scenes in which it was found

// The exact derivatives are those of DOP853 with events, rtol 1e-12, by differences of fourth order over 1e-4
// (test/python/sensitivity_events_test.py). A run that turns back stands for up to a step at each reversal, of which
// there is one here: what it is off by changes its derivative by as much.
TEST(SensitivityEvents, FrictionOfASwingingArm) {
  for (const double step : {1e-3, 1e-4}) {
    const Derivative found = derivative_by("fc", rubbing_arm(step), 1.6);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("turns back"), 1);
    // It has a speed of 7 rad/s, and its derivative changes by 3.2 in a second.
    EXPECT_NEAR(found.position, -0.277938, 2 * 3.2 * step) << step;
  }
}

// A hit takes ten steps whatever their length: runs have the restitution to within 5 % of the law's, and the derivative
// of what they go on with to as much. It is small since two terms are opposite: they are 1.5.
TEST(SensitivityEvents, BounceOfASwingingArm) {
  const std::array<std::array<double, 2>, 2> exact = {{{1e-3, -0.5852398}, {1e-4, -0.5406955}}};
  for (const auto& [step, expected] : exact) {
    const Derivative found = derivative_by("angle", bouncing_arm(step), 0.56);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("touches its stop"), 1);
    EXPECT_EQ(found.count("leaves its stop"), 1);
    EXPECT_FALSE(found.is_doubtful());
    EXPECT_NEAR(found.position, expected, 0.05 * 1.5) << step;
  }
}

// ---------------------------------------------------------------- closed forms

// v^2 / 2a from there it rests.
TEST(SensitivityEvents, FrictionThatBringsToRest) {
  const double braking = kFriction / kInertia, speed = 0.72;
  for (const double step : {1e-2, 2.5e-3}) {
    const std::string text = pushed_rod("", "0", speed, step);
    const double tolerance = 2 * braking * step * step;  // it goes so far in a step
    const Derivative by_speed = derivative_by("speed", text, 0.6), by_friction = derivative_by("friction", text, 0.6);
    EXPECT_EQ(by_speed.lost + by_friction.lost, "");
    EXPECT_EQ(by_speed.count("sticks"), 1);
    EXPECT_NEAR(by_speed.position, speed / braking, tolerance) << step;
    EXPECT_NEAR(by_speed.velocity, 0, 1e-6) << step;
    EXPECT_NEAR(by_friction.position, -0.5 * speed * speed / braking / kFriction, tolerance) << step;
  }
}

// Pushed back by 3 N m all the time: it turns without rest.
TEST(SensitivityEvents, ReversalWithoutRest) {
  const double braking = 5 / kInertia, back = 1 / kInertia, speed = 0.72, until = 0.5, turn = speed / braking;
  for (const double step : {1e-2, 2.5e-3}) {
    const std::string text = pushed_rod("", "-push", speed, step);
    std::string pushed = text;
    pushed.replace(pushed.find("\"-push\""), 7, "\"-${push}\"");
    const Derivative by_speed = derivative_by("speed", pushed, until), by_push = derivative_by("push", pushed, until),
                     by_friction = derivative_by("friction", pushed, until);
    EXPECT_EQ(by_speed.lost + by_push.lost + by_friction.lost, "");
    EXPECT_EQ(by_speed.count("turns back"), 1);
    const double rest = until - turn;
    // Its own course is off by a step at the reversal, in which derivatives by efforts grow: 1/I of it for a second.
    const double tolerance = 3 * step * rest / kInertia;
    EXPECT_NEAR(by_speed.position, turn + back * rest / braking, 1e-3) << step;
    EXPECT_NEAR(by_speed.velocity, back / braking, 1e-3) << step;
    const double by_braking = -0.5 * turn * turn - back * rest * turn / braking;  // d/d(braking), back kept
    EXPECT_NEAR(by_push.position, (by_braking - 0.5 * rest * rest) / kInertia, tolerance) << step;
    EXPECT_NEAR(by_friction.position, (by_braking + 0.5 * rest * rest) / kInertia, tolerance) << step;
  }
}

// A push that grows by 3 N m in a second breaks it loose when it is as strong as friction.
TEST(SensitivityEvents, FrictionThatIsOvercome) {
  const double growth = 3, loose = kFriction / growth, until = 1.5;
  for (const double step : {1e-2, 2.5e-3}) {
    const Derivative found = derivative_by("friction", pushed_rod("", "3*t", 0, step), until);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("slips"), 1);
    const double rest = until - loose;
    EXPECT_NEAR(found.position, -0.5 * rest * rest / kInertia, step * rest / kInertia) << step;
    EXPECT_NEAR(found.velocity, -rest / kInertia, step / kInertia) << step;
  }
}

/// A hit of the documented law while it is shallow: of an oscillator of frequency 1, let go at x = 0, v = 1.
struct Hit {
  double duration, depth, restitution;  // depth, in which it is left, over the speed
};
Hit hit(double ratio) {
  const double damped = std::sqrt(1 - ratio * ratio);
  const auto x = [&](double t) { return std::exp(-ratio * t) * std::sin(damped * t) / damped; };
  const auto v = [&](double t) { return std::exp(-ratio * t) * std::cos(damped * t) - ratio * x(t); };
  double low = 1, high = kPi / damped;  // it pushes, pulls
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (x(t) + 2 * ratio * v(t) > 0 ? low : high) = t;
  }
  return {low, x(low), -v(low)};
}

// Without gravity. The run's own hit is off by some hundredths, but what comes behind it is linear in the speed.
TEST(SensitivityEvents, StopTouchedAndLeft) {
  const double upper = 0.1234, until = 0.4;
  for (const double step : {4e-3, 1e-3, 1e-4}) {
    const std::string text =
        rod_with_stop(upper, "0 0 0", fmt::format("scheme=\"em\" step=\"{}\" tolerance=\"1e-10\"", step));
    const Derivative found = derivative_by("speed", text, until);
    const double frequency = kPi / (10 * step);
    const Hit law = hit(0.497239);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("touches its stop"), 1);
    EXPECT_EQ(found.count("leaves its stop"), 1);
    EXPECT_FALSE(found.is_doubtful());
    const double expected = law.depth / frequency - law.restitution * (until - law.duration / frequency);
    // Of the run: 0.316 in the place of 0.3, at most.
    EXPECT_NEAR(found.velocity, -law.restitution, 0.016) << step;
    EXPECT_NEAR(found.position, expected, 0.016 * until) << step;
  }
}

// The start is a direction as well.
TEST(SensitivityEvents, StopByTheStart) {
  const Scene scene{rod_with_stop(0.1234, "0 0 0", "scheme=\"em\" step=\"0.001\" tolerance=\"1e-10\"")};
  SensitivityRequest request;
  request.initial_state = true;
  const Derivative found = derivative_of(scene, request, 0.4);
  // A start nearer to the stop is a hit that comes earlier, and a way back as much longer.
  EXPECT_NEAR(found.position, -hit(0.497239).restitution, 0.016);
  EXPECT_NEAR(found.velocity, 0, 0.016);
}

TEST(SensitivityEvents, StopsOfOtherSchemes) {
  for (const char* scheme : {"newmark", "m1", "edmc2"}) {
    const std::string text =
        rod_with_stop(0.1234, "0 0 0", fmt::format("scheme=\"{}\" step=\"0.001\" tolerance=\"1e-10\"", scheme));
    const Derivative found = derivative_by("speed", text, 0.4);
    EXPECT_EQ(found.lost, "") << scheme;
    const bool is_told = std::string(scheme) == "newmark";
    EXPECT_EQ(found.is_doubtful(), is_told) << scheme;
    if (!is_told) {
      EXPECT_NEAR(found.velocity, -hit(0.497239).restitution, 0.016) << scheme;
    }
  }
}

// ---------------------------------------------------------------- events at ends of steps

// A step that ends at the stop, to round-off, is on both sides of it: the exact motion has one derivative all the same.
TEST(SensitivityEvents, StopAtTheEndOfAStep) {
  const int steps = 10;
  const double half = 0.5 * 0.7 * 0.01;  // a free rod turns by 2 atan(half) in a step
  const std::string text =
      rod_with_stop(2 * steps * std::atan(half), "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\"");
  const Derivative before = derivative_by("speed", text, 0.09), behind = derivative_by("speed", text, 0.4);
  EXPECT_NEAR(before.position, 0.01 * (steps - 1) / (1 + half * half), 1e-6 * 0.09);
  EXPECT_EQ(behind.lost, "");
  EXPECT_NEAR(behind.velocity, -hit(0.497239).restitution, 0.016);
}

// A rod whose speed is zero at the end of a step, to round-off.
TEST(SensitivityEvents, FrictionThatSticksAtTheEndOfAStep) {
  const double braking = kFriction / kInertia, speed = 0.45 * braking;
  const Derivative found = derivative_by("speed", pushed_rod("", "0", speed, 0.01), 0.6);
  EXPECT_EQ(found.lost, "");
  EXPECT_NEAR(found.position, speed / braking, 2 * braking * 1e-4);
  EXPECT_NEAR(found.velocity, 0, 1e-6);
}

// ---------------------------------------------------------------- what cannot be right

/// A rod that is pushed back from its stop, and would turn at `turn` [s] without it.
std::string braked_before_stop(double turn, double upper) {
  const double push = 2, braking = push / kInertia;
  std::string text = rod_with_stop(upper, "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\"");
  const std::string start = "value=\"0.7\"", gravity = "<gravity";
  text.replace(text.find(start), start.size(), fmt::format("value=\"{:.17g}\"", braking * turn));
  text.insert(text.find(gravity), fmt::format("<effort joint=\"hinge\" history=\"{}\"/> ", -push));
  return text;
}

// It gets to the stop with half of the speed that its push takes in half a step: how fast it really is, steps cannot
// tell.
TEST(SensitivityEvents, GrazedStopIsDoubtful) {
  const double turn = 0.47, braking = 2 / kInertia, height = 0.5 * braking * turn * turn;
  const double speed = 0.5 * 0.5 * braking * 0.01;
  const Derivative found =
      derivative_by("speed", braked_before_stop(turn, height - 0.5 * speed * speed / braking), 0.5);
  ASSERT_GE(found.events.size(), 1U);
  EXPECT_EQ(found.events[0].joint, "hinge");
  EXPECT_EQ(found.events[0].what, "touches its stop");
  EXPECT_NEAR(found.events[0].time, turn - speed / braking, 0.01);
  EXPECT_NE(found.events[0].doubt.find("grazed"), std::string::npos) << found.events[0].doubt;
}

// Which one is first depends on the parameter.
TEST(SensitivityEvents, EventsAtTheSameInstantAreDoubtful) {
  std::string text = rod_with_stop(0.1234, "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\"");
  const auto begin = text.find("<joint"), end = text.find("<simulation>");
  std::string other = text.substr(begin, end - begin);
  for (const auto& [name, renamed] : {std::pair("\"hinge\"", "\"other\""), std::pair("\"rod\"", "\"second\"")})
    for (auto at = other.find(name); at != std::string::npos; at = other.find(name))
      other.replace(at, std::string(name).size(), renamed);
  text.insert(end, other);
  text.insert(text.find("<gravity"), "<initial joint=\"other\" velocity=\"${speed}\"/> ");
  const Derivative found = derivative_by("speed", text, 0.3);
  EXPECT_EQ(found.count("touches its stop"), 2);
  EXPECT_TRUE(found.is_doubtful());
}

}  // namespace
}  // namespace flexarm::test
