// Tests derivatives of runs with stops and dry friction, against those of the exact motion.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/sensitivity_scenes.h"

namespace flexarm::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Derivative {
  double position = 0, velocity = 0;  // of the first joint, with respect to the first direction
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

/// Scenes from a reported error: an arm of 1 kg, whose centre of mass is 0.5 m from its hinge, under gravity.
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

/// Data of a rod about the z axis, without gravity across it: inertia 1.3 kg m^2, friction 2 N m.
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

// ---------------------------------------------------------------- arms with friction and stops

// The exact derivatives are differences of fourth order over 1e-4 of runs by DOP853 with events, rtol 1e-12
// (test/python/sensitivity_events_test.py). At each reversal, the run stands still for up to one step; there is one
// reversal here. This delay changes the derivative by as much as it changes in that time.
TEST(SensitivityEvents, FrictionOfASwingingArm) {
  for (const double step : {1e-3, 1e-4}) {
    const Derivative found = derivative_by("fc", rubbing_arm(step), 1.6);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("turns back"), 1);
    // The arm turns at 7 rad/s, and its derivative changes by 3.2 per second.
    EXPECT_NEAR(found.position, -0.277938, 2 * 3.2 * step) << step;
  }
}

// A hit takes ten steps, whatever their length. So the restitution of the run, and the derivative after the hit, have
// errors of up to 5 %. The derivative is the small sum of two opposite terms of size 1.5, to which the 5 % refer.
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

// The rod comes to rest after the distance v^2 / 2a.
TEST(SensitivityEvents, FrictionThatBringsToRest) {
  const double braking = kFriction / kInertia, speed = 0.72;
  for (const double step : {1e-2, 2.5e-3}) {
    const std::string text = pushed_rod("", "0", speed, step);
    const double tolerance = 2 * braking * step * step;  // distance travelled in a step
    const Derivative by_speed = derivative_by("speed", text, 0.6), by_friction = derivative_by("friction", text, 0.6);
    EXPECT_EQ(by_speed.lost + by_friction.lost, "");
    EXPECT_EQ(by_speed.count("sticks"), 1);
    EXPECT_NEAR(by_speed.position, speed / braking, tolerance) << step;
    EXPECT_NEAR(by_speed.velocity, 0, 1e-6) << step;
    EXPECT_NEAR(by_friction.position, -0.5 * speed * speed / braking / kFriction, tolerance) << step;
  }
}

// A cart starts at once with 0.6 m/s. A block that slides on it with dry friction F stays behind by v^2 m / 2F.
TEST(SensitivityEvents, FrictionBehindAKinkOfAMotion) {
  const Scene scene{R"(<robot name="cart"> <parameter name="friction" value="3"/> <link name="world"/>
    <joint name="bed" type="prismatic"> <parent link="cart"/> <child link="block"/> <axis xyz="1 0 0"/>
      <limit lower="-9" upper="9" effort="0" velocity="0"/> <dynamics friction="${friction}"/> <friction law="coulomb"/>
    </joint>
    <joint name="rail" type="prismatic"> <parent link="world"/> <child link="cart"/> <axis xyz="1 0 0"/>
      <limit lower="-9" upper="9" effort="0" velocity="0"/> </joint>
    <link name="cart"> <inertial> <mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <link name="block"> <inertial> <mass value="2"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <simulation> <motion joint="rail" position="0:0 0.1:0 1.1:0.6"/> <integrator step="1e-3"/> </simulation> </robot>)"};
  Simulation simulation = scene.simulation();
  Sensitivities sensitivities(simulation, scene.request({"friction"}));
  for (int n = 0; n < 800; ++n) ASSERT_TRUE(sensitivities.step().converged);
  EXPECT_EQ(sensitivities.lost(), "");
  const std::vector<std::string>& names = simulation.coordinate_names();
  const auto bed = std::find(names.begin(), names.end(), "bed") - names.begin();
  EXPECT_NEAR(simulation.position(static_cast<std::size_t>(bed)), -0.12, 2e-6);
  // d/dF (-v^2 m / 2F) = 0.04; the coordinate comes to rest within a step, in which it moves by F h^2 / m.
  EXPECT_NEAR(sensitivities.positions()(bed, 0), 0.04, 2 * 1.5 * 1e-6 + 1e-5);
}

// A push of 3 N m acts back all the time, so that the rod reverses without sticking.
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
    // The run itself is off by one step at the reversal. In this time, derivatives with respect to efforts grow by 1/I
    // per second.
    const double tolerance = 3 * step * rest / kInertia;
    EXPECT_NEAR(by_speed.position, turn + back * rest / braking, 1e-3) << step;
    EXPECT_NEAR(by_speed.velocity, back / braking, 1e-3) << step;
    const double by_braking = -0.5 * turn * turn - back * rest * turn / braking;  // d/d(braking) at constant `back`
    EXPECT_NEAR(by_push.position, (by_braking - 0.5 * rest * rest) / kInertia, tolerance) << step;
    EXPECT_NEAR(by_friction.position, (by_braking + 0.5 * rest * rest) / kInertia, tolerance) << step;
  }
}

// A push that grows by 3 N m per second overcomes friction when it equals it.
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

/// A shallow hit by the documented law: the damped oscillator of frequency 1, started at x = 0 with v = 1.
struct Hit {
  double duration, depth, restitution;  // depth: at which the stop is left, over the speed
};
Hit hit(double ratio) {
  const double damped = std::sqrt(1 - ratio * ratio);
  const auto x = [&](double t) { return std::exp(-ratio * t) * std::sin(damped * t) / damped; };
  const auto v = [&](double t) { return std::exp(-ratio * t) * std::cos(damped * t) - ratio * x(t); };
  double low = 1, high = kPi / damped;  // times at which the force pushes and pulls
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (x(t) + 2 * ratio * v(t) > 0 ? low : high) = t;
  }
  return {low, x(low), -v(low)};
}

/// The scene with hits that last ten steps.
std::string with_hits_of_ten_steps(std::string text, double step) {
  const std::string tag = "<simulation";
  text.insert(text.find(tag) + tag.size(), fmt::format(" contact_time=\"{}\"", 10 * step));
  return text;
}

// Without gravity. The run's hit has an error of a few hundredths, but the motion after it is linear in the speed.
TEST(SensitivityEvents, StopTouchedAndLeft) {
  const double upper = 0.1234, until = 0.4;
  for (const double step : {4e-3, 1e-3, 1e-4}) {
    const std::string text = with_hits_of_ten_steps(
        rod_with_stop(upper, "0 0 0", fmt::format("scheme=\"em\" step=\"{}\" tolerance=\"1e-10\"", step)), step);
    const Derivative found = derivative_by("speed", text, until);
    const double frequency = kPi / (10 * step);
    const Hit law = hit(0.497239);
    EXPECT_EQ(found.lost, "");
    EXPECT_EQ(found.count("touches its stop"), 1);
    EXPECT_EQ(found.count("leaves its stop"), 1);
    EXPECT_FALSE(found.is_doubtful());
    const double expected = law.depth / frequency - law.restitution * (until - law.duration / frequency);
    // Tolerance: the restitution of the run is at most 0.316 instead of 0.3.
    EXPECT_NEAR(found.velocity, -law.restitution, 0.016) << step;
    EXPECT_NEAR(found.position, expected, 0.016 * until) << step;
  }
}

// Derivatives with respect to the start.
TEST(SensitivityEvents, StopByTheStart) {
  const Scene scene{rod_with_stop(0.1234, "0 0 0", "scheme=\"em\" step=\"0.001\" tolerance=\"1e-10\"")};
  SensitivityRequest request;
  request.initial_state = true;
  const Derivative found = derivative_of(scene, request, 0.4);
  // From a start nearer to the stop, the hit comes earlier, and the rod travels back for as much longer.
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

// A step ends at the stop up to round-off, so the run may be on either side of it. The exact motion has one derivative.
TEST(SensitivityEvents, StopAtTheEndOfAStep) {
  const int steps = 10;
  const double half = 0.5 * 0.7 * 0.01;  // a free rod turns by 2 atan(half) in a step
  const std::string text = with_hits_of_ten_steps(
      rod_with_stop(2 * steps * std::atan(half), "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\""), 0.01);
  const Derivative before = derivative_by("speed", text, 0.09), behind = derivative_by("speed", text, 0.4);
  EXPECT_NEAR(before.position, 0.01 * (steps - 1) / (1 + half * half), 1e-6 * 0.09);
  EXPECT_EQ(behind.lost, "");
  EXPECT_NEAR(behind.velocity, -hit(0.497239).restitution, 0.016);
}

// The rod's speed is zero at the end of a step, up to round-off.
TEST(SensitivityEvents, FrictionThatSticksAtTheEndOfAStep) {
  const double braking = kFriction / kInertia, speed = 0.45 * braking;
  const Derivative found = derivative_by("speed", pushed_rod("", "0", speed, 0.01), 0.6);
  EXPECT_EQ(found.lost, "");
  EXPECT_NEAR(found.position, speed / braking, 2 * braking * 1e-4);
  EXPECT_NEAR(found.velocity, 0, 1e-6);
}

// ---------------------------------------------------------------- doubtful events

/// A rod that is pushed away from its stop. Without the stop it would reverse at the time `turn` [s].
std::string braked_before_stop(double turn, double upper) {
  const double push = 2, braking = push / kInertia;
  std::string text = rod_with_stop(upper, "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\"");
  const std::string start = "value=\"0.7\"", gravity = "<gravity";
  text.replace(text.find(start), start.size(), fmt::format("value=\"{:.17g}\"", braking * turn));
  text.insert(text.find(gravity), fmt::format("<effort joint=\"hinge\" history=\"{}\"/> ", -push));
  return text;
}

// The rod reaches the stop with half of the speed that the push takes away in half a step. The steps cannot resolve
// this speed.
TEST(SensitivityEvents, GrazedStopIsDoubtful) {
  const double turn = 0.47, braking = 2 / kInertia, height = 0.5 * braking * turn * turn;
  const double speed = 0.5 * 0.5 * braking * 0.01;
  const Derivative found =
      derivative_by("speed", braked_before_stop(turn, height - 0.5 * speed * speed / braking), 0.5);
  ASSERT_GE(found.events.size(), 1U);
  EXPECT_EQ(found.events[0].joint, "hinge");
  EXPECT_EQ(found.events[0].what, "touches its stop");
  EXPECT_NEAR(found.events[0].time, turn - speed / braking, 0.01);
  EXPECT_NE(found.events[0].doubt.find("grazing"), std::string::npos) << found.events[0].doubt;
}

// Two stops are touched at the same instant; the order of the events depends on the parameter.
TEST(SensitivityEvents, EventsAtTheSameInstantAreDoubtful) {
  std::string text =
      with_hits_of_ten_steps(rod_with_stop(0.1234, "0 0 0", "scheme=\"em\" step=\"0.01\" tolerance=\"1e-10\""), 0.01);
  const auto begin = text.find("<joint"), end = text.find("<simulation");
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
