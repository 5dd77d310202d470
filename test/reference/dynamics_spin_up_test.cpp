// Spin-up of a flexible beam (Kane; Simo and Vu-Quoc), reference case D6, without numerical damping.
#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

constexpr double kLength = 10, kAxial = 2.8e7, kMass = 1.2, kSpeed = 6, kRampTime = 15;

SceneBuilder spin_up() {
  SceneBuilder b;
  b.beam("arm", {{kLength, 0, 0}},
         scene::DirectSection{kAxial, 1e7, 1e7, 1.4e4, 1.4e4, 1.4e4, kMass, 1.2e-3, 6e-4, 6e-4}, 4, 2);
  b.joint("hub", scene::JointKind::Revolute, "world", "arm", Vector3::Zero(), Vector3::UnitZ());
  b.scene.motions.push_back(
      {"hub", TimeFunction::parse("t < 15 ? 6/15*(t^2/2 + (15/(2*_pi))^2*(cos(2*_pi*t/15) - 1)) : 6*t - 45"), {}});
  b.probe("tip", "arm", {kLength, 0, 0});
  return b;
}

/// Position of the tip in the frame that turns with the hub.
Vector3 tip_in_hub(const Simulation& simulation) {
  const double angle = simulation.position(0);
  return Eigen::AngleAxisd(-angle, Vector3::UnitZ()) * simulation.probe(0).pose.position;
}

class SpinUp : public ::testing::TestWithParam<double> {};

TEST_P(SpinUp, CompletesAndKeepsTheSteadyStretch) {
  const double step = GetParam();
  Simulation simulation(spin_up().scene, options("em", step));
  double lag = 0, lag_time = 0;
  run(simulation, static_cast<int>(std::lround(kRampTime / step)), [&] {
    const double y = tip_in_hub(simulation).y();
    if (-y > lag) lag = -y, lag_time = simulation.time();
  });
  EXPECT_GT(lag, 0.5);
  EXPECT_NEAR(lag_time, 7, 1) << "the tip lags most while the hub accelerates most";

  const int steady = static_cast<int>(std::lround(5 / step));
  double mean = 0, deflection = 0;
  run(simulation, steady, [&] {
    mean += (tip_in_hub(simulation).x() - kLength) / steady;
    deflection = std::max(deflection, std::abs(tip_in_hub(simulation).y()));
  });
  // Radial equilibrium EA u'' + m W^2 (x + u) = 0; the residual lateral vibration of amplitude a shortens the tip by
  // about a^2 / L.
  const double k = std::sqrt(kMass * kSpeed * kSpeed / kAxial);
  const double stretch = std::tan(k * kLength) / k - kLength;
  EXPECT_LT(deflection, 0.01) << "the deflection returns to zero";
  EXPECT_NEAR(mean, stretch, 1e-5 * stretch + 2 * deflection * deflection / kLength);
}
INSTANTIATE_TEST_SUITE_P(Steps, SpinUp, ::testing::Values(0.05, 0.01, 0.005));

}  // namespace
}  // namespace flexarm::test
