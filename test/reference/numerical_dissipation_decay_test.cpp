// Tests in hard cases that numerical dissipation never adds energy and never changes momenta.
#include <algorithm>
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

struct HardCase {
  std::string name;
  SceneBuilder scene;
  double step;
  int steps;
  double stiffness;  ///< axial stiffness of the sections [N]
  bool starts_in_equilibrium = false;
  bool is_free = false;
  friend std::ostream& operator<<(std::ostream& out, const HardCase& c) { return out << c.name; }
};

/// A rubber band with EA = 1e6 EI / L^2 under tension with two per cent of strain. A blow in the middle makes it whip.
/// The step resolves neither axial nor shear waves.
HardCase stretched_whip() {
  SceneBuilder b;
  b.beam("band", {{1, 0, 0}}, scene::DirectSection{1e5, 4e4, 4e4, 0.08, 0.1, 0.1, 0.1, 2e-7, 1e-7, 1e-7}, 8, 2);
  b.body("ball", 1, Vector3::Zero(), 1e-3 * Matrix3::Identity());
  b.joint("root", JointKind::Spherical, "world", "band");
  b.joint("tip", JointKind::Fixed, "band", "ball", {1, 0, 0});
  b.load("ball", Vector3::Zero(), {2000, 0, 0});
  b.load("band", {0.5, 0, 0}, {0, 60, 40}, Vector3::Zero(), "0:0 0.05:0 0.06:1 0.1:0");
  return {"stretched_whip", b, 2e-3, 500, 1e5, true};
}

/// The tree with joints of the given kind, thrown. Its sections are a thousand times stiffer in tension than in
/// bending.
HardCase thrown_tree(JointKind kind, const std::string& name) {
  SceneBuilder b = free_tree(kind);
  const scene::DirectSection stiff{1e6, 5e5, 5e5, 8, 10, 12, 1, 0.02, 0.01, 0.01};
  for (scene::LinkDescription& link : b.scene.links)
    if (link.beam) link.beam->section = stiff;
  b.scene.initial_links.front().angular *= 2;
  set_drift(b, Vector3::Zero());
  return {"thrown_tree_" + name, b, 0.02, 500, 1e6, false, true};
}

/// A cantilever that is bent by its own length, and released in the first step.
HardCase sudden_release() {
  SceneBuilder b;
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{2e5, 8e4, 8e4, 1.6, 2, 2, 0.5, 2e-5, 1e-5, 1e-5}, 6, 2);
  b.joint("clamp", JointKind::Fixed, "world", "beam");
  b.load("beam", {1, 0, 0}, {0, 6, 10}, Vector3::Zero(), "0:1 1e-9:0");
  return {"sudden_release", b, 5e-3, 500, 2e5, true};
}

std::vector<HardCase> hard_cases() {
  return {stretched_whip(), thrown_tree(JointKind::Universal, "universal"),
          thrown_tree(JointKind::Revolute, "revolute"), thrown_tree(JointKind::Spherical, "spherical"),
          sudden_release()};
}

Simulation start(const HardCase& c, int order, double rho) {
  SceneBuilder b = c.scene;
  b.scene.integrator.scheme = "edmc" + std::to_string(order);
  b.scene.integrator.rho_infinity = rho;
  b.scene.integrator.step = c.step;
  b.scene.integrator.tolerance = 1e-10;
  Simulation simulation(b.scene, full_newton());
  if (c.starts_in_equilibrium) {
    EXPECT_TRUE(simulation.solve_static(10).converged);
  }
  return simulation;
}

/// Distance of the farthest node from the origin [m].
double extent(const State& state) {
  double largest = 0;
  for (const NodeState& node : state.nodes) largest = std::max(largest, node.position.norm());
  return largest;
}

/// Velocity error by round-off of positions r in v_1 = 2 Delta r / h - v_0, for ten operations.
double velocity_round_off(const Simulation& simulation, double step) {
  return 10 * kEpsilon * 2 * extent(state_of(simulation)) / step;
}

/// Round-off of the energy in a step: that of velocities, and that of strains times the stress. The latter is at most
/// that of all strain energy in tension over a length of 1 m.
double energy_round_off(const Simulation& simulation, const HardCase& c) {
  const double refined = std::ldexp(c.step, -state_of(simulation).halving_level);
  const Energies e = simulation.energies();
  const double momentum = std::sqrt(2 * total_mass(simulation) * e.kinetic);
  return momentum * velocity_round_off(simulation, refined) +
         10 * kEpsilon *
             (std::sqrt(2 * c.stiffness * e.strain) + e.kinetic + e.strain + std::abs(e.work) + e.dissipated);
}

using Parameter = std::tuple<int, double, HardCase>;
class NumericalDissipationDecay : public ::testing::TestWithParam<Parameter> {};
class NumericalDissipationInFreeFlight : public NumericalDissipationDecay {};

TEST_P(NumericalDissipationDecay, EnergyNeverGrows) {
  const auto [order, rho, c] = GetParam();
  Simulation simulation = start(c, order, rho);
  const auto own = [&] {
    const Energies e = simulation.energies();
    return e.total() - e.work;
  };
  const double begin = own() + simulation.energies().dissipated;
  double energy = own(), highest = energy, growth = 0, dissipated = 0, budget = 0, bound = 0;
  int halvings = 0;
  for (int n = 0; n < c.steps; ++n) {
    const StepResult result = simulation.step();
    ASSERT_TRUE(result.converged) << to_string(result.reason) << " at t = " << simulation.time();
    halvings += result.halvings;
    const double unit = energy_round_off(simulation, c) * (1 << (2 * std::min(5, result.halvings)));
    const Energies e = simulation.energies();
    bound += unit;
    growth = std::max(growth, (own() - energy) / unit);
    ASSERT_GE(e.dissipated, dissipated) << "a sum of squares";
    budget = std::max(budget, std::abs(own() + e.dissipated - begin) / bound);
    energy = own();
    highest = std::max(highest, e.kinetic + e.strain);
    dissipated = e.dissipated;
  }
  EXPECT_LT(growth, 1) << "units of a step's round-off";
  EXPECT_LT(budget, 1) << "units of all steps' round-off";
  EXPECT_GT(dissipated, 1e-6 * highest) << "it must dissipate";
  std::printf("edmc%d rho %.1f %s: dissipated %.1e of %.1e J, growth %.1e, budget %.1e of %.1e J, %d halvings\n", order,
              rho, c.name.c_str(), dissipated, highest, growth, budget, bound, halvings);
}

TEST_P(NumericalDissipationInFreeFlight, MomentaAreExact) {
  const auto [order, rho, c] = GetParam();
  Simulation simulation = start(c, order, rho);
  InvariantDrift drift(simulation);
  run(simulation, c.steps, [&] { drift.observe(); });
  // Internal forces cancel in the sums at any stress. Only the round-off of velocities remains.
  const double speed = std::sqrt(2 * simulation.energies().kinetic / total_mass(simulation));
  const double bound = c.steps * velocity_round_off(simulation, c.step) / speed;
  std::printf("edmc%d rho %.1f %s: drift of momentum %.1e, angular momentum %.1e of %.1e\n", order, rho, c.name.c_str(),
              drift.momentum(), drift.angular_momentum(), bound);
  EXPECT_LT(drift.momentum(), bound);
  EXPECT_LT(drift.angular_momentum(), bound);
}

std::string parameter_name(const ::testing::TestParamInfo<Parameter>& info) {
  return "edmc" + std::to_string(std::get<0>(info.param)) + "_rho" +
         std::to_string(static_cast<int>(10 * std::get<1>(info.param))) + "_" + std::get<2>(info.param).name;
}

std::vector<HardCase> free_cases() {
  std::vector<HardCase> cases = hard_cases();
  cases.erase(std::remove_if(cases.begin(), cases.end(), [](const HardCase& c) { return !c.is_free; }), cases.end());
  return cases;
}

const auto kOrders = ::testing::Values(1, 2);
const auto kRadii = ::testing::Values(0.0, 0.5, 0.9);
INSTANTIATE_TEST_SUITE_P(HardCases, NumericalDissipationDecay,
                         ::testing::Combine(kOrders, kRadii, ::testing::ValuesIn(hard_cases())), parameter_name);
INSTANTIATE_TEST_SUITE_P(HardCases, NumericalDissipationInFreeFlight,
                         ::testing::Combine(kOrders, kRadii, ::testing::ValuesIn(free_cases())), parameter_name);

// Shows that with rho_infinity = 1 the scheme is em, and nothing is dissipated.
TEST(NumericalDissipationDecay, NoneWhereRhoIsOne) {
  const HardCase c = sudden_release();
  Simulation simulation = start(c, 2, 1);
  InvariantDrift drift(simulation);
  run(simulation, c.steps, [&] { drift.observe(); });
  EXPECT_EQ(simulation.energies().dissipated, 0);
  EXPECT_LT(drift.energy(), 1e-10);
}

}  // namespace
}  // namespace flexarm::test
