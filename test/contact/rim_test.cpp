// Tests the lowest point of a rim against the circle itself, and its derivatives against differences.
#include "contact/rim.h"

#include <cmath>

#include <gtest/gtest.h>

#include "math/pi.h"
#include "math/so3.h"

namespace flexarm::test {
namespace {

const Vector3 kNormal = Vector3(0.2, -0.3, 0.8).normalized();

/// A rim whose axis includes an angle with the normal.
Rim tilted(double angle) {
  const Vector3 across = kNormal.unitOrthogonal();
  return {Vector3(0.1, 0.2, 0.3), std::cos(angle) * kNormal + std::sin(angle) * across, 0.7};
}

// The point is above the lowest one of the circle by at most kFlatRim^2 / (2 sin) of the radius, and in its plane.
TEST(Rim, LowestPointIsThatOfTheCircle) {
  for (const double angle : {1e-2, 0.1, 0.7, 0.5 * kPi, 2.5}) {
    const Rim rim = tilted(angle);
    const Vector3 across = rim.axis.unitOrthogonal(), third = rim.axis.cross(across),
                  point = lowest_point(rim, kNormal);
    double lowest = 0;
    for (int k = 0; k < 100000; ++k) {
      const double turn = 2 * kPi * k / 100000;
      lowest = std::min(lowest, rim.radius * kNormal.dot(std::cos(turn) * across + std::sin(turn) * third));
    }
    const double rounding = kFlatRim * kFlatRim / (2 * std::sin(angle));
    EXPECT_NEAR(kNormal.dot(point), lowest, rim.radius * (rounding + 1e-8)) << angle;
    EXPECT_LE(point.norm(), rim.radius);
    EXPECT_NEAR(point.dot(rim.axis), 0, 1e-15);
  }
  EXPECT_NEAR(lowest_point(tilted(0), kNormal).norm(), 0, 1e-12) << "it goes to the middle where the rim lies flat";
}

// The lever times the change of the cosine is the change of the height: no correction is needed for exact work. Near
// the flat rim, the sine has the round-off of its square, divided by kFlatRim.
TEST(Rim, LeverIsADifferenceQuotient) {
  for (const double begin : {0.0, 1e-5, 0.3, 1.2, 1.5, 2.0})
    for (const double end : {1e-6, 0.02, 0.9, 1.6, 3.1}) {
      const Rim from = tilted(begin), to = tilted(end);
      const double first = kNormal.dot(from.axis), last = kNormal.dot(to.axis);
      EXPECT_NEAR(rim_lever(0.7, first, last).value * (last - first),
                  kNormal.dot(lowest_point(to, kNormal) - lowest_point(from, kNormal)), 1e-16 / kFlatRim);
    }
}

// Central differences have truncation errors of h^2 times third derivatives. Those by the spin grow as the inverse cube
// of the tilt's sine, relative ones by the cosine as its inverse fourth power.
TEST(Rim, HasItsDerivatives) {
  constexpr double h = 1e-6;
  for (const double angle : {0.05, 0.6, 0.5 * kPi, 2.8}) {
    const Rim rim = tilted(angle);
    const Matrix3 slope = lowest_point_by_spin(rim, kNormal);
    for (int k = 0; k < 3; ++k) {
      const auto turned = [&](double by) {
        Rim out = rim;
        out.axis = so3::exp_quaternion(Vector3(by * Vector3::Unit(k))) * rim.axis;
        return lowest_point(out, kNormal);
      };
      EXPECT_LE(((turned(h) - turned(-h)) / (2 * h) - slope.col(k)).norm(),
                1e-9 + 10 * h * h / std::pow(std::sin(angle), 3))
          << angle;
    }
    const double cosine = std::cos(angle), begin = cosine - 0.1;
    const double difference =
        (rim_lever(0.7, begin, cosine + h).value - rim_lever(0.7, begin, cosine - h).value) / (2 * h);
    EXPECT_NEAR(rim_lever(0.7, begin, cosine).slope, difference,
                (1e-9 + h * h / std::pow(std::sin(angle), 4)) * std::abs(difference) + 1e-9);
    const double push = 3;
    const Vector3 couple = push * (couple_beside(rim, kNormal) + lowest_point(rim, kNormal).cross(kNormal));
    EXPECT_LE((couple - push * rim_lever(0.7, cosine, cosine).value * rim.axis.cross(kNormal)).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace flexarm::test
