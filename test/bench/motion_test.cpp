// Tests the claims of schemes on the scenes of the properties report.
#include "bench/conservation.h"
#include "bench/dissipation.h"
#include "bench/order.h"
#include "bench/time_symmetry.h"
#include "bench/variant_name.h"

namespace flexarm::bench {
namespace {

// ---------------------------------------------------------------- all variants

class FreeFlight : public ::testing::TestWithParam<Variant> {};

TEST_P(FreeFlight, KeepsWhatTheSchemeClaims) {
  const Scheme& scheme = GetParam().scheme;
  const Measured<InvariantDrift> drift = invariant_drift(GetParam(), true);
  ASSERT_FALSE(drift.failure);
  // 100 steps, each with an error of Newton's method of about 1e-15 times a condition number.
  const double kept = 1e-10;
  if (scheme.conserves_momenta) {
    EXPECT_LT(drift.value.linear_momentum, kept);
    EXPECT_LT(drift.value.angular_momentum, kept);
  }
  if (scheme.conserves_energy) {
    EXPECT_LT(drift.value.energy, kept);
  }
  if (scheme.dissipation.any()) {
    EXPECT_LT(drift.value.growth, kept);
  }
  // The measurement detects an error: a scheme that does not claim conservation must not conserve.
  if (!scheme.conserves_energy) {
    EXPECT_GT(drift.value.energy, kept);
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, FreeFlight, ::testing::ValuesIn(variants()), test_name);

// ---------------------------------------------------------------- schemes with default options

class EachScheme : public ::testing::TestWithParam<Variant> {};

TEST_P(EachScheme, OrderOnATreeWithJoints) {
  const Measured<OrderInTime> order = order_in_time(GetParam(), false);
  ASSERT_FALSE(order.failure) << to_string(order.failure->reason) << " at t = " << order.failure->time;
  EXPECT_NEAR(order.value.slope, GetParam().scheme.order, 0.1);
}

TEST_P(EachScheme, ReversibleIfSymmetric) {
  const std::optional<Measured<double>> distance = time_asymmetry(GetParam(), false);
  ASSERT_EQ(distance.has_value(), !GetParam().scheme.dissipation.any());
  if (!distance) return;
  ASSERT_FALSE(distance->failure);
  if (GetParam().claims_time_symmetry()) {
    EXPECT_LT(distance->value, 1e-10);
  }
  if (GetParam().scheme.alpha < 0 || GetParam().scheme.backward_velocity) {
    EXPECT_GT(distance->value, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, EachScheme, ::testing::ValuesIn(default_variants()), test_name);

// ---------------------------------------------------------------- the linear oscillator

Variant scheme_named(const std::string& name) {
  for (const Variant& variant : default_variants())
    if (variant.name() == name) return variant;
  throw std::invalid_argument(name);
}

TEST(Oscillator, LosesNothingWhereEnergyIsConserved) {
  for (const Variant& variant : default_variants()) {
    const Scheme& scheme = variant.scheme;
    if (scheme.dissipation.any() || scheme.backward_velocity || scheme.alpha < 0) continue;
    for (const double frequency : {0.1, 2.0, 50.0}) {
      const Measured<DissipationPoint> decay = dissipation(variant, frequency, false);
      ASSERT_FALSE(decay.failure) << variant.name();
      EXPECT_NEAR(decay.value.spectral_radius, 1, 1e-10) << variant.name() << " " << frequency;
    }
  }
}

TEST(Oscillator, BackwardVelocityHasItsSpectralRadius) {
  // The characteristic polynomial is (1 + a/2) z^2 - (2 - a/2) z + 1 with a = (omega h)^2. Its roots are complex below
  // a = 12 + 8 sqrt(2). A slope over n samples is off by up to 6/n^2 times a bounded oscillation about it; here n > 25
  // before round-off.
  for (const double frequency : {0.3, 1.0, 2.0})
    EXPECT_NEAR(dissipation(scheme_named("m2"), frequency, false).value.spectral_radius,
                1 / std::sqrt(1 + 0.5 * frequency * frequency), 0.01)
        << frequency;
}

TEST(Oscillator, HighFrequenciesDecayByTheRadiusAskedFor) {
  // For HHT, rho = (1 + alpha) / (1 - alpha). With multiple roots, the measured slope approaches its limit slowly.
  for (const char* name : {"hht1", "hht2", "hht3"})
    EXPECT_NEAR(dissipation(scheme_named(name), 1000, false).value.spectral_radius, 0.95 / 1.05, 0.02) << name;
  for (const char* name : {"edmc1", "edmc2"})
    EXPECT_NEAR(dissipation(scheme_named(name), 1000, false).value.spectral_radius, 0.8, 0.05) << name;
}

}  // namespace
}  // namespace flexarm::bench
