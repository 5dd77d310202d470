// Tests drag on links in simulations, against closed forms.
#include <cmath>

#include "building/expect_model_error.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kAirDensity = 1.2;

/// A plate of 2 kg on an upright rail.
const std::string kPlate = rail("rail", "plate", "0 0 1") + body("plate", 2, Vector3::Constant(0.1), Vector3::Zero(),
                                                                 "<drag coefficient='1.1' area='0.05 0.05 0.4'/>");

/// Error of the plate's place after 5 s of falling: z = -(w^2 / g) ln cosh(g t / w), w^2 = 2 m g / (rho C A).
double error_of_fall(const std::string& scheme, double step) {
  constexpr double g = 10, t = 5;
  Simulation s = simulation_of_parts(kPlate, fmt::format(R"(<gravity xyz="0 0 {}"/>)", -g), step, scheme);
  run_until(s, t);
  const double terminal = std::sqrt(2 * 2 * g / (kAirDensity * 1.1 * 0.4));
  return std::abs(s.position(0) + terminal * terminal / g * std::log(std::cosh(g * t / terminal)));
}

TEST(AirDragRuns, AFallingPlateReachesItsSpeed) {
  for (const auto& [scheme, order] : {std::pair("em", 2.0), std::pair("newmark", 2.0), std::pair("em4", 4.0)}) {
    SCOPED_TRACE(scheme);
    const double coarse = error_of_fall(scheme, 0.2), fine = error_of_fall(scheme, 0.1);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.15);
  }
  EXPECT_LE(error_of_fall("em4", 0.02), 1e-6);
}

TEST(AirDragRuns, HaveColumns) {
  Simulation s = simulation_of_parts(kPlate, R"(<gravity xyz="0 0 -10"/>)", 0.01, "em");
  run_until(s, 1);
  const double speed = s.velocity(0);
  EXPECT_EQ(column(s, "drag/plate/fx"), 0);
  EXPECT_EQ(column(s, "drag/plate/fy"), 0);
  EXPECT_NEAR(column(s, "drag/plate/fz"), 0.5 * kAirDensity * 1.1 * 0.4 * speed * speed, 1e-12 * speed * speed);
}

const char* const kFlat = R"(<rectangle width="0.08" height="0.001"/>)";

/// A free strip of steel, without gravity; `order` of its three elements, start as `initial` says.
scene::SceneDescription flying_strip(int order, const std::string& section,
                                     const std::string& initial = R"(linear="0 0 10")", double step = 1e-3,
                                     double young = 2e11) {
  return scene_of_parts(
      fmt::format(R"(<joint name="free" type="floating"> <parent link="world"/> <child link="strip"/> </joint>
        <link name="strip"> <beam elements="3" order="{}"> <centerline> <line to="0.5 0 0"/> </centerline>
          {} <material young="{}" poisson="0.3" density="7870"/> </beam>
          <drag coefficient="2"/> </link>)",
                  order, section, young),
      fmt::format(R"(<gravity xyz="0 0 0"/> <initial link="strip" {}/>)", initial), step);
}

Simulation free_strip(int order, const std::string& initial, double step = 1e-3, double young = 2e11) {
  return Simulation(flying_strip(order, kFlat, initial, step, young));
}

// Broadside, each length feels its own drag, so that the strip is not bent: v = v0 / (1 + k v0 t), k = rho C b / 2 m.
TEST(AirDragRuns, SlowAStripBroadside) {
  for (const int order : {1, 2, 3, 4}) {
    SCOPED_TRACE(order);
    Simulation s = free_strip(order, R"(linear="0 0 10")", 0.01);
    const double start = energy_account(s);
    run_until(s, 1);
    const double k = 0.5 * kAirDensity * 2 * 0.08 / (7870 * 0.08 * 0.001);
    // The law is of second order in the step: h^2/12 times the third derivative of the place, 6 k^2 v0^3, over 1 s.
    const double bound = 0.01 * 0.01 / 12 * 6 * k * k * 1000;
    const double mass = 7870 * 0.08 * 0.001 * 0.5;
    EXPECT_NEAR(std::sqrt(2 * s.energies().kinetic / mass), 10 / (1 + k * 10 * 1), bound);
    EXPECT_LE(s.energies().strain, 1e-15 * start);  // round-off of positions
    EXPECT_NEAR(energy_account(s), start, 1e-12 * start);
  }
}

// Along the strip air meets nothing.
TEST(AirDragRuns, LeaveMotionAlongABeamAlone) {
  Simulation s = free_strip(2, R"(linear="10 0 0")");
  run_until(s, 0.1);
  EXPECT_EQ(s.energies().dissipated, 0);
}

// Edgewise the width is that of the edge: 80 times less drag than broadside.
TEST(AirDragRuns, DependOnTheSide) {
  Simulation flat = free_strip(2, R"(linear="0 0 10")"), edge = free_strip(2, R"(linear="0 10 0")");
  for (Simulation* s : {&flat, &edge}) ASSERT_TRUE(s->step().converged);
  // In one step the flat strip loses 1.5e-3 of its speed, half of that in the mean, and dissipation goes with its cube.
  EXPECT_NEAR(flat.energies().dissipated / edge.energies().dissipated, 80, 80 * 2.5e-3);
}

// A strip whose width falls from 0.08 to 0.04 m feels as much as one of the mean width, which weighs as much.
TEST(AirDragRuns, FollowATaper) {
  const char* const tapered = R"(<stations> <station at="0"> <rectangle width="0.08" height="0.001"/> </station>
    <station at="0.5"> <rectangle width="0.04" height="0.001"/> </station> </stations>)";
  const char* const mean = R"(<rectangle width="0.06" height="0.001"/>)";
  const auto loss = [](const char* section, int order) {
    Simulation s(flying_strip(order, section, R"(linear="0 0 10")"));
    EXPECT_TRUE(s.step().converged);
    return s.energies().dissipated;
  };
  // Its ends differ by a few percent of the 1.5e-3 by which a step changes the speed.
  for (const int order : {1, 2, 3, 4}) EXPECT_NEAR(loss(tapered, order) / loss(mean, order), 1, 1e-4) << order;
}

/// Angle after 1 s of a stiff strip on a hinge at its end, from 10 rad/s.
double turned_angle(int order, double step) {
  Simulation s = simulation_of_parts(
      fmt::format(R"(<joint name="hinge" type="continuous"> <parent link="world"/> <child link="strip"/>
          <axis xyz="0 1 0"/> </joint>
        <link name="strip"> <beam elements="2" order="{}"> <centerline> <line to="0.5 0 0"/> </centerline>
          <section ea="1e9" ga2="1e9" ga3="1e9" gj="1e7" ei2="1e7" ei3="1e7" mass="0.6" j1="1e-6" j2="1e-9" j3="1e-6"/>
          </beam> <drag coefficient="2" width="0.001 0.08"/> </link>)",
                  order),
      R"(<gravity xyz="0 0 0"/> <initial joint="hinge" velocity="10"/>)", step, "em");
  run_until(s, 1);
  return s.position(0);
}

// I dw/dt = -c L^4/4 w^2, c = rho C b / 2, I = m L^3/3, so that the angle is ln(1 + k t) w0 / k, k = 3 c L w0 / 4 m.
// The drag's moment is a polynomial of degree 3 along the strip, of which nodes of order 2 and more sum exactly. The
// strip stretches by m w^2 L^2 / EA, 1e-8 of its length.
TEST(AirDragRuns, SlowAStripThatTurns) {
  const double rate = 3 * (0.5 * kAirDensity * 2 * 0.08) * 0.5 * 10 / (4 * 0.6);  // k [1/s]
  const double exact = 10 / rate * std::log(1 + rate);
  for (const int order : {2, 3}) {
    SCOPED_TRACE(order);
    const double coarse = turned_angle(order, 0.005), fine = turned_angle(order, 0.0025);
    EXPECT_NEAR(std::log2(std::abs(coarse - exact) / std::abs(fine - exact)), 2, 0.15);
    EXPECT_LE(std::abs((4 * fine - coarse) / 3 - exact), 1e-6);
  }
}

// A soft strip that bends, tumbles and turns: what it loses is what drag dissipates.
TEST(AirDragRuns, CloseTheAccount) {
  Simulation s = free_strip(2, R"(linear="1 0 10" angular="3 20 -5")", 1e-3, 2e9);
  const double start = energy_account(s);
  run_until(s, 1);
  EXPECT_GT(s.energies().dissipated, 0.1 * start);
  EXPECT_NEAR(energy_account(s), start, 1e-11 * start);
}

TEST(AirDragRuns, AreRefusedWhereNothingCanMoveOrBend) {
  expect_error(scene_of_parts(R"(<joint name="clamp" type="fixed"> <parent link="world"/> <child link="plate"/> </joint>
      <link name="plate"> <drag coefficient="1" area="0.1"/> </link>
)" + joint("hinge", "continuous", "plate", "arm") +
                              body("arm", 2)),
               "test.urdf:2: <drag>: link 'plate' is part of the world, which cannot move");
  scene::SceneDescription rigid = flying_strip(2, kFlat);
  rigid.links.back().beam->elements = 0;
  expect_error(rigid, "with elements=\"0\" it is rigid, and <drag> acts upon elements");
}

}  // namespace
}  // namespace flexarm::test
