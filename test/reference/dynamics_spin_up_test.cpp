// Tests the spin-up of a flexible beam (Kane; Simo and Vu-Quoc), reference case D6, without numerical damping.
#include <cstdio>

#include "math/pi.h"
#include "reference/dynamics_runs.h"

namespace flexarm::test {
namespace {

constexpr double kLength = 10, kAxialStiffness = 2.8e7, kMass = 1.2, kSpeed = 6, kRampTime = 15;

SceneBuilder spin_up() {
  SceneBuilder b;
  b.beam("arm", {{kLength, 0, 0}},
         scene::DirectSection{kAxialStiffness, 1e7, 1e7, 1.4e4, 1.4e4, 1.4e4, kMass, 1.2e-3, 6e-4, 6e-4}, 4, 2);
  b.joint("hub", scene::JointKind::Revolute, "world", "arm", Vector3::Zero(), Vector3::UnitZ());
  b.scene.motions.push_back(
      {"hub", TimeFunction::parse("t < 15 ? 6/15*(t^2/2 + (15/(2*_pi))^2*(cos(2*_pi*t/15) - 1)) : 6*t - 45"), {}});
  b.probe("tip", "arm", {kLength, 0, 0});
  return b;
}

/// Position of the tip in the frame that rotates with the hub.
Vector3 tip_in_hub(const Simulation& simulation) {
  const double angle = simulation.position(0);
  return Eigen::AngleAxisd(-angle, Vector3::UnitZ()) * simulation.probe(0).pose.position;
}

/// Integral of the axial strain by the trapezoidal rule between nodes. It is exact for the linear interpolant.
double stretch(const Simulation& simulation) {
  static std::vector<BeamPoint> points;
  points.clear();
  simulation.beam_points(1, 0, points);
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum += 0.5 * (points[i].strain[0] + points[i - 1].strain[0]) * (points[i].arc_length - points[i - 1].arc_length);
  return sum;
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

  const int steady = static_cast<int>(std::lround(10 / step));
  double mean = 0, deflection = 0;
  int n = 0;
  run(simulation, steady, [&] {
    // Weights with the mean 1, which suppress the ends of the interval
    const double window = 1 - std::cos(2 * kPi * ++n / steady);
    mean += window * stretch(simulation) / steady;
    deflection = std::max(deflection, std::abs(tip_in_hub(simulation).y()));
  });
  // Radial equilibrium: EA u'' + m W^2 (x + u) = 0. A steady rotation by W h per step has chords instead of arcs: the
  // scheme's equilibrium is exactly that of the speed 2 tan(W h / 2) / h.
  const double speed = 2 * std::tan(0.5 * kSpeed * step) / step;
  const double k = std::sqrt(kMass * speed * speed / kAxialStiffness);
  const double expected = std::tan(k * kLength) / k - kLength;
  std::printf("step %g: lag %.4f at %.2f s, residual deflection %.4f, stretch off by %.1e of %.6e\n", step, lag,
              lag_time, deflection, mean - expected, expected);
  EXPECT_LT(deflection, 0.01 + 20 * step * step) << "returns to zero but for the step's second-order error";
  const double vibration = deflection * 1.2 * kSpeed;  // speed of the residual vibration, at about its frequency
  EXPECT_NEAR(mean, expected, (1e-5 + std::pow(vibration / (kSpeed * kLength), 2)) * expected);
}
INSTANTIATE_TEST_SUITE_P(Steps, SpinUp, ::testing::Values(0.05, 0.01, 0.005));

}  // namespace
}  // namespace flexarm::test
