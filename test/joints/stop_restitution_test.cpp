// Tests the damping that gives a stop its restitution, against the closed form.
#include "joints/stop_restitution.h"

#include <cmath>

#include <gtest/gtest.h>

#include "model/model.h"

namespace flexarm::test {
namespace {

/// Closed form of the restitution of a contact that never pulls (docs/notes/stops.md).
double restitution(double z) {
  return std::exp(-2 * z * std::acos(z) / std::sqrt(1 - z * z));
}

TEST(StopRestitution, IsThatOfTheClosedForm) {
  for (const double e : {0.15, 0.3, 0.5, 0.8, 0.95}) EXPECT_NEAR(restitution(stop_damping_ratio(e)), e, 1e-9) << e;
}

// The default constant is rounded to six digits.
TEST(StopRestitution, OfStopsWithoutOneIsThreeTenths) {
  EXPECT_NEAR(stop_damping_ratio(0.3), LimitStop{}.damping_ratio, 1e-6);
}

TEST(StopRestitution, OfOneTakesNoDamper) {
  EXPECT_NEAR(stop_damping_ratio(1), 0, 1e-8);
}

TEST(StopRestitution, OfStrongDampers) {
  EXPECT_EQ(stop_damping_ratio(0), stop_damping_ratio(0.05)) << "the most damped hit";
  const double found = stop_damping_ratio(0.05);
  EXPECT_GT(found, 1);
  EXPECT_LT(found, 5);
}

}  // namespace
}  // namespace flexarm::test
