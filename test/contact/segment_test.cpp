// Tests the nearest point of a segment against a search over all of its points.
#include "contact/segment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "math/so3.h"
#include "support/polytopes.h"

namespace flexarm::test {
namespace {

std::vector<ContactShape> convex_shapes() {
  const Pose place{{0.1, -0.2, 0.3}, so3::exp_quaternion(Vector3(0.3, -0.5, 0.7))};
  return {{HalfSpace{}, place},
          {Ball{0.4}, place},
          {Box{{0.3, 0.5, 0.2}}, place},
          {Cylinder{0.3, 0.5}, place},
          {Hull{std::make_shared<Polytope>(roof_polytope({0.3, 0.4, 0.2}, 0.15))}, place}};
}

class Segments : public ::testing::Test {
 protected:
  double number() { return number_(generator_); }
  Vector3 vector() { return {number(), number(), number()}; }
  Segment segment(double curvature) { return {vector(), vector().normalized(), 0.8, curvature}; }
  /// Distance of a point of the segment, plus the rise there [m].
  static double height(const Segment& segment, const ContactShape& shape, double along) {
    return shape.distance(segment.at(along)).value + 0.5 * segment.curvature * along * along;
  }

 private:
  std::mt19937 generator_{1};
  std::uniform_real_distribution<double> number_{-1, 1};
};

// The search by thirds ends with an interval of 1e-12, in which the distance is above its minimum by at most the
// interval, since its slope is at most 1 (more by the curvature).
TEST_F(Segments, FindTheNearestPointOfConvexShapes) {
  for (const ContactShape& shape : convex_shapes())
    for (const double curvature : {0.0, 0.01, 1.0})
      for (int i = 0; i < 200; ++i) {
        const Segment each = segment(curvature);
        const NearestOnSegment found = nearest_on(each, shape);
        double low = -each.half, high = each.half;
        while (high - low > 1e-12) {
          const double a = low + (high - low) / 3, b = high - (high - low) / 3;
          if (height(each, shape, a) < height(each, shape, b))
            high = b;
          else
            low = a;
        }
        EXPECT_NEAR(found.distance, height(each, shape, 0.5 * (low + high)), 4e-12);
        EXPECT_NEAR(found.distance, height(each, shape, found.along), 1e-15);
        EXPECT_LE(std::abs(found.along), each.half);
      }
}

// A motion changes the distance by at most its length: there are no jumps.
TEST_F(Segments, HaveDistancesWithoutJumps) {
  for (const ContactShape& shape : convex_shapes())
    for (int i = 0; i < 50; ++i) {
      const Segment begin = segment(0.01), end = segment(0.01);
      constexpr int kSteps = 400;
      double last = nearest_on(begin, shape).distance;
      Segment before = begin;
      for (int k = 1; k <= kSteps; ++k) {
        const double part = 1.0 * k / kSteps;
        Segment here = begin;
        here.middle += part * (end.middle - begin.middle);
        here.axis = (begin.axis + part * (end.axis - begin.axis)).normalized();
        const double way = (here.middle - before.middle).norm() + here.half * (here.axis - before.axis).norm();
        const double distance = nearest_on(here, shape).distance;
        EXPECT_LE(std::abs(distance - last), way + 1e-14);
        last = distance;
        before = here;
      }
    }
}

// Where a segment is parallel to a plane, its middle is nearest, since its surface is a barrel.
TEST_F(Segments, TouchPlanesInTheMiddle) {
  const ContactShape plane{HalfSpace{}, Pose()};
  const NearestOnSegment found = nearest_on({{0.2, 0.1, 0.5}, Vector3(0.6, 0.8, 0), 0.8, 0.01}, plane);
  EXPECT_NEAR(found.along, 0, 1e-14);
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_FALSE(found.is_end);
}

// Squares of such distances are not finite.
TEST_F(Segments, AreFarWhereNumbersOverflow) {
  for (const ContactShape& shape : convex_shapes())
    for (const double far : {1e200, 1e300}) {
      const NearestOnSegment found = nearest_on({{0, 0, far}, Vector3::UnitX(), 0.8, 0.01}, shape);
      EXPECT_GT(found.distance, 1e100);
      EXPECT_LE(std::abs(found.along), 0.8);
    }
}

}  // namespace
}  // namespace flexarm::test
