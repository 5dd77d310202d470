/// Tests the frequency determinant that serves as a reference here, against published roots and closed forms.

#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "reference_spectrum.h"

namespace flexarm::test {
namespace {

TEST(ExactSpectrum, RootsOfBernoullisBeam) {
  struct Case {
    EndCondition root, tip;
    std::vector<double> beta;
  };
  const Case cases[] = {
      {kClamped, kFree, {1.87510406871, 4.69409113297, 7.85475743824, 10.99554073488, 14.13716839105}},
      {kFree, kFree, {4.73004074486, 7.85320462410, 10.99560783800, 14.13716549126, 17.27875965740}},
      {kClamped, kClamped, {4.73004074486, 7.85320462410, 10.99560783800, 14.13716549126, 17.27875965740}},
      {kPinned, kFree, {3.92660231205, 7.06858274563, 10.21017612281, 13.35176877775, 16.49336143135}},
      {kPinned, kPinned, {kPi, 2 * kPi, 3 * kPi, 4 * kPi, 5 * kPi}},
  };
  for (const Case& c : cases) {
    const std::vector<double> omega = exact_frequencies({}, c.root, c.tip, 5);
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(std::sqrt(omega[k]), c.beta[k], 1e-11);  // number of digits in the table
  }
}

TEST(ExactSpectrum, HubAndTipMassInTheirLimits) {
  // A heavy hub acts as a clamp at a pinned root, a heavy tip mass as a pin at a free end. A light beam with a tip mass
  // is a spring, 3 EI / L^3.
  const EndCondition heavy_hub{false, true, 0, 1e12}, heavy_tip{true, true, 1e12, 0};
  EXPECT_NEAR(exact_frequencies({}, heavy_hub, kFree, 1)[0], exact_frequencies({}, kClamped, kFree, 1)[0], 1e-10);
  EXPECT_NEAR(exact_frequencies({}, kClamped, heavy_tip, 1)[0], exact_frequencies({}, kClamped, kPinned, 1)[0], 1e-10);
  PlaneBeam light;
  light.mass = 1e-4;  // Rayleigh's 33/140 of it moves with the tip, with an error of the square of the mass
  EXPECT_NEAR(exact_frequencies(light, kClamped, {true, true, 1, 0}, 1)[0], std::sqrt(3 / (1 + 33e-4 / 140)), 1e-8);
}

TEST(ExactSpectrum, PinnedTimoshenkoBeamUnderTension) {
  // The modes are sines. With k = n pi / L, the two fields decouple into a quadratic equation for omega^2; without
  // shear it is linear.
  PlaneBeam beam;
  beam.axial_force = 7;
  for (int n = 1; n <= 4; ++n) {
    const double k = n * kPi;
    EXPECT_NEAR(exact_frequencies(beam, kPinned, kPinned, 4)[n - 1], std::sqrt(k * k * k * k + 7 * k * k), 1e-9);
  }
  beam.axial_force = 0;
  beam.rotary_inertia = 1e-2;
  beam.shear_compliance = 3e-2;
  const std::vector<double> omega = exact_frequencies(beam, kPinned, kPinned, 3);
  for (int n = 1; n <= 3; ++n) {
    const double k2 = n * n * kPi * kPi, a = 1e-2 * 3e-2, b = 1 + k2 * (1e-2 + 3e-2);
    EXPECT_NEAR(omega[n - 1], std::sqrt((b - std::sqrt(b * b - 4 * a * k2 * k2)) / (2 * a)), 1e-10);
  }
}

TEST(ExactSpectrum, CriticalForceOfAColumn) {
  PlaneBeam column;
  column.axial_force = -kPi * kPi / 4;
  EXPECT_NEAR(static_cast<double>(frequency_determinant(column, kClamped, kFree, 0)), 0, 1e-14);
}

}  // namespace
}  // namespace flexarm::test
