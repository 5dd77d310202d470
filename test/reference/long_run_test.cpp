// Tests the drift of the quantities that em conserves over a million steps of a free mechanism.
#include <cstdio>

#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

constexpr double kFlightStep = 0.05;  // s

/// Two links of one linear element each on a spherical joint. This joint keeps its rotation as a quaternion. The angle
/// of a hinge would have a round-off of epsilon times the angle, which grows with the turns of a free flight.
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

/// Compares the drifts after 1000, 10 000, ... steps, up to `steps`, with a bound. `position_error`: error of a step
/// [m]. The growth is measured from `first` steps on.
void expect_slow_drift(Simulation& simulation, int first, int steps, double position_error) {
  InvariantDrift drift(simulation);
  // An error d of a position gives an error of 2 d / h in v_1 = 2 Delta r / h - v_0, at both ends of the step. The
  // relative energy error is twice its ratio to v. If the errors of all N steps have the same direction, the drift is C
  // N with the following C.
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
  // The drift grows at most linearly, within a factor of two.
  for (std::size_t k = 0; k + 1 < rates.size(); ++k) EXPECT_LT(rates.back(), 2 * rates[k]);
}

// Full Newton leaves round-off of positions, of about the mechanism's size, without a preferred direction. The measured
// drift grows as sqrt(N); the bound is for N.
TEST(LongRun, RoundOffOfAMillionSteps) {
  SimulationOptions set = options("em", kFlightStep, 1e-10);
  set.reuse_factorisation = false;
  Simulation simulation(two_links().scene, set);
  expect_slow_drift(simulation, 1000, 1000000, kEpsilon * model_of(simulation).length_scale);
}

// With kept factors, Newton's method ends when the next update would be below 1e-15 of the mechanism's size. The
// remaining error has the direction of convergence. The measured drift grows as N once it exceeds round-off, after a
// few thousand steps.
TEST(LongRun, RemainderOfNewtonsMethod) {
  Simulation simulation(two_links().scene, options("em", kFlightStep, 1e-10));
  expect_slow_drift(simulation, 10000, 100000, (kEpsilon + 1e-15) * model_of(simulation).length_scale);
}

}  // namespace
}  // namespace flexarm::test
