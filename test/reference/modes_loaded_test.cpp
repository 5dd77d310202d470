/// Tests natural modes about a loaded equilibrium: tension, and the critical loads of a column and of a right-angle
/// frame (case S9).

#include <array>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_plane_scene.h"

namespace flexarm::test {
namespace {

/// omega^2 of the lowest mode about the equilibrium; negative if the mode grows.
double lowest_square(const SceneBuilder& builder) {
  Simulation simulation(builder.scene);
  if (!simulation.solve_static(1, Equilibrium::UnderTheLoads).converged) throw std::runtime_error("no equilibrium");
  const Mode mode = simulation.natural_modes(3).front();
  return std::pow(2 * kPi * mode.frequency, 2) - std::pow(mode.rate, 2);
}

/// The critical load of scene(load), at which omega^2 of the lowest mode changes sign. First bisection to one per cent
/// of the load, then the root of the cubic polynomial through four loads around it. Closer to the critical load,
/// round-off dominates the sign.
template <class Scene>
double critical_load(const Scene& scene, double below, double above) {
  EXPECT_GT(lowest_square(scene(below)), 0);
  EXPECT_LT(lowest_square(scene(above)), 0);
  while (above - below > 0.01 * below) {
    const double middle = 0.5 * (below + above);
    (lowest_square(scene(middle)) < 0 ? above : below) = middle;
  }
  // The load as a cubic polynomial of omega^2 (Lagrange), evaluated at zero.
  std::array<double, 4> loads, squares;
  for (int k = 0; k < 4; ++k) squares[k] = lowest_square(scene(loads[k] = below + (k - 1) * (above - below)));
  double root = 0;
  for (int i = 0; i < 4; ++i) {
    double weight = 1;
    for (int k = 0; k < 4; ++k)
      if (k != i) weight *= squares[k] / (squares[k] - squares[i]);
    root += weight * loads[i];
  }
  return root;
}

// From a beam to a string: the tension is up to thirty times the bending stiffness over the length squared.
TEST(TensionedBeam, FrequenciesAgreeWithTheFrequencyEquation) {
  PlaneBeam beam;
  beam.rotary_inertia = 1e-4;
  beam.shear_compliance = 3e-4;
  beam.axial_compliance = 1e-5;
  double last = 0;
  for (const double force : {-2.0, 0.0, 5.0, 50.0, 500.0}) {
    beam.axial_force = force;
    const std::vector<double> omega = computed_frequencies(beam, kClamped, kFree, 16, 4, 3);
    const std::vector<double> exact = exact_frequencies(beam, kClamped, kFree, 3);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(omega[k], exact[k], 1e-7 * exact[k]) << "force " << force << ", mode " << k + 1;
    EXPECT_GT(omega[0], last);
    last = omega[0];
  }
}

TEST(Column, LowestFrequencyVanishesAtEulersLoad) {
  PlaneBeam column;
  column.length = 8;
  column.rotary_inertia = column.shear_compliance = column.axial_compliance = 1e-6;
  const auto scene = [&](double load) {
    column.axial_force = -load;
    return plane_scene(column, kClamped, kFree, 4, 4);
  };
  const double euler = kPi * kPi / (4 * 64);
  EXPECT_NEAR(critical_load(scene, 0.9 * euler, 1.1 * euler), euler, 1e-7 * euler);
}

/// Two legs of 0.24 m, 30 mm wide in the frame's plane and 0.6 mm thick. The force at the free end acts along the
/// clamped leg.
SceneBuilder frame(double force) {
  const double length = 0.24, width = 30e-3, thickness = 0.6e-3, young = 7.124e10, shear = young / (2 * 1.31);
  const double area = width * thickness;
  scene::DirectSection s = section(young * area, shear * area, shear * width * std::pow(thickness, 3) / 3,
                                   young * width * std::pow(thickness, 3) / 12, 1, 1e-3, 1e-3);
  s.ei3 = young * thickness * std::pow(width, 3) / 12;
  SceneBuilder builder;
  builder.beam("frame", {{length, 0, 0}, {length, length, 0}}, s, 8, 4);
  builder.joint("clamp", scene::JointKind::Fixed, "world", "frame");
  builder.load("frame", {length, length, 0}, {force, 0, 0});
  builder.scene.integrator.tolerance = 1e-10;
  return builder;
}

/// Mesh-free critical loads: the out-of-plane equations on the exact plane path lose uniqueness there.
TEST(RightAngleFrame, CriticalLoads) {
  const double away = critical_load([](double load) { return frame(load); }, 1.0, 1.2);
  const double towards = critical_load([](double load) { return frame(-load); }, 0.6, 0.75);
  EXPECT_NEAR(away, 1.0875180, 1e-5 * away);
  EXPECT_NEAR(towards, 0.6804274, 1e-5 * towards);
  EXPECT_NEAR(away, 1.088, 1e-2 * away);  // Simo and Vu-Quoc
}

}  // namespace
}  // namespace flexarm::test
