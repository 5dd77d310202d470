// Tests by measurement what theory says about interpolations and velocity rules.
#include "bench/dynamic_objectivity.h"
#include "bench/path_dependence.h"
#include "bench/strain_invariance.h"
#include "bench/variant_name.h"

namespace flexarm::bench {
namespace {

/// Round-off of identities with a few dozen products of rotations.
constexpr double kRoundOff = 1e-13;
/// Expressions that are no identity differ by a power of the rotations' size, far more than this.
constexpr double kVisible = 1e-6;

TEST(PathDependence, Table53) {
  for (const RotationUpdate update : {RotationUpdate::Additive, RotationUpdate::Spin})
    for (const Interpolation interpolation :
         {Interpolation::Total, Interpolation::Incremental, Interpolation::Iterative, Interpolation::Local}) {
      const bool is_dependent =
          interpolation == Interpolation::Incremental || interpolation == Interpolation::Iterative;
      const PathDifference difference = path_dependence(interpolation, update).largest();
      const std::string what = std::string(to_string(interpolation)) +
                               (update == RotationUpdate::Additive ? ", additive update" : ", spin update");
      EXPECT_EQ(difference.curvature > kVisible, is_dependent) << what << " " << difference.curvature;
      EXPECT_EQ(difference.rotation > kVisible, is_dependent) << what << " " << difference.rotation;
      if (is_dependent) continue;
      EXPECT_LT(difference.curvature, kRoundOff) << what;
      EXPECT_LT(difference.rotation, kRoundOff) << what;
    }
}

TEST(PathDependence, OnlyTheIterativeInterpolationFeelsIterates) {
  for (const RotationUpdate update : {RotationUpdate::Additive, RotationUpdate::Spin}) {
    const PathDifference incremental = path_dependence(Interpolation::Incremental, update).by_iterates,
                         iterative = path_dependence(Interpolation::Iterative, update).by_iterates;
    EXPECT_LT(incremental.rotation, kRoundOff);
    EXPECT_LT(incremental.curvature, kRoundOff);
    EXPECT_GT(iterative.rotation, kVisible);
    EXPECT_GT(iterative.curvature, kVisible);
  }
}

class EachVariant : public ::testing::TestWithParam<Variant> {};

TEST_P(EachVariant, LoadStepsMatterWherePathsMatter) {
  const Measured<double> difference = static_path_dependence(GetParam());
  ASSERT_FALSE(difference.failure);
  if (GetParam().claims_path_independence())
    EXPECT_LT(difference.value, 1e-10);  // Newton's tolerance is 1e-11, and its last update is squared
  else
    EXPECT_GT(difference.value, kVisible);
}

TEST_P(EachVariant, OnlyLocalRotationsAreInvariant) {
  const double change = strain_change(GetParam());
  if (GetParam().claims_invariance())
    EXPECT_LT(change, kRoundOff);
  else
    EXPECT_GT(change, kVisible);
}

TEST_P(EachVariant, OnlyUnscaledVelocityRulesIgnoreTheSpin) {
  const Measured<SpinDependence> change = spin_dependence(GetParam());
  ASSERT_FALSE(change.failure);
  if (GetParam().claims_spin_independence()) {
    EXPECT_LT(change.value.twist, 1e-10);  // twelve solutions with a tolerance of 1e-11
    EXPECT_LT(change.value.angular_velocity, 1e-10);
  } else if (!GetParam().scheme.is_composition) {
    // The tangent-scaled increment is longer by (omega h)^2 / 12, 2 % here. Five sub-steps have a much smaller effect.
    EXPECT_GT(change.value.twist, 1e-3);
    EXPECT_GT(change.value.angular_velocity, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, EachVariant, ::testing::ValuesIn(variants()), test_name);

}  // namespace
}  // namespace flexarm::bench
