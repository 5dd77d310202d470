/// Tests elements="auto": the number of elements is sufficient for a curved centreline.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "building/beam_mesh.h"
#include "math/pi.h"
#include "reference_cantilever.h"
#include "reference_shooting.h"

namespace flexarm::test {
namespace {

constexpr double kTipAccuracy = 0.01;

/// Largest rotation per element [rad], measured on a line with so many turns that no other rule matters.
double turning_per_element(int order) {
  const double turning = 1e6;
  return turning / automatic_element_count(order, turning);
}

/// A slender arc of radius 1 in the x-y plane, which turns by `angle`.
Cantilever slender_arc(double angle, const Vector3& force) {
  Cantilever cantilever;
  cantilever.pieces = {arc({std::sin(angle), 1 - std::cos(angle), 0}, {0, 1, 0})};
  cantilever.section = section(1e6, 1e6, 1, 1, 1, 1, 1);
  cantilever.force = force;
  return cantilever;
}

/// Error of the tip displacement relative to the displacement: the largest one for small forces along the three axes.
double largest_tip_error(double angle, int elements, int order) {
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Cantilever cantilever = slender_arc(angle, 1e-4 * Vector3::Unit(axis));
    const Vector3 exact =
        shooting_tip(cantilever, stiffness_matrix(std::get<scene::DirectSection>(cantilever.section)), 400).position;
    const Vector3 computed = static_tip(cantilever, elements, order).position;
    largest = std::max(largest, (computed - exact).norm() / (exact - cantilever.tip()).norm());
  }
  return largest;
}

TEST(AutomaticMesh, TurningPerElementKeepsTheTipOfArcsWithinOnePercent) {
  for (int order = 1; order <= 4; ++order) {
    for (int degrees = 90; degrees < 180; degrees += 15) {
      const double angle = degrees * kPi / 180;
      const int elements = static_cast<int>(std::ceil(angle / turning_per_element(order)));
      EXPECT_LT(largest_tip_error(angle, elements, order), kTipAccuracy)
          << "order " << order << ", " << degrees << " degrees";
    }
  }
}

TEST(AutomaticMesh, OneElementLessIsTooFewForTheWorstArc) {
  const double worst = 0.75 * kPi;
  for (int order = 1; order <= 3; ++order) {  // one quartic element is sufficient
    const int elements = static_cast<int>(std::ceil(worst / turning_per_element(order)));
    EXPECT_GT(largest_tip_error(worst, elements - 1, order), kTipAccuracy) << "order " << order;
  }
}

TEST(AutomaticMesh, BothRulesTogether) {
  // Ten turns of a spiral need more elements than the frequencies.
  for (int order = 1; order <= 4; ++order) {
    const double turning = 20 * kPi;
    const int elements = automatic_element_count(order, turning);
    EXPECT_EQ(elements, static_cast<int>(std::ceil(turning / turning_per_element(order) - 1e-3)));
    EXPECT_GT(elements, automatic_element_count(order, 0));
  }
}

}  // namespace
}  // namespace flexarm::test
