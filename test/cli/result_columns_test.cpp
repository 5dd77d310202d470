/// Tests the choice of columns by patterns: names, order, values, units, and that unneeded values are not computed.
#include "flexarm/simulation/result_columns.h"

#include <algorithm>

#include "cli/program.h"
#include "flexarm/scene/urdf_reader.h"
#include "simulation/everything_scene.h"
#include "simulation/inside.h"

namespace flexarm::cli {
namespace {

using Solver = ResultColumns::Solver;

Simulation everything() {
  test::SceneBuilder b = test::everything_scene();
  b.sensor("eye", scene::SensorKind::Pose, "beam4");
  return Simulation(b.scene);
}

std::vector<std::string> names(const Simulation& simulation, const std::vector<std::string>& patterns) {
  std::vector<std::string> names;
  const ResultColumns columns(simulation, Solver::With, patterns);
  for (const ResultColumn& column : columns.columns()) names.push_back(column.name);
  return names;
}

}  // namespace

TEST(ResultColumns, AreThoseThatFit) {
  const Simulation simulation = everything();
  EXPECT_EQ(names(simulation, {"joint/hinge/*", "energy/total"}),
            (std::vector<std::string>{"time", "joint/hinge/position", "joint/hinge/velocity", "joint/hinge/effort",
                                      "energy/total"}));
  EXPECT_EQ(names(simulation, {"probe/tip/[av]z"}), (std::vector<std::string>{"time", "probe/tip/vz", "probe/tip/az"}));
}

TEST(ResultColumns, AreInTheOrderInWhichTheyAreAskedFor) {
  const Simulation simulation = everything();
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(simulation, {"probe/tip/z", "energy/total", "probe/tip/x", "joint/hinge/position"}),
            (Names{"time", "probe/tip/z", "energy/total", "probe/tip/x", "joint/hinge/position"}));
  EXPECT_EQ(names(simulation, {"momentum/y", "time", "energy/total"}), (Names{"time", "momentum/y", "energy/total"}));
  // Columns that match one pattern keep their usual order. A column comes only once.
  EXPECT_EQ(names(simulation, {"momentum/z", "momentum/[xz]", "m*/[xy]"}),
            (Names{"time", "momentum/z", "momentum/x", "momentum/y"}));
  Names all = names(simulation, {"*"});
  EXPECT_EQ(names(simulation, {"*", "energy/total"}), all);
  all.erase(std::find(all.begin(), all.end(), "energy/total"));
  all.insert(all.begin() + 1, "energy/total");
  EXPECT_EQ(names(simulation, {"energy/total", "*"}), all) << "the time is first";
}

TEST(ResultColumns, HaveTheirValuesInAnyOrder) {
  Simulation simulation = everything();
  for (int n = 0; n < 3; ++n) simulation.step();
  ResultColumns columns(simulation, Solver::With, {"energy/work", "probe/tip/z", "energy/kinetic", "probe/tip/x"});
  const Vector3 tip = simulation.probe_pose(0).position;
  const Energies energies = simulation.energies();
  const std::vector<double> expected = {simulation.time(), energies.work, tip.z(), energies.kinetic, tip.x()};
  EXPECT_EQ(columns.row(simulation, {}), expected);
  EXPECT_EQ(columns.row(simulation, {}), expected) << "again";
}

TEST(ResultColumns, HaveTheValuesOfAllColumns) {
  Simulation simulation = everything();
  for (int n = 0; n < 3; ++n) simulation.step();
  ResultColumns all(simulation, Solver::With);
  const std::vector<double> row = all.row(simulation, {});
  ASSERT_EQ(row.size(), all.columns().size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    std::string pattern = all.columns()[i].name;
    ResultColumns one(simulation, Solver::With, {pattern});
    EXPECT_EQ(one.row(simulation, {}).back(), row[i]) << pattern;
  }
}

TEST(ResultColumns, MakeNothingThatNoColumnNeeds) {
  Simulation simulation = everything();
  const auto made_by = [&](const std::vector<std::string>& patterns) {
    ResultColumns columns(simulation, Solver::With, patterns);
    EXPECT_TRUE(simulation.step().converged);
    EXPECT_TRUE(made_for_output(simulation).is_nothing()) << "a step makes nothing for output";
    columns.row(simulation, {});
    return made_for_output(simulation);
  };
  for (int n = 0; n < 5; ++n) {  // in the first steps, the scheme computes velocities itself
    EXPECT_TRUE(made_by({"time"}).is_nothing());
    EXPECT_TRUE(made_by({"joint/*/position", "joint/*/effort", "frame/*", "probe/*/[xyz]", "probe/*/q?", "solver/*",
                         "sensor/*"})
                    .is_nothing());
    const MadeForOutput rates = made_by({"joint/*/velocity"}), velocities = made_by({"probe/*/v?"});
    EXPECT_TRUE(rates.rates);
    EXPECT_FALSE(rates.velocities || rates.accelerations || rates.energies || rates.momenta);
    EXPECT_TRUE(velocities.velocities);
    EXPECT_FALSE(velocities.accelerations || velocities.energies || velocities.momenta);
    const MadeForOutput accelerations = made_by({"probe/*/ax"}), energies = made_by({"energy/work"});
    EXPECT_TRUE(accelerations.accelerations);
    EXPECT_FALSE(accelerations.rates || accelerations.velocities || accelerations.energies || accelerations.momenta);
    EXPECT_TRUE(energies.energies);
    EXPECT_FALSE(energies.rates || energies.velocities || energies.accelerations || energies.momenta);
    const MadeForOutput momenta = made_by({"momentum/x"});
    EXPECT_TRUE(momenta.momenta);
    EXPECT_FALSE(momenta.rates || momenta.velocities || momenta.accelerations || momenta.energies);
  }
}

TEST(ResultColumns, HaveUnits) {
  const Simulation simulation = everything();
  const auto unit = [&](const std::string& name) {
    return ResultColumns(simulation, Solver::With, {name}).columns().back().unit;
  };
  EXPECT_EQ(unit("joint/hinge/position"), "rad");
  EXPECT_EQ(unit("joint/prismatic/effort"), "N");
  EXPECT_EQ(unit("joint/cylindrical/1/velocity"), "m/s");
  EXPECT_EQ(unit("probe/tip/ax"), "m/s^2");
  EXPECT_EQ(unit("sensor/eye/qw"), "1");
  EXPECT_EQ(unit("angular_momentum/y"), "kg m^2/s");
}

TEST(ResultColumns, NobodyIsLikeAreRefused) {
  const Simulation simulation = everything();
  EXPECT_THROW(names(simulation, {"joint/*", "joints/*"}), std::invalid_argument);
  try {
    names(simulation, {"energy/totl"});
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    expect_contains(error.what(), "no column is like 'energy/totl'; there are energy/total, ");
    expect_contains(error.what(), " others");
  }
}

TEST(Columns, AreChosenOnTheCommandLine) {
  const std::string out = temporary("out.csv");
  const std::string run =
      "flexarm simulate --quiet --until 0.01 " + example("flexible_two_link_arm") + " --output " + out;
  EXPECT_EQ(shell(run + " --columns 'energy/*,momentum/x'").status, 0);
  EXPECT_EQ(read_csv(out).size(), 8u);
  const Outcome refused = shell(run + " --columns 'speed/*'");
  EXPECT_EQ(refused.status, 2);
  expect_contains(refused.errors, "flexarm: --columns: no column is like 'speed/*'; there are ");
  const Outcome bag = shell("flexarm simulate --until 0.01 " + example("flexible_two_link_arm") + " --output " +
                            temporary("out.bag") + " --columns time");
  EXPECT_EQ(bag.status, 2);
  expect_contains(bag.errors, "a bag has messages, not columns");
}

}  // namespace flexarm::cli
