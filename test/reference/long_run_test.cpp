// A million steps of a free mechanism: the drift of what em conserves.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

constexpr double kFlightStep = 0.05;  // s

/// Two links of one linear element each on a spherical joint, which keeps its rotation as a quaternion: a hinge's angle
/// is resolved to epsilon times the angle, which grows with the turns of a free flight.
SceneBuilder two_links() {
  SceneBuilder b;
  b.beam("first", {{1, 0, 0}}, soft_section(), 1, 1);
  b.beam("second", {{0, 1, 0.2}}, soft_section(), 1, 1);
  b.joint("free", scene::JointKind::Floating, "world", "first");
  b.joint("ball", scene::JointKind::Spherical, "first", "second", {1, 0, 0});
  initial_field(b, "first", Vector3::Zero(), {0.3, 0.5, 1});
  initial_joint(b, "ball/rz", 0.2, -0.5);
  set_drift(b, Vector3::Zero());
  return b;
}

/// Drifts after 1000 and every ten times as many steps, up to `steps`; `position_error`: of a step [m]. Growth is seen
/// from `first` steps on.
void expect_slow_drift(Simulation& simulation, int first, int steps, double position_error) {
  InvariantDrift drift(simulation);
  // An error d of the position makes one of 2 d / h in v_1 = 2 Delta r / h - v_0, at both ends of the step, and twice
  // its ratio to v in the energy: C N with the following C if the errors of all N steps pull in one direction.
  const double speed = std::sqrt(2 * simulation.energies().kinetic / total_mass(simulation));
  const double per_step = 2 * (2 * 2 * position_error / kFlightStep) / speed;
  std::vector<double> rates;
  int done = 0;
  for (int until = 1000; until <= steps; until *= 10) {
    for (; done < until; ++done) {
      const StepResult result = simulation.step();
      ASSERT_TRUE(result.converged && result.halvings == 0) << to_string(result.reason);
      if (done % 10 == 0) drift.observe();
    }
    drift.observe();
    const double largest = std::max({drift.energy(), drift.momentum(), drift.angular_momentum()});
    std::printf("%7d steps: drift of energy %.1e, momentum %.1e, angular momentum %.1e; bound %.1e\n", until,
                drift.energy(), drift.momentum(), drift.angular_momentum(), until * per_step);
    EXPECT_LT(largest, until * per_step);
    if (until >= first) rates.push_back(largest / until);
  }
  const double power = 1 + std::log10(rates.back() / rates.front()) / static_cast<double>(rates.size() - 1);
  std::printf("grows as N^%.2f\n", power);
  // Not faster than linearly, within a factor of two.
  for (std::size_t k = 0; k + 1 < rates.size(); ++k) EXPECT_LT(rates.back(), 2 * rates[k]);
}

// Full Newton steps leave the round-off of positions, of about the mechanism's size, without a preferred direction:
// measured is sqrt(N), the bound is for N.
TEST(LongRun, RoundOffOfAMillionSteps) {
  SimulationOptions set = options("em", kFlightStep, 1e-10);
  set.reuse_factorisation = false;
  Simulation simulation(two_links().scene, set);
  expect_slow_drift(simulation, 1000, 1000000, kEpsilon * model_of(simulation).length_scale);
}

// Kept factors let Newton's method stop where the next update would be below 1e-15 of the mechanism's size. What it
// leaves out points in the direction in which it converges: measured is N, from where it is more than round-off, which
// a thousand steps still are.
TEST(LongRun, RemainderOfNewtonsMethod) {
  Simulation simulation(two_links().scene, options("em", kFlightStep, 1e-10));
  expect_slow_drift(simulation, 10000, 100000, (kEpsilon + 1e-15) * model_of(simulation).length_scale);
}

}  // namespace
}  // namespace flexarm::test
