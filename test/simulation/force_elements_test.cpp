// Tests a kind of force element that only the tests define (support/strut.h): from its line in the scene to its result
// columns.

#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/linear_model.h"
#include "flexarm/simulation/sensitivities.h"
#include "math/pi.h"
#include "simulation/same_bits.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"
#include "support/strut.h"

namespace flexarm::test {
namespace {

std::string cart_with(const std::string& strut, double step = 0.01) {
  return robot("<parameter name='cubic' value='5'/>" + body("cart", 2) + rail("rail", "cart", "1 0 0") + "\n" + strut,
               gravity({0, 0, 0}) + integrator("em", step) + "<initial joint='rail' velocity='3'/>");
}

scene::ReadOptions with_struts(const scene::ParameterValues& parameters = {}) {
  scene::ReadOptions options;
  options.more_force_elements = &strut_kind();
  options.parameters = parameters;
  return options;
}

Simulation pushed_cart(const std::string& numbers, const SimulationOptions& options = {}) {
  return Simulation(
      scene_of(cart_with("<strut name='s' from='world' to='cart' to_at='1 0 0' " + numbers + "/>"), with_struts()),
      options);
}

constexpr double kCartMass = 2, kCubicDamping = 5, kSpeedAtStart = 3;

/// The exact speed of a cart with m v' = -c v^3.
double exact_speed(double time) {
  return kSpeedAtStart / std::sqrt(1 + 2 * kCubicDamping * kSpeedAtStart * kSpeedAtStart / kCartMass * time);
}

double error_of_place(double step) {
  Simulation simulation = pushed_cart("cubic='5'", options("em", step));
  run_until(simulation, 0.4);
  // The error is measured in the position, since velocities are published with an error of third order. Exact: x(t) = m
  // / c (1 / v(t) - 1 / v(0)).
  return std::abs(simulation.position(0) - kCartMass / kCubicDamping * (1 / exact_speed(0.4) - 1 / kSpeedAtStart));
}

TEST(ForceElements, OfAnyKindTakePartInSteps) {
  const double coarse = error_of_place(4e-3), fine = error_of_place(2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << coarse << " " << fine;
}

TEST(ForceElements, CountInTheAccountOfEnergies) {
  Simulation simulation = pushed_cart("linear='0.5' cubic='0.2' push='7'");
  const double begin = energy_account(simulation);
  run_until(simulation, 2);
  const Energies e = simulation.energies();
  EXPECT_GT(e.dissipated, 1);
  EXPECT_NEAR(e.work, 7 * simulation.position(0), 1e-11 * e.work);
  EXPECT_NEAR(energy_account(simulation), begin, 1e-12 * e.dissipated);
}

TEST(ForceElements, PutOutWhatTheySay) {
  Simulation simulation = pushed_cart("linear='0.5' push='7'");
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"strut/*"});
  ASSERT_EQ(columns.columns().size(), 4u);  // time is always a column
  EXPECT_EQ(columns.columns()[1].name, "strut/s/length");
  EXPECT_EQ(columns.columns()[2].unit, "N");
  run_until(simulation, 1);
  const std::vector<double>& row = columns.row(simulation, {});
  EXPECT_NEAR(row[1], 1 + simulation.position(0), 1e-14);
  EXPECT_NEAR(row[2], 0.5 * simulation.velocity(0) - 7, 1e-12);
  EXPECT_NEAR(row[3], simulation.energies().dissipated, 1e-12 * row[3]);
}

TEST(ForceElements, RememberInCheckpoints) {
  // Steps depend on the state alone then.
  Simulation one = pushed_cart("cubic='0.2'", full_newton()), other = pushed_cart("cubic='0.2'", full_newton());
  run_until(one, 0.5);
  read_checkpoint_text(other, checkpoint_text(one), "text");
  run_until(one, 1), run_until(other, 1);
  EXPECT_GT(state_of(one).force_memory.at(0), 0);
  EXPECT_EQ(numbers(state_of(one)), numbers(state_of(other)));
  Simulation another = pushed_cart("cubic='0.3'");
  EXPECT_THROW(read_checkpoint_text(another, checkpoint_text(one), "text"), std::runtime_error);
}

// For small deviations of the speed v: m dv' = -(c1 + 3 c3 v^2) dv.
TEST(ForceElements, AreInLinearModels) {
  const Simulation simulation = pushed_cart("linear='0.5' cubic='0.2'");
  LinearRequest request;
  EXPECT_NEAR(linearise(simulation, request).a(1, 1), -0.5 / kCartMass, 1e-12);
  request.about = LinearisedAbout::Instant;
  EXPECT_NEAR(linearise(simulation, request).a(1, 1), -(0.5 + 3 * 0.2 * kSpeedAtStart * kSpeedAtStart) / kCartMass,
              1e-8);
}

// A spring of 100 N/m, unstressed at its initial length of 1 m, holds a push of 7 N.
TEST(ForceElements, AreInEquilibria) {
  Simulation simulation(scene_of(cart_with("<strut from='world' to='cart' to_at='1 0 0' push='7' cubic='1'/>"
                                           "<spring from='world' to='cart' to_at='1 0 0' stiffness='100'/>"),
                                 with_struts()));
  ASSERT_TRUE(simulation.solve_static(1).converged);
  EXPECT_NEAR(simulation.position(0), 0.07, 1e-12);
  EXPECT_NEAR(simulation.natural_modes(1).front().frequency, std::sqrt(100 / kCartMass) / (2 * kPi), 1e-9);
}

// The exact derivative dv(t)/dc of v = v0 (1 + 2 c v0^2 t / m)^(-1/2).
TEST(ForceElements, HaveSensitivities) {
  const std::string cart = cart_with("<strut from='world' to='cart' to_at='1 0 0' cubic='${cubic}'/>", 1e-3);
  Simulation simulation(scene_of(cart, with_struts()));
  SensitivityRequest request;
  request.parameters = {"cubic"};
  request.read = [&](const std::string& name, double value) {
    return scene::read_scene_text(cart, "cart.urdf", with_struts({{name, value}}));
  };
  Sensitivities sensitivities(simulation, request);
  while (simulation.time() < 0.4 - 1e-9) ASSERT_TRUE(sensitivities.step().converged);
  const double exact = -std::pow(exact_speed(0.4), 3) * 0.4 / kCartMass;
  EXPECT_NEAR(sensitivities.velocities()(0, 0), exact, 1e-3 * std::abs(exact));  // second order in the step
}

TEST(ForceElements, HaveErrorsWithTheirLines) {
  const scene::ReadResult result =
      scene::read_scene_text(cart_with("<strut from='world' to='nobody' cubic='-1'/>"), "cart.urdf", with_struts());
  const std::string text = to_text(result.diagnostics), place = "cart.urdf:2: <strut> of robot 'test': ";
  expect_contains(text, place + "cubic must be >= 0, got '-1'");
  expect_contains(text, place + "to must be a link of the scene (world, cart), got 'nobody'");
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(text.find("has no effect"), std::string::npos) << text;
}

}  // namespace
}  // namespace flexarm::test
