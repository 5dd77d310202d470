// Tests hydraulic cylinders in simulations: closed forms, independent solutions (elements/scripts/reference_oil.py, by
// solve_ivp of scipy with tolerances of 1e-13), and the account of energies.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "flexarm/model/model_error.h"
#include "math/pi.h"
#include "support/boom.h"
#include "support/source_path.h"

namespace flexarm::test {
namespace {

/// A ram between the world and a mass on a slider along x, as in reference_oil.py.
struct Ram {
  static constexpr double kBore = 0.08, kRod = 0.04, kLower = 0.2, kUpper = 1, kStart = 0.6, kDead = 1e-4, kMass = 50;
  std::string oil, pump, simulation;  // attributes of <hydraulics>; children of it and of <simulation>
  double speed = 0;
  std::string axis = "1 0 0";

  static double area(int chamber) { return 0.25 * kPi * (kBore * kBore - (chamber == 0 ? 0 : kRod * kRod)); }
  static double volume(int chamber, double length) {
    return kDead + area(chamber) * (chamber == 0 ? length - kLower : kUpper - length);
  }
  scene::SceneDescription scene() const {
    return scene_of(
        robot(rail("slide", "mass", axis) + body("mass", kMass) +
                  fmt::format("<cylinder name='ram' from='world' to='mass'> <limit lower='{}' upper='{}'/> <hydraulics "
                              "bore='{}' rod='{}' dead_volume='{}' {}>{}</hydraulics> </cylinder>",
                              kLower, kUpper, kBore, kRod, kDead, oil, pump),
              "<integrator step='1e-3' tolerance='1e-12'/>" +
                  fmt::format("<initial joint='slide' position='{}' velocity='{}'/>", kStart, speed) +
                  (axis == "1 0 0" ? gravity({0, 0, 0}) : "") + simulation));
  }
  Simulation at(double step, const std::string& scheme = "em") const {
    // Kept factors belong to the run: they change last digits.
    return Simulation(scene(), full_newton(options(scheme, step)));
  }
};

/// Angular frequency of the mass while nothing flows. `bulk`, `pressure`: of the piston's side at the start.
double ram_frequency(double bulk, double pressure) {
  double stiffness = 0;
  for (const int i : {0, 1}) {
    const double here = i == 0 ? pressure : pressure * Ram::area(0) / Ram::area(1);
    const double content = Ram::volume(i, Ram::kStart) / (1 - here / bulk);
    stiffness += bulk * Ram::area(i) * Ram::area(i) / content;
  }
  return std::sqrt(stiffness / Ram::kMass);
}

}  // namespace

TEST(Hydraulics, HaveTheFrequencyOfTheirOil) {
  const double bulk = 1.4e9, pressure = 2e6, omega = ram_frequency(bulk, pressure);
  Ram ram;
  ram.oil = "bulk_modulus='1.4e9' pressure='2e6'";
  const Simulation still = ram.at(1e-3);
  EXPECT_NEAR(2 * kPi * still.natural_modes(1).at(0).frequency, omega, 1e-8 * omega);
  // The textbook's formula has volumes instead of contents, which are larger by pressure / bulk modulus.
  const double first = Ram::area(0) * Ram::area(0) / Ram::volume(0, Ram::kStart);
  const double second = Ram::area(1) * Ram::area(1) / Ram::volume(1, Ram::kStart);
  EXPECT_NEAR(omega, std::sqrt(bulk * (first + second) / Ram::kMass), 2e-3 * omega);

  // Small swings about the start: x = speed / omega sin(omega t), and two parts in 1e5 of nonlinearity at the most.
  ram.speed = 1e-2;
  const double amplitude = ram.speed / omega, end = 0.05;
  std::array<double, 2> errors;
  for (int k = 0; k < 2; ++k) {
    Simulation swings = ram.at(k == 0 ? 1e-4 : 5e-5);
    run_until(swings, end);
    errors[k] = std::abs(position_of(swings, "ram") - Ram::kStart - amplitude * std::sin(omega * end));
  }
  EXPECT_LT(errors[1], 0.02 * amplitude);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
}

// Large swings, voids, voids that are filled, and relief valves, against reference_oil.py.
TEST(Hydraulics, MoveAsTheDifferentialEquations) {
  struct Case {
    const char *name, *oil, *simulation;
    double speed, length, velocity, pressure_1, pressure_2;
  };
  const Case cases[] = {
      {"swings far", "bulk_modulus='2e7' pressure='5e6'", "", 8, 0.678838489651455, 5.19889410386496, 2183631.32441,
       9131183.00599},
      {"with voids", "bulk_modulus='2e7' pressure='2e5' makeup='false'", "", 8, 0.716841515890129, 3.42993814027405, 0,
       5672371.20157},
      {"made up", "bulk_modulus='2e7' pressure='2e5'", "<load link='mass' force='2e4 0 0' history='sin(40*t)'/>", 2,
       0.718068644883833, 3.09433193100325, 1908707.99336, 6664555.39653},
      {"relieved", "bulk_modulus='2e7' pressure='1e6' relief_pressure='3e6'",
       "<load link='mass' force='1.1e4 0 0' history='sin(40*t)'/>", 2, 0.649529501802507, 0.559757299043552,
       39781.162119, 3e6},
      {"pumped", "bulk_modulus='1e9' pressure='2e6' flow='2e-3*sin(20*t)'", "<load link='mass' force='-2000 0 0'/>", 0,
       0.636478185293164, -0.281028214488553, 2078294.65018, 2637479.47423},
  };
  for (const Case& tested : cases)
    for (const char* const scheme : {"em", "newmark"}) {
      Ram ram;
      ram.oil = tested.oil;
      ram.simulation = tested.simulation;
      ram.speed = tested.speed;
      std::array<double, 3> errors;
      for (int k = 0; k < 3; ++k) {
        Simulation simulation = ram.at(2e-4 / (1 << k), scheme);
        run_until(simulation, 0.5);
        errors[k] = std::abs(position_of(simulation, "ram") - tested.length);
        if (k < 2) continue;
        // Errors of pressures and of the velocity go with those of the length, by stiffness and frequency.
        const double bulk = tested.name == std::string("pumped") ? 1e9 : 2e7, per_length = 1e2 * bulk;
        EXPECT_NEAR(simulation.velocity(0), tested.velocity, 500 * errors[k]) << tested.name << scheme;
        EXPECT_NEAR(column(simulation, "cylinder/ram/pressure_1"), tested.pressure_1, per_length * errors[k])
            << tested.name << scheme;
        EXPECT_NEAR(column(simulation, "cylinder/ram/pressure_2"), tested.pressure_2, per_length * errors[k])
            << tested.name << scheme;
      }
      EXPECT_LT(errors[2], 4e-6) << tested.name << scheme;
      EXPECT_NEAR(0.5 * std::log2(errors[0] / errors[2]), 2, 0.2) << tested.name << scheme;
    }
}

// Oil that stays under pressure: order 4 with em4, which has no valves.
TEST(Hydraulics, HaveTheOrderOfTheScheme) {
  Ram ram;
  ram.oil = "bulk_modulus='2e7' pressure='5e6'";
  EXPECT_THROW(ram.at(1e-3, "em4"), ModelError);
  ram.oil += " makeup='false'";
  ram.speed = 8;
  std::array<double, 2> errors;
  for (int k = 0; k < 2; ++k) {
    Simulation simulation = ram.at(k == 0 ? 1e-3 : 5e-4, "em4");
    run_until(simulation, 0.5);
    errors[k] = std::abs(position_of(simulation, "ram") - 0.678838489651455);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4, 0.2);
}

// A flow Q, or a pump of the speed Q / A1, moves the piston at Q / A1. The mass swings about that on the oil.
TEST(Hydraulics, MoveThePistonAtTheIdealSpeed) {
  const double speed = 0.1, end = 0.5;
  Ram by_flow, by_pump;
  by_flow.oil = fmt::format("bulk_modulus='1.4e9' pressure='2e6' flow='{:.17g}'", speed * Ram::area(0));
  by_pump.oil = "bulk_modulus='1.4e9' pressure='2e6'";
  by_pump.pump = "<pump name='pump'/>";
  by_pump.simulation = "<motion joint='pump' position='0.6+0.1*t'/>";
  std::array<double, 2> lengths;
  for (int k = 0; k < 2; ++k) {
    Simulation simulation = (k == 0 ? by_flow : by_pump).at(1e-4);
    const double start = energy_account(simulation), swing = speed / ram_frequency(1.4e9, 2e6);
    run_until(simulation, end, [&] {
      // New oil is compressed by pressure / bulk modulus, and volumes that change by 12 % change the swing by less.
      const double way = speed * simulation.time(), compressed = 2e6 / 1.4e9 * way;
      ASSERT_NEAR(position_of(simulation, "ram"), 0.6 + way, 1.12 * swing + compressed);
    });
    lengths[k] = position_of(simulation, "ram");
    // Velocities follow from differences of positions: epsilon |r| / step in each of n steps, times m v sqrt(n), of
    // which three times are not exceeded.
    EXPECT_NEAR(energy_account(simulation), start, 3 * 2.2e-16 * 0.6 / 1e-4 * Ram::kMass * 2 * speed * 71);
    EXPECT_NE(simulation.energies().work, 0);
    if (k == 0) continue;
    EXPECT_NEAR(position_of(simulation, "pump"), 0.6 + speed * end, 1e-12);
    // The pump's effort is p1 A1 - p2 A2, with what is stored in the oil less by p / (2 beta).
    const double force = column(simulation, "cylinder/ram/pressure_1") * Ram::area(0) -
                         column(simulation, "cylinder/ram/pressure_2") * Ram::area(1);
    EXPECT_NEAR(column(simulation, "joint/pump/effort"), force, 2e-2 * Ram::kMass * speed * speed / swing);
  }
  EXPECT_NEAR(lengths[0], lengths[1], 1e-12);
}

// The weight of a boom shortens the oil's column until p1 A1 - p2 A2 carries it.
TEST(Hydraulics, CarryABoomInEquilibrium) {
  const double area[2] = {0.25 * kPi * 0.03 * 0.03, 0.25 * kPi * (0.03 * 0.03 - 0.02 * 0.02)};
  const double dead = 2e-5, lower = 0.25, upper = 0.45, bulk = 1e8, start_pressure = 1e6;
  const std::string oil =
      "<limit lower='0.25' upper='0.45'/> <hydraulics bore='0.03' rod='0.02' bulk_modulus='1e8' dead_volume='2e-5' "
      "pressure='1e6 1.2e6'/>";
  const double start = BoomOnParts::length(0.2);
  const auto pressure = [&](int chamber, double length) {
    const auto volume = [&](double at) { return dead + area[chamber] * (chamber == 0 ? at - lower : upper - at); };
    const double content = volume(start) / (1 - (chamber == 0 ? 1 : 1.2) * start_pressure / bulk);
    return bulk * (1 - volume(length) / content);
  };
  const auto excess = [&](double length) {
    return pressure(0, length) * area[0] - pressure(1, length) * area[1] -
           BoomOnParts().force(BoomOnParts::angle_at(length), 0, 0);
  };
  double least = 0.3, most = start + 0.01;  // the oil's force falls with the length, by far more than the weight's
  for (int k = 0; k < 60; ++k) (excess(0.5 * (least + most)) > 0 ? least : most) = 0.5 * (least + most);

  const scene::SceneDescription scene = boom_scene(0.2, oil, "<initial equilibrium='true'/>");
  Simulation boom(scene);
  EXPECT_NEAR(position_of(boom, "lift"), least, 1e-9);
  EXPECT_GT(std::abs(least - start), 5e-5);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(column(boom, fmt::format("cylinder/lift/pressure_{}", i + 1)), pressure(i, least), 2e-9 * bulk / 0.1);
  const double before = position_of(boom, "lift");
  run(boom, 100);
  EXPECT_NEAR(position_of(boom, "lift"), before, 1e-9);
}

// A load of more than relief pressure times area sinks against just that: with the acceleration g - p A1 / m. The rod's
// side fills from the tank.
TEST(Hydraulics, LetSinkWhatIsTooHeavy) {
  Ram ram;
  ram.axis = "0 0 1";
  const double relief = 4e4;  // 201 N of 491 N
  ram.oil = "bulk_modulus='1e9' pressure='1e4' relief_pressure='4e4'";
  Simulation simulation = ram.at(1e-3);
  const double start = energy_account(simulation), acceleration = relief * Ram::area(0) / Ram::kMass - 9.81;
  run_until(simulation, 0.05);
  const double velocity = simulation.velocity(0), position = position_of(simulation, "ram");
  run(simulation, 150, [&] {
    ASSERT_NEAR(column(simulation, "cylinder/ram/pressure_1"), relief, 1e-6);  // round-off of 1e9 Pa
    ASSERT_EQ(column(simulation, "cylinder/ram/pressure_2"), 0);
  });
  // The mean pressure of a step is that times 1 + (du / u)^2 / 4, 1e-6 at 2 m/s.
  const double time = simulation.time() - 0.05;
  EXPECT_NEAR(position_of(simulation, "ram"), position + velocity * time + 0.5 * acceleration * time * time, 1e-7);
  EXPECT_GT(simulation.energies().dissipated,
            0.9 * relief * Ram::area(0) * (Ram::kStart - position_of(simulation, "ram")));
  EXPECT_NEAR(energy_account(simulation), start, 1e-11 * std::abs(start));
}

// A boom that a pump moves to and fro, so fast that valves open and sides become void; the same without valves.
TEST(Hydraulics, KeepTheAccountOfEnergies) {
  for (const bool has_valves : {true, false}) {
    const std::string oil = fmt::format(
        "<limit lower='0.2' upper='0.5'/> <hydraulics bore='0.03' rod='0.02' bulk_modulus='1e8' pressure='4e5' {}>"
        "<pump name='pump'/></hydraulics>",
        has_valves ? "relief_pressure='1.2e6'" : "makeup='false'");
    Simulation boom(boom_scene(0.2, oil,
                               fmt::format("<motion joint='pump' position='{:.17g}+0.02*sin(40*t)-0.8*t*exp(-40*t)'/>",
                                           BoomOnParts::length(0.2))));
    const double start = energy_account(boom);
    int relieved = 0, voids = 0;
    double most = 0;
    Energies last = boom.energies();
    run(boom, 10000, [&] {
      const Energies now = boom.energies();
      relieved += now.dissipated > last.dissipated ? 1 : 0;
      most = std::max(most, now.kinetic + now.strain);
      last = now;
      for (const char* const side : {"cylinder/lift/pressure_1", "cylinder/lift/pressure_2"})
        voids += column(boom, side) == 0 ? 1 : 0;
    });
    EXPECT_GT(voids, 100);
    EXPECT_EQ(relieved > 100, has_valves);
    EXPECT_NEAR(energy_account(boom), start, 1e-11 * (most + last.dissipated));
  }
}

// A pump that asks for more oil than there is.
TEST(Hydraulics, StopWhereNoOilIsLeft) {
  Ram ram;
  ram.oil = "bulk_modulus='1e9' makeup='false'";
  ram.pump = "<pump name='pump'/>";
  ram.simulation = "<motion joint='pump' position='0.6-t'/>";
  Simulation simulation = ram.at(1e-3);
  StepResult result;
  do result = simulation.step();
  while (result.converged && simulation.time() < 1);
  EXPECT_FALSE(result.converged);
  EXPECT_GT(simulation.time(), 0.4);
  EXPECT_NE(simulation.explain(result).find("oil in both chambers"), std::string::npos) << simulation.explain(result);
}

// A pump with inertia and a velocity servo, as for a joint.
TEST(Hydraulics, AreMovedByAServo) {
  Ram ram;
  ram.oil = "bulk_modulus='1.4e9' pressure='2e6'";
  ram.pump =
      "<pump name='pump'> <drive rotor_inertia='20'/> <servo mode='velocity' kp='2e4' ki='2e5' set_point='0.2'/> "
      "</pump>";
  ram.simulation = "<load link='mass' force='-500 0 0'/>";
  Simulation simulation = ram.at(5e-4);
  const double start = energy_account(simulation);
  run_until(simulation, 1);
  EXPECT_NEAR(energy_account(simulation), start, 1e-9);
  const double speed = (position_of(simulation, "ram") - 0.6) / 1;
  EXPECT_NEAR(speed, 0.2, 0.01);
  EXPECT_NEAR(column(simulation, "joint/pump/velocity"), 0.2, 1e-2);
  simulation.command_set_point(simulation.find_coordinate("pump").value(), 0);
  run_until(simulation, 2);
  EXPECT_NEAR(column(simulation, "joint/pump/velocity"), 0, 1e-2);
  EXPECT_NEAR(column(simulation, "joint/pump/effort"), 500, 50);
}

// The example of docs/scene/cylinders.md: what the page says that it does.
TEST(Hydraulics, LiftTheBoomOfTheDocumentation) {
  std::ifstream file(source_path("docs/scene/cylinders.md"));
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = page.find("<robot name=\"lift\">"), end = page.find("</robot>", begin);
  ASSERT_NE(end, std::string::npos);
  Simulation lift(scene_of(page.substr(begin, end + 8 - begin)));
  EXPECT_NEAR(position_of(lift, "ram"), 1, 1e-3);
  run_until(lift, 3);
  EXPECT_NEAR(position_of(lift, "ram"), 1.1, 1e-3);
  EXPECT_NEAR(position_of(lift, "ram_pump"), 1.1, 1e-3);
  const double bore = 0.25 * kPi * 0.08 * 0.08, rod = 0.25 * kPi * 0.045 * 0.045;
  const double force =
      column(lift, "cylinder/ram/pressure_1") * bore - column(lift, "cylinder/ram/pressure_2") * (bore - rod);
  const double angle = position_of(lift, "hinge"), lever = 1.2 * std::sin(angle + std::atan2(0.8, 0.6)) / 1.1;
  EXPECT_NEAR(force, 400 * 9.81 * 1.5 * std::cos(angle) / lever, 1e-3 * force);  // of lengths
}

TEST(Hydraulics, GoIntoCheckpoints) {
  Ram ram;
  ram.oil = "bulk_modulus='2e7' pressure='1e6' relief_pressure='3e6'";
  ram.simulation = "<load link='mass' force='1.1e4 0 0' history='sin(40*t)'/>";
  Simulation one = ram.at(1e-3), other = ram.at(1e-3);
  run_until(one, 0.2);
  other.restore(one.snapshot());
  run_until(one, 0.4), run_until(other, 0.4);
  const char* const pressure = "cylinder/ram/pressure_1";
  EXPECT_EQ(position_of(one, "ram"), position_of(other, "ram"));
  EXPECT_EQ(column(one, pressure), column(other, pressure));
  other.reset();
  EXPECT_NEAR(column(other, pressure), 1e6, 1e-6);
}

}  // namespace flexarm::test
