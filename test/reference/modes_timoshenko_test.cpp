/// Tests spectra of Reissner (Timoshenko) beams (case M2): published values and order of convergence.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_cantilever.h"
#include "reference_plane_scene.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

/// omega sqrt(m L^4 / EI) for rotary inertia j / (m L^2) and shear compliance EI / (GA L^2), by Rayleigh-Ritz with
/// Legendre polynomials; all digits are converged.
struct PublishedSpectrum {
  const char* name;
  EndCondition root, tip;
  double rotary_inertia, shear_compliance;
  std::vector<double> omega;
};
std::ostream& operator<<(std::ostream& out, const PublishedSpectrum& s) {
  return out << s.name;
}

const PublishedSpectrum kPublishedSpectra[] = {
    {"clamped_free_slender", kClamped, kFree, 1e-4, 3e-4, {3.5127523751, 21.8930973519, 60.768141754, 117.610507556}},
    {"clamped_free_short", kClamped, kFree, 1e-2, 3e-2, {3.2345869777, 14.5913018183, 31.8350778942, 48.540691485}},
    {"free_free_slender", kFree, kFree, 1e-4, 3e-4, {22.2774588901, 60.9280212693, 118.1055156903, 192.4184278171}},
    {"pinned_pinned_slender",
     kPinned,
     kPinned,
     1e-4,
     3e-4,
     {9.8501943554, 39.1712398787, 87.298893737, 153.2015497533}},
    {"pinned_pinned_short", kPinned, kPinned, 1e-2, 3e-2, {8.4213965310, 25.5743611728, 44.6680712591, 57.735026919}},
};

class TimoshenkoSpectrum : public testing::TestWithParam<PublishedSpectrum> {
 protected:
  PlaneBeam beam() const {
    PlaneBeam beam;
    beam.rotary_inertia = GetParam().rotary_inertia;
    beam.shear_compliance = GetParam().shear_compliance;
    return beam;
  }
  std::vector<double> computed(int elements, int order) const {
    return computed_frequencies(beam(), GetParam().root, GetParam().tip, elements, order, 4);
  }
};

TEST_P(TimoshenkoSpectrum, FrequencyDeterminantReproducesTheTable) {
  const std::vector<double> exact = exact_frequencies(beam(), GetParam().root, GetParam().tip, 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(exact[k], GetParam().omega[k], 1e-9 * exact[k]);
}

TEST_P(TimoshenkoSpectrum, FineMeshReachesTheTable) {
  const std::vector<double> omega = computed(16, 4);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(omega[k], GetParam().omega[k], 1e-7 * omega[k]) << "mode " << k + 1;
}

TEST_P(TimoshenkoSpectrum, ErrorsFallWithOrderTwoP) {
  const int coarsest[] = {0, 32, 12, 8};
  for (int order = 1; order <= 3; ++order) {
    const std::vector<double> coarse = computed(coarsest[order], order), fine = computed(2 * coarsest[order], order);
    int measured = 0;
    for (int k = 0; k < 4; ++k) {
      const double exact = GetParam().omega[k];
      // Near the round-off of the eigenvalue, no order is visible. The pure shear mode of the pinned beam is always
      // exact.
      if (std::abs(coarse[k] - exact) < 1e-7 * exact) continue;
      EXPECT_NEAR(observed_order(coarse[k] - exact, fine[k] - exact), 2 * order, kOrderTolerance)
          << "order " << order << ", mode " << k + 1;
      ++measured;
    }
    EXPECT_GE(measured, 1) << "order " << order;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, TimoshenkoSpectrum, testing::ValuesIn(kPublishedSpectra),
                         [](const auto& info) { return std::string(info.param.name); });

// A short square beam on simple supports in space, against closed forms and Exudyn's published ANCFBeam3DeigTest (256
// linear elements, hence 1e-4). The modes are two bending planes, extension with one free end, torsion between held
// ends, and the second pair of bending modes.
TEST(SpatialTimoshenkoBeam, SimplySupportedSpectrumAsPublished) {
  const double length = 2, width = 0.4, young = 1e9, poisson = 0.3, density = 7850;
  const double shear_modulus = young / (2 * (1 + poisson)), area = width * width, second = std::pow(width, 4) / 12;
  const double ga = 10 * (1 + poisson) / (12 + 11 * poisson) * shear_modulus * area;
  SceneBuilder builder;
  builder.beam("arm", {{length, 0, 0}},
               section(young * area, ga, 0.8436 * shear_modulus * 2 * second, young * second, density * area,
                       density * 2 * second, density * second),
               8, 4);
  builder.body("sledge", kGround, Vector3::Zero(), Vector3(kGround, 1e2, 1e2).asDiagonal());
  auto& root = builder.joint("root", scene::JointKind::Universal, "world", "arm", {0, 0, 0}, Vector3::UnitY());
  root.axis2 = Vector3::UnitZ();
  // The guide at the tip rotates with the beam's torsion, i.e. hardly at all, and leaves the beam's extension free.
  builder.body("cross", 1e-6, Vector3::Zero(), 1e-9 * Matrix3::Identity());
  auto& tip = builder.joint("tip", scene::JointKind::Universal, "arm", "cross", {length, 0, 0}, Vector3::UnitY());
  tip.axis2 = Vector3::UnitZ();
  builder.joint("guide", scene::JointKind::Prismatic, "cross", "sledge", Vector3::Zero(), Vector3::UnitX());
  const std::vector<double> omega = computed_frequencies(builder, 6, 1);

  PlaneBeam plane;
  plane.length = length;
  plane.bending_stiffness = young * second;
  plane.shear_compliance = 1 / ga;
  plane.mass = density * area;
  plane.rotary_inertia = density * second;
  const std::vector<double> bending = exact_frequencies(plane, kPinned, kPinned, 2);
  const double extension = kPi / (2 * length) * std::sqrt(young / density);
  const double torsion = kPi / length * std::sqrt(0.8436 * shear_modulus / density);
  const double exact[] = {bending[0], bending[0], extension, torsion, bending[1], bending[1]};
  const double published[] = {95.635, 95.635, 280.322, 319.347, 332.25, 332.25};
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(omega[k], exact[k], 1e-7 * exact[k]) << "mode " << k + 1;
    EXPECT_NEAR(omega[k], published[k], 1e-4 * published[k]) << "mode " << k + 1;
  }
}

// Deflections of the pinned beam are sines, also with shear and rotary inertia. Their ratio to the rotation follows
// from the frequency: Q' = -omega^2 m w with Q = GA (w' - theta).
TEST(PinnedTimoshenkoBeam, ModesAreSines) {
  PlaneBeam beam;
  beam.rotary_inertia = 1e-3;
  beam.shear_compliance = 3e-3;
  const std::vector<double> exact = exact_frequencies(beam, kPinned, kPinned, 3);
  const Simulation simulation(plane_scene(beam, kPinned, kPinned, 16, 4).scene);
  const std::vector<Mode> modes = simulation.natural_modes(10);
  for (int n = 1; n <= 3; ++n) {
    const auto mode = std::find_if(modes.begin(), modes.end(), [&](const Mode& candidate) {
      return std::abs(2 * kPi * candidate.frequency - exact[n - 1]) < 1e-6 * exact[n - 1];
    });
    ASSERT_NE(mode, modes.end());
    // Amplitudes {w, theta} of {sin k x, cos k x} from k GA (k w - theta) = omega^2 m w, with k = n pi.
    const double k = n * kPi, w = 1, theta = k - exact[n - 1] * exact[n - 1] * beam.shear_compliance / k;
    double scale = 0;  // scale of the mode, from the root's rotation
    std::vector<NodeState> nodes = state_of(simulation).nodes;
    nodes.resize(4 * 16 + 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double x = nodes[i].position.x();
      if (i == 0) scale = mode->node_motion[0][5].real() / theta;
      EXPECT_NEAR(mode->node_motion[i][1].real(), scale * w * std::sin(k * x), 1e-6) << "mode " << n << " at " << x;
      EXPECT_NEAR(mode->node_motion[i][5].real(), scale * theta * std::cos(k * x), 1e-6) << "mode " << n << " at " << x;
    }
  }
}

}  // namespace
}  // namespace flexarm::test
