/// Tests Beck's column: clamped, under a compressive force P that follows the tip, with internal damping. It is
/// compared with its transcendental equation.

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

using Complex = std::complex<double>;

/// The eigenvalue lambda near `guess` of EI (1 + eta lambda) w,xxxx + P w,xx + m lambda^2 w = 0, with w = w,x = 0 at
/// the root and w,xx = w,xxx = 0 at the tip; EI = m = L = 1.
Complex exact_eigenvalue(double load, double eta, Complex guess) {
  const auto determinant = [&](Complex lambda) {
    const Complex stiffness = 1.0 + eta * lambda, half = load / (2.0 * stiffness);
    const Complex root = std::sqrt(half * half - lambda * lambda / stiffness);
    const Complex a = std::sqrt(root - half), b = std::sqrt(root + half);
    // The solution is w = A (cosh ax - cos bx) + B (sinh(ax)/a - sin(bx)/b).
    const Complex moment = a * a * std::cosh(a) + b * b * std::cos(b);
    return moment * moment -
           (a * std::sinh(a) + b * std::sin(b)) * (a * a * a * std::sinh(a) - b * b * b * std::sin(b));
  };
  Complex last = guess * (1 + 1e-4), lambda = guess;  // the secant method
  for (int k = 0; k < 50 && std::abs(lambda - last) > 1e-14 * std::abs(lambda); ++k) {
    const Complex value = determinant(lambda), before = determinant(last);
    if (value == before) break;
    last = lambda - value * (lambda - last) / (value - before);
    std::swap(last, lambda);
  }
  return lambda;
}

/// The column bends in the x-y plane; it is far stiffer out of it. `slenderness`: EI over GA L^2 and EA L^2, and rotary
/// inertia over m L^2.
SceneBuilder column(double load, double eta, double slenderness) {
  SceneBuilder b;
  scene::DirectSection s = section(1 / slenderness, 1 / slenderness, 1e4, 1, 1, 2 * slenderness, slenderness);
  s.ei2 = 1e4;
  s.ga3 = 1e4 / slenderness;
  b.beam("column", {{1, 0, 0}}, s, 8, 4).stiffness_proportional_damping = eta;
  b.joint("clamp", scene::JointKind::Fixed, "world", "column");
  b.load("column", {1, 0, 0}, {-load, 0, 0}, Vector3::Zero(), "1", scene::LoadFrame::Follower);
  b.scene.integrator.tolerance = 1e-12;
  return b;
}

std::vector<Mode> modes_of(const SceneBuilder& scene, int count) {
  Simulation simulation(scene.scene);
  EXPECT_TRUE(simulation.solve_static(1, Equilibrium::UnderTheLoads).converged);
  return simulation.natural_modes(count);
}

Complex eigenvalue(const Mode& mode) {
  return {mode.rate, 2 * kPi * mode.frequency};
}

/// Shortening and shear change the effective load by about P / GA of itself. Rotary inertia and shear change the
/// frequency by about omega / sqrt(GA ...) of itself. The factors are of order one.
double effect_of_slenderness(double load, double eta, double slenderness, Complex exact) {
  return std::abs(exact_eigenvalue(load * (1 + 4 * load * slenderness), eta, exact) - exact) +
         4 * std::norm(exact) * slenderness;
}

TEST(BecksColumn, FluttersBeyondItsCriticalLoad) {
  const Complex exact = exact_eigenvalue(21, 0, {2, 11});
  // The values come from an independent program.
  EXPECT_NEAR(exact.imag() / (2 * kPi), 1.7407335652915, 1e-12);
  EXPECT_NEAR(exact.real(), 2.124940618498, 1e-11);
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const double slenderness = k == 0 ? 1e-5 : 1e-6;
    const std::vector<Mode> modes = modes_of(column(21, 0, slenderness), 3);
    EXPECT_TRUE(modes[0].is_flutter());
    EXPECT_LT(modes[0].damping_ratio(), 0);
    errors[k] = std::abs(eigenvalue(modes[0]) - exact);
    EXPECT_LT(errors[k], effect_of_slenderness(21, 0, slenderness, exact));
    // The partner mode decays at the same rate. The other modes neither grow nor decay.
    EXPECT_NEAR(modes[1].rate, -modes[0].rate, 1e-6 * modes[0].rate);
    EXPECT_NEAR(modes[1].frequency, modes[0].frequency, 1e-6 * modes[0].frequency);
    EXPECT_EQ(modes[2].rate, 0);
  }
  EXPECT_NEAR(errors[0] / errors[1], 10, 1) << "linear in the slenderness";
}

TEST(BecksColumn, OscillatesBelowIt) {
  const std::vector<Mode> modes = modes_of(column(19, 0, 1e-6), 2);
  for (const Mode& mode : modes) {
    EXPECT_EQ(mode.rate, 0);
    const Complex exact = exact_eigenvalue(19, 0, eigenvalue(mode));
    EXPECT_LT(std::abs(eigenvalue(mode) - exact), effect_of_slenderness(19, 0, 1e-6, exact));
  }
  EXPECT_GT(modes[1].frequency, 1.1 * modes[0].frequency);
}

// Ziegler's paradox: any internal damping lowers the critical load from 20.05 to 10.94.
TEST(BecksColumn, InternalDampingDestabilises) {
  const double eta = 1e-3;
  for (const double load : {10.0, 12.0, 18.0}) {
    const std::vector<Mode> modes = modes_of(column(load, eta, 1e-6), 2);
    EXPECT_EQ(modes[0].is_flutter(), load > 10.94) << load;
    for (const Mode& mode : modes) {
      const Complex exact = exact_eigenvalue(load, eta, eigenvalue(mode));
      EXPECT_LT(std::abs(eigenvalue(mode) - exact), effect_of_slenderness(load, eta, 1e-6, exact)) << load;
    }
  }
}

// A dead load has a potential: the column buckles and does not flutter.
TEST(DeadLoad, Diverges) {
  SceneBuilder b = column(3, 0, 1e-6);  // Euler's load is pi^2 / 4
  b.scene.loads.back().frame = scene::LoadFrame::World;
  const std::vector<Mode> modes = modes_of(b, 3);
  EXPECT_TRUE(modes[0].is_divergence());
  for (int k = 1; k < 3; ++k) EXPECT_EQ(modes[k].rate, 0);
}

}  // namespace
}  // namespace flexarm::test
