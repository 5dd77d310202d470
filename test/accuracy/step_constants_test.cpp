// Tests that what a scheme takes from the scene's step, the relaxation of dampers and numerical dissipation, does not
// stay as an error of a run to an accuracy: against the closed form of a damped oscillator.
#include <algorithm>
#include <cmath>

#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/accuracy/companion.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

constexpr double kMass = 2, kStiffness = 800, kViscosity = 0.02, kPush = 8, kUntil = 0.5;  // kg, N/m, s, N, s

/// A mass at the end of a rod that has hardly any mass of its own. A force along the rod begins to push at once.
scene::SceneDescription oscillator(const char* scheme, double viscosity) {
  const std::string damping = viscosity > 0 ? fmt::format("<damping stiffness_proportional='{}'/>", viscosity) : "";
  return scene_of(robot(
      joint("clamp", "fixed", "world", "rod") +
          fmt::format(R"(<link name="rod"> <beam elements="1" order="1"> <centerline> <line to="1 0 0"/> </centerline>
            <section ea="{}" ga2="1e3" ga3="1e3" gj="10" ei2="10" ei3="10" mass="1e-9" j1="1e-12" j2="1e-12" j3="1e-12"/>
            {} </beam> </link>)",
                      kStiffness, damping) +
          joint("grip", "fixed", "rod", "mass", "<origin xyz='1 0 0'/>") + body("mass", kMass),
      gravity({0, 0, 0}) + integrator(scheme, 0.01) +
          fmt::format("<load link='mass' force='{} 0 0'/> <probe name='tip' link='mass'/>", kPush)));
}

/// Displacement of the mass after a time, from m x'' + eta k x' + k x = F.
double exact(double viscosity, double time) {
  const double w = std::sqrt(kStiffness / kMass), decay = 0.5 * viscosity * w * w,
               turning = std::sqrt(w * w - decay * decay);
  return kPush / kStiffness *
         (1 - std::exp(-decay * time) * (std::cos(turning * time) + decay / turning * std::sin(turning * time)));
}

struct Oscillator {
  const char* scheme;
  double viscosity;
};

class StepConstants : public ::testing::TestWithParam<Oscillator> {};

TEST_P(StepConstants, FollowTheSteps) {
  const auto [scheme, viscosity] = GetParam();
  for (const double accuracy : {1e-3, 1e-5, 1e-6}) {
    Simulation simulation(oscillator(scheme, viscosity));
    RunWatcher watcher;
    const AccurateRun run = run_to_accuracy(simulation, {accuracy, kUntil}, watcher);
    EXPECT_EQ(run.end, AccurateRun::End::Met);
    const Trajectory& path = run.motion.points[0];
    double squares = 0, largest = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double x = exact(viscosity, kUntil * static_cast<double>(i) / static_cast<double>(path.size() - 1));
      squares += std::pow(path[i][0] - path[0][0] - x, 2);
      largest = std::max(largest, x);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(path.size())), accuracy * largest);
    EXPECT_EQ(step_of_constants(simulation), 0.01);
  }
}

// Steps of 0.1 ms have hardly any error of their own.
TEST_P(StepConstants, HaveAnEffectOfSecondOrder) {
  const auto [scheme, viscosity] = GetParam();
  double errors[2];
  for (const int k : {0, 1}) {
    Simulation simulation(oscillator(scheme, viscosity));
    set_step_of_constants(simulation, 0.01 / (1 << k));
    simulation.set_step_size(1e-4);
    run_until(simulation, kUntil);
    errors[k] = std::abs(simulation.probe_pose(0).position[0] - 1 - exact(viscosity, kUntil));
  }
  EXPECT_NEAR(observed_order(errors[0], errors[1]), 2, 0.3) << errors[0] << " " << errors[1];
}

TEST_P(StepConstants, ChangeWithAnExactAccount) {
  const auto [scheme, viscosity] = GetParam();
  Simulation simulation(oscillator(scheme, viscosity));
  run(simulation, 7);
  for (const double step : {0.003, 0.02, 0.01}) {
    const Energies before = simulation.energies();
    const double account = energy_account(simulation);
    set_step_of_constants(simulation, step);
    EXPECT_NE(simulation.energies().strain, before.strain);
    EXPECT_NEAR(energy_account(simulation), account, 1e-15 * kPush);
    EXPECT_GE(simulation.energies().dissipated, before.dissipated);
  }
}

TEST_P(StepConstants, AreHeededByTheCompanion) {
  const auto [scheme, viscosity] = GetParam();
  Simulation simulation(oscillator(scheme, viscosity));
  simulation.set_step_size(0.0025);  // the constants stay those of 0.01 s, and so does their error
  Companion companion(simulation);
  double estimate = 0, error = 0;
  while (simulation.time() < kUntil) {
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
    error = std::max(error, std::abs(simulation.probe_pose(0).position[0] - 1 - exact(viscosity, simulation.time())));
  }
  EXPECT_NEAR(estimate, error, 0.5 * error);
}

INSTANTIATE_TEST_SUITE_P(Schemes, StepConstants,
                         ::testing::Values(Oscillator{"em", kViscosity}, Oscillator{"em0", kViscosity},
                                           Oscillator{"edmc2", 0}, Oscillator{"edmc2", kViscosity}));

}  // namespace
}  // namespace flexarm::test
