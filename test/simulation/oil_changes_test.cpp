// Tests what programs do with hydraulic cylinders: derivatives of runs, linear models, spawned models, set positions.
#include <algorithm>
#include <cmath>

#include "flexarm/simulation/payloads.h"
#include "math/pi.h"
#include "simulation/sensitivity_scenes.h"
#include "support/boom.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

const char* const kOilOfBoom =
    "<limit lower='0.2' upper='0.5'/> <hydraulics bore='0.03' rod='0.02' bulk_modulus='1e8' pressure='2e6'>"
    "<pump name='pump'> <drive rotor_inertia='20'/> </pump> </hydraulics>";

double pressure_of(const Simulation& simulation, const std::string& cylinder) {
  return column(simulation, "cylinder/" + cylinder + "/pressure_1");
}

}  // namespace

// Derivatives of a swing by numbers of the oil, against central differences of runs.
TEST(HydraulicStudies, HaveDerivativesOfRuns) {
  const Scene scene{with_scheme(R"x(<robot name="boom">
    <parameter name="bulk" value="2e7"/> <parameter name="start" value="1e6"/> <parameter name="bore" value="0.03"/>
    <link name="world"/>
    <joint name="hinge" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 -1 0"/> </joint>
    <link name="boom"> <inertial> <origin xyz="0.5 0 0"/> <mass value="10"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
    <cylinder name="lift" from="world" from_at="0.3 0 -0.3" to="boom" to_at="0.3 0 0"> <limit lower="0.2" upper="0.5"/>
      <hydraulics bore="${bore}" rod="0.02" bulk_modulus="${bulk}" pressure="${start}" flow="3e-5*sin(9*t)"/> </cylinder>
    <simulation> </simulation>)x",
                                "em", 2e-3)};
  Simulation simulation = scene.simulation();
  const std::vector<std::pair<std::string, double>> parameters = {{"bulk", 2e7}, {"start", 1e6}, {"bore", 0.03}};
  Sensitivities sensitivities(simulation, scene.request({"bulk", "start", "bore"}));
  const auto observed = [](const Simulation& at) -> Eigen::VectorXd {
    return Eigen::Vector2d(position_of(at, "hinge"), 1e-6 * pressure_of(at, "lift"));
  };
  for (int n = 0; n < 200; ++n) ASSERT_TRUE(sensitivities.step().converged);
  ASSERT_EQ(sensitivities.lost(), "");
  const Eigen::MatrixXd found = sensitivities.of(observed);
  for (int k = 0; k < 3; ++k) {
    const auto& [name, value] = parameters[k];
    const auto after = [&, name = name](double number) {
      Simulation run = scene.simulation({{name, number}});
      for (int n = 0; n < 200; ++n) run.step();
      return observed(run);
    };
    const double way = 1e-4 * value;  // truncation of 1e-8 times third derivatives, round-off of 1e-11 / 1e-4
    const Eigen::VectorXd expected = (after(value + way) - after(value - way)) / (2 * way);
    EXPECT_LT((found.col(k) - expected).norm(), 1e-5 * expected.norm()) << name;
  }
}

// Two masses, boom and pump, on the oil: the frequency of the reduced mass, and one motion that is free.
TEST(HydraulicStudies, HaveModesWithAPump) {
  const char* const simulation_part = "<gravity xyz='0 0 0'/>";
  const Simulation boom(boom_scene(0.2, kOilOfBoom, simulation_part));
  const std::vector<Mode> modes = boom.natural_modes(2);
  const double length = BoomOnParts::length(0.2), lever = BoomOnParts::lever(0.2);
  double by_length = 0, by_both = 0, by_pump = 0;
  for (const int i : {0, 1}) {
    const double area = 0.25 * kPi * (i == 0 ? 9e-4 : 9e-4 - 4e-4), pressure = i == 0 ? 2e6 : 2e6 * 9.0 / 5;
    const double volume = 0.1 * area * 0.3 + area * (i == 0 ? length - 0.2 : 0.5 - length);
    const double content = volume / (1 - pressure / 1e8), stiffness = 1e8 * area * area / content;
    by_length += stiffness;
    by_both -= stiffness * volume / content;
    by_pump += stiffness * volume * volume / (content * content);
  }
  const double boom_mass = BoomOnParts().mass(0.2) / (lever * lever), pump_mass = 20;
  // The pairs of both equations of motion; nothing has a force at the start.
  const double sum = by_length / boom_mass + by_pump / pump_mass;
  const double product = (by_length * by_pump - by_both * by_both) / (boom_mass * pump_mass);
  const double fast = std::sqrt(0.5 * (sum + std::sqrt(sum * sum - 4 * product)));
  EXPECT_NEAR(2 * kPi * modes.at(1).frequency, fast, 1e-6 * fast);
  const double slow = std::sqrt(product) / fast;
  EXPECT_NEAR(2 * kPi * modes[0].frequency, slow, 1e-3 * slow + 1e-5 * fast);
}

// Models with cylinders on oil come with a prefix, anywhere, and go with their pumps.
TEST(HydraulicStudies, ComeAndGoWithModels) {
  Simulation simulation(boom_scene(0.2, kOilOfBoom, ""));
  run(simulation, 20);
  const double pressure = pressure_of(simulation, "lift");
  EXPECT_GT(std::abs(pressure - 2e6), 1e4);
  Spawn where;
  where.prefix = "b_";
  where.pose.position = {0, 2, 1};
  spawn(simulation, boom_scene(0.1, kOilOfBoom, ""), where);
  EXPECT_NEAR(pressure_of(simulation, "lift"), pressure, 1e-3);  // of 1e8 Pa
  EXPECT_NEAR(pressure_of(simulation, "b_lift"), 2e6, 1e-3);
  EXPECT_NEAR(position_of(simulation, "b_pump"), BoomOnParts::length(0.1), 1e-12);
  run(simulation, 20);
  remove(simulation, "lift_barrel");
  EXPECT_FALSE(simulation.find_coordinate("pump"));
  EXPECT_TRUE(simulation.find_coordinate("b_pump"));
  run(simulation, 20);
}

TEST(HydraulicStudies, NeedAStartWithinTheStroke) {
  const std::string oil = "<limit lower='0.42' upper='0.5'/> <hydraulics bore='0.03' bulk_modulus='1e8'/>";
  EXPECT_EQ(refusal_of(boom_scene(0.2, oil, "")),
            "test.urdf:5: <hydraulics> of cylinder 'lift': its length at the start, 0.359651 m, is so far beyond its "
            "limits, 0.42 to 0.5, that a chamber has no volume");
}

// A program sets velocities, and moves the pump by a millimetre: that much oil has come, and nothing else.
TEST(HydraulicStudies, KeepTheirOilWhereAStateIsSet) {
  Simulation simulation(boom_scene(0.2, kOilOfBoom, ""));
  run(simulation, 20);
  const double pressure = pressure_of(simulation, "lift");
  CoordinateState pump;
  pump.coordinate = simulation.find_coordinate("pump").value();
  pump.velocity = 0.01;
  simulation.set_joint_state({pump});
  EXPECT_NEAR(pressure_of(simulation, "lift"), pressure, 1e-3);  // of 1e8 Pa
  pump.position = position_of(simulation, "pump") + 1e-3;
  simulation.set_joint_state({pump});
  const double area = 0.25 * kPi * 9e-4, length = position_of(simulation, "lift");
  const double content = area * (0.03 + length - 0.2) / (1 - pressure / 1e8);
  const double volume = area * (0.03 + length - 0.2);
  EXPECT_NEAR(pressure_of(simulation, "lift"), 1e8 * (1 - volume / (content + 1e-3 * area)), 1e-2);
  ASSERT_TRUE(simulation.step().converged);
}

}  // namespace flexarm::test
