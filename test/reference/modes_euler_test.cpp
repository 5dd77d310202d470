/// Tests bending frequencies of slender beams (case M1), with hub inertia and tip mass, against frequency equations.

#include <cmath>

#include <gtest/gtest.h>

#include "reference_cantilever.h"
#include "reference_plane_scene.h"

namespace flexarm::test {
namespace {

/// Slenderness: shear and rotary inertia lower the frequency by about (beta L)^2 (r2 + s2) / 2.
constexpr double kSlenderness = 1e-6;

PlaneBeam slender() {
  PlaneBeam beam;
  beam.rotary_inertia = beam.shear_compliance = kSlenderness;
  return beam;
}

struct Ends {
  const char* name;
  EndCondition root, tip;
};
std::ostream& operator<<(std::ostream& out, const Ends& ends) {
  return out << ends.name;
}

class SlenderBeam : public testing::TestWithParam<Ends> {};

// Compares with Timoshenko's frequency equation of the same beam, to the round-off of the eigenvalue. Compares with
// Bernoulli's equation within the effects of shear and rotary inertia.
TEST_P(SlenderBeam, FrequenciesAgreeWithTheFrequencyEquation) {
  const auto [name, root, tip] = GetParam();
  const std::vector<double> omega = computed_frequencies(slender(), root, tip, 16, 4, 4);
  const std::vector<double> timoshenko = exact_frequencies(slender(), root, tip, 4);
  const std::vector<double> bernoulli = exact_frequencies({}, root, tip, 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(omega[k], timoshenko[k], 1e-7 * omega[k]) << "mode " << k + 1;
    EXPECT_NEAR(omega[k], bernoulli[k], 4 * kSlenderness * bernoulli[k] * bernoulli[k]) << "mode " << k + 1;
  }
}

TEST_P(SlenderBeam, SecondFrequencyConvergesWithOrderTwoP) {
  const auto [name, root, tip] = GetParam();
  const std::vector<double> exact = exact_frequencies(slender(), root, tip, 2);
  const int coarsest[] = {0, 16, 8, 4};
  for (int order = 1; order <= 3; ++order) {
    double errors[2];
    for (int k = 0; k < 2; ++k)
      errors[k] = std::abs(computed_frequencies(slender(), root, tip, coarsest[order] << k, order, 2)[1] - exact[1]);
    EXPECT_NEAR(observed_order(errors[0], errors[1]), 2 * order, kOrderTolerance) << "order " << order;
  }
}

const Ends kEnds[] = {
    {"clamped_free", kClamped, kFree},
    {"pinned_free", kPinned, kFree},
    {"free_free", kFree, kFree},
    {"pinned_pinned", kPinned, kPinned},
    {"clamped_pinned", kClamped, kPinned},
    {"hub_inertia", {false, true, 0, 0.3}, kFree},
    {"large_hub_inertia", {false, true, 0, 20}, kFree},
    {"tip_mass", kClamped, {true, true, 0.5, 0}},
    {"tip_body", kClamped, {true, true, 2, 0.1}},
    {"hub_inertia_and_tip_body", {false, true, 0, 0.3}, {true, true, 2, 0.1}},
};
INSTANTIATE_TEST_SUITE_P(Ends, SlenderBeam, testing::ValuesIn(kEnds),
                         [](const auto& info) { return std::string(info.param.name); });

// ---------------------------------------------------------------- rigid motions

int rigid_motions(const SceneBuilder& builder, int count) {
  Simulation simulation(builder.scene);
  int rigid = 0;
  for (const Mode& mode : simulation.natural_modes(count)) rigid += mode.is_free();
  return rigid;
}

TEST(RigidMotions, AreCountedAndExactlyZero) {
  const PlaneBeam beam = slender();
  for (int order = 1; order <= 4; ++order) {
    for (const int elements : {4, 16}) {
      EXPECT_EQ(rigid_motions(plane_scene(beam, kClamped, kFree, elements, order), 12), 0);
      EXPECT_EQ(rigid_motions(plane_scene(beam, kPinned, kFree, elements, order), 12), 1);
      EXPECT_EQ(rigid_motions(plane_scene(beam, kFree, kFree, elements, order), 12), 6);
    }
  }
}

// Two floating beams on a spherical joint have six rigid motions as a whole, and three relative to each other.
TEST(RigidMotions, OfAMechanism) {
  SceneBuilder builder = plane_scene(slender(), kFree, kFree, 4, 2);
  const scene::Section same = builder.scene.links.back().beam->section;
  builder.beam("second", {{1, 0, 0}}, same, 4, 2);
  builder.joint("ball", scene::JointKind::Spherical, "arm", "second", {1, 0, 0});
  EXPECT_EQ(rigid_motions(builder, 16), 9);
}

// The beam is aligned with no axis, and its section couples all strains. The energy of a rigid motion is only
// round-off.
TEST(RigidMotions, OfACurvedBeamInAGeneralPosition) {
  for (int order = 1; order <= 4; ++order) {
    for (const int elements : {3, 12, 40}) {
      SceneBuilder builder = plane_scene(slender(), kFree, kFree, elements, order);
      scene::BeamDescription& beam = *builder.scene.links.back().beam;
      beam.centreline = {line({0.3, 0.4, -0.2}), arc({0.3 + 0.5, 0.4 + 0.5, -0.2}, {0.3, 0.4 + 0.5, -0.2}, 0.7)};
      builder.scene.joints.back().origin = {{5, -3, 2}, Quaternion(0.5, -0.1, 0.7, 0.3).normalized()};
      EXPECT_EQ(rigid_motions(builder, 12), 6) << "order " << order << ", elements " << elements;
    }
  }
}

}  // namespace
}  // namespace flexarm::test
