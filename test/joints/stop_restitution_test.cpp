// Tests the damping that gives a stop its restitution, against the closed form.
#include "joints/stop_restitution.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flexarm::test {
namespace {

/// Closed form of the restitution of a contact that never pulls (docs/notes/stops.md).
double restitution(double z) {
  return std::exp(-2 * z * std::acos(z) / std::sqrt(1 - z * z));
}

TEST(StopRestitution, IsThatOfTheClosedForm) {
  for (const double e : {0.15, 0.3, 0.5, 0.8, 0.95}) EXPECT_NEAR(restitution(damping_for(e).of_means), e, 1e-9) << e;
}

// The default constants are rounded to six digits.
TEST(StopRestitution, OfStopsWithoutOneIsThreeTenths) {
  const StopDamping usual, found = damping_for(0.3);
  EXPECT_NEAR(found.of_means, usual.of_means, 1e-6);
  EXPECT_NEAR(found.at_end, usual.at_end, 1e-6);
}

TEST(StopRestitution, OfOneTakesNoDamper) {
  EXPECT_NEAR(damping_for(1).of_means, 0, 1e-8);
  EXPECT_NEAR(damping_for(1).at_end, 0, 1e-8);
}

TEST(StopRestitution, OfStrongDampers) {
  const StopDamping found = damping_for(0.05);
  EXPECT_GT(found.of_means, 1);
  EXPECT_LT(found.of_means, 5);
}

}  // namespace
}  // namespace flexarm::test
