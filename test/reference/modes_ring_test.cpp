/// Tests frequencies of a thin circular ring, one link whose ends are connected, against closed forms of inextensible
/// bending.

#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_cantilever.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// EI / (EA R^2), EI / (GA R^2), and rotary inertia over m R^2.
constexpr double kThinness = 1e-6;
constexpr double kTorsionStiffness = 0.5;  ///< GJ [N m^2]

/// A ring with radius 1 m, EI = 1 N m^2, 1 kg/m, in the x-y plane. Its end is connected to its beginning.
SceneBuilder ring(scene::JointKind seam = scene::JointKind::Fixed) {
  SceneBuilder b;
  const double stiff = 1 / kThinness;
  const scene::DirectSection thin = section(stiff, stiff, kTorsionStiffness, 1, 1, 2 * kThinness, kThinness);
  scene::BeamDescription& beam = b.beam("ring", {}, thin, 16, 4);
  const Vector3 centre(-1, 0, 0);
  beam.centreline = {arc({-1, 1, 0}, centre), arc({-2, 0, 0}, centre), arc({-1, -1, 0}, centre),
                     arc({0, 0, 0}, centre)};
  scene::JointDescription joint;
  joint.name = "seam";
  joint.kind = seam;
  joint.parent = joint.child = "ring";
  joint.axis = Vector3::UnitZ();
  b.scene.loop_joints.push_back(joint);
  return b;
}

/// Circular frequency of bending with n waves. `coupling` is 1 in the plane, and EI / GJ out of it.
double frequency(double n, double coupling) {
  return n * (n * n - 1) / std::sqrt(n * n + coupling);
}

// Each frequency occurs twice. Extension, shear and rotary inertia change it by about n^2 kThinness.
TEST(Ring, FrequenciesInAndOutOfItsPlane) {
  SceneBuilder b = ring();
  b.joint("free", scene::JointKind::Floating, "world", "ring");
  const std::vector<Mode> modes = Simulation(b.scene).natural_modes(18);
  ASSERT_EQ(modes.size(), 18u);
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(modes[k].is_free()) << k;
  for (int k = 6; k < 18; ++k) {
    const int n = 2 + (k - 6) / 4;
    const double expected = frequency(n, (k - 6) % 4 < 2 ? 1 / kTorsionStiffness : 1);
    EXPECT_NEAR(2 * kPi * modes[k].frequency, expected, 4 * n * n * kThinness * expected) << k;
    EXPECT_EQ(modes[k].rate, 0) << k;
  }
}

TEST(Ring, HeldAtTheSeam) {
  SceneBuilder b = ring();
  b.joint("clamp", scene::JointKind::Fixed, "world", "ring");
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  for (const Mode& mode : simulation.natural_modes(6)) EXPECT_GT(mode.frequency, 0);
}

// A hinge at the seam makes the ring softer.
TEST(Ring, HingedAtTheSeam) {
  SceneBuilder b = ring(scene::JointKind::Continuous);
  b.joint("free", scene::JointKind::Floating, "world", "ring");
  const Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.find_coordinate("seam"));
  const std::vector<Mode> modes = simulation.natural_modes(7);
  EXPECT_TRUE(modes[5].is_free());
  EXPECT_GT(modes[6].frequency, 0);
  EXPECT_LT(2 * kPi * modes[6].frequency, 0.95 * frequency(2, 1 / kTorsionStiffness));
}

}  // namespace
}  // namespace flexarm::test
