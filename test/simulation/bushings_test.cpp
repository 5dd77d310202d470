// Tests <bushing> from its line in the scene to its result columns.
#include <algorithm>
#include <cmath>

#include "flexarm/simulation/linear_model.h"
#include "math/pi.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kMass = 2, kInertia[] = {0.02, 0.03, 0.04};

/// A free body in a bushing to the world at its centre of mass.
std::string body_in_bushing(const std::string& bushing, const std::string& entries) {
  return robot(joint("free", "floating", "world", "body") +
                   body("body", kMass, {kInertia[0], kInertia[1], kInertia[2]}) + bushing,
               gravity({0, 0, 0}) + entries);
}

Simulation simulated(const std::string& bushing, const std::string& entries, const SimulationOptions& options = {}) {
  return Simulation(scene_of(body_in_bushing(bushing, entries)), options);
}

const std::string kDiagonal =
    R"(<bushing name="b" from="world" to="body" stiffness="200 300 500 4 6 9" damping="0 0 0 0 0 0"/>)";

// Six oscillators, whose frequencies are sqrt(k/m).
TEST(Bushing, HasItsFrequencies) {
  const double stiffness[] = {200, 300, 500, 4, 6, 9};
  std::vector<double> expected;
  for (int i = 0; i < 6; ++i)
    expected.push_back(std::sqrt(stiffness[i] / (i < 3 ? kMass : kInertia[i - 3])) / (2 * kPi));
  std::sort(expected.begin(), expected.end());
  const std::vector<Mode> modes = simulated(kDiagonal, "").natural_modes(6);
  ASSERT_EQ(modes.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(modes[i].frequency, expected[i], 1e-10 * expected[i]);
}

// A turned frame, and a matrix that couples a way with a rotation: the body rests where stiffness times the measures is
// the load. The load is so small that the rotation is a vector.
TEST(Bushing, YieldsByItsMatrix) {
  std::string matrix;
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  stiffness.diagonal() << 200, 300, 500, 4, 6, 9;
  stiffness(0, 4) = stiffness(4, 0) = 20;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix += fmt::format("{} ", stiffness(i, j));
  Simulation simulation = simulated(
      fmt::format(R"(<bushing name="b" from="world" to="body" rpy="0 0 {}" stiffness="{}"/>)", 0.5 * kPi, matrix),
      R"(<load link="body" force="0 1e-6 0"/>)");
  ASSERT_TRUE(simulation.solve_static(1).converged);
  // The load is along the bushing's x axis.
  const Eigen::Matrix<double, 6, 1> expected = stiffness.ldlt().solve(1e-6 * Eigen::Matrix<double, 6, 1>::Unit(0));
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"bushing/b/*"});
  const std::vector<double>& row = columns.row(simulation, {});
  ASSERT_EQ(columns.columns().at(row.size() - 12).name, "bushing/b/x");
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(row[row.size() - 12 + i], expected[i], 1e-9 * expected.norm()) << i;
  EXPECT_NEAR(row[row.size() - 6], -1e-6, 1e-15) << "the force on the body";
}

// It oscillates with a large rotation and a way at once: energy and momenta of a pair that floats.
TEST(Bushing, KeepsEnergyAndMomenta) {
  const auto pair = [](double damping) {
    return robot(joint("one", "floating", "world", "a") +
                     joint("two", "floating", "world", "b", "<origin xyz='0.3 0 0'/>") +
                     body("a", 2, {0.02, 0.03, 0.04}) + body("b", 1, {0.02, 0.03, 0.04}) +
                     fmt::format("<bushing from='a' from_at='0.1 0 0' to='b' to_at='-0.1 0.02 0' rpy='0.3 0 0' "
                                 "stiffness='200 300 500 4 6 9' damping='{0} {0} {0} 0 {0} 0'/>",
                                 damping),
                 gravity({0, 0, 0}) + "<initial link='b' linear='0.5 1 -0.4' angular='8 -6 5'/>");
  };
  for (const double damping : {0.0, 0.05})
    for (const std::string scheme : {"em", "em0", "em4"}) {
      Simulation simulation(scene_of(pair(damping)), options(scheme, 5e-3));
      const double energy = energy_account(simulation);
      const Vector3 linear = simulation.momentum(), angular = simulation.angular_momentum();
      run(simulation, 500);
      EXPECT_NEAR(energy_account(simulation), energy, 1e-11 * energy) << scheme << damping;
      EXPECT_EQ(damping > 0, simulation.energies().dissipated > 1e-3 * energy) << scheme;
      EXPECT_LE((simulation.momentum() - linear).norm(), 1e-11 * linear.norm()) << scheme;
      EXPECT_LE((simulation.angular_momentum() - angular).norm(), 1e-11) << scheme;
    }
}

// All schemes agree, with the second or fourth order of the method.
TEST(Bushing, UnderAllSchemes) {
  const std::string start = R"(<initial link="body" linear="0.2 0.1 -0.3" angular="1 2 -1"/>)";
  const std::string damped =
      R"(<bushing name="b" from="world" to="body" stiffness="200 300 500 4 6 9" damping="1 1 1 0.01 0.01 0.01"/>)";
  const auto end_of = [&](const std::string& scheme, double step) {
    Simulation simulation = simulated(damped, start, options(scheme, step));
    run_until(simulation, 0.5);
    return std::vector<double>{simulation.position(0), simulation.position(1), simulation.position(3),
                               simulation.position(5)};
  };
  const std::vector<double> exact = end_of("em4", 5e-4);
  for (const std::string scheme : {"em", "newmark"}) {
    const std::vector<double> coarse = end_of(scheme, 2e-3), fine = end_of(scheme, 1e-3);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      EXPECT_NEAR(fine[i], exact[i], 2e-4) << scheme;
      EXPECT_NEAR((coarse[i] - exact[i]) / (fine[i] - exact[i]), 4, 0.5) << scheme << i;
    }
  }
}

TEST(Bushing, Errors) {
  const auto expect_error = [](const std::string& attributes, const std::string& expected) {
    const scene::ReadResult read = scene::read_scene_text(
        body_in_bushing(fmt::format("<bushing from='world' to='body' {}/>", attributes), ""), "mount.urdf");
    expect_contains(scene::to_text(read.diagnostics), expected);
    EXPECT_FALSE(read.scene);
  };
  expect_error("", "attribute 'stiffness' is missing");
  expect_error(R"(stiffness="1 2 3")", "stiffness must be 6 or 36 numbers, got '1 2 3'");
  expect_error(R"(stiffness="1 2 3 4 5 -6")", "stiffness must not be negative in any direction");
  std::string rows = "1 0.5";
  for (int i = 2; i < 36; ++i) rows += i % 7 == 0 ? " 1" : " 0";
  expect_error(fmt::format("stiffness=\"{}\"", rows), "the matrix of stiffness must be symmetric");
  expect_error(R"(stiffness="1 1 1 1 1 1" rest="2")",
               "unknown attribute, expected name, from, from_at, to, to_at, rpy");
}

}  // namespace
}  // namespace flexarm::test
