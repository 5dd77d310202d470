// Tests packs of numbers (SIMD): lanes are independent, and rotations of packs equal the rotations of their lanes.
#include "math/pack.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "flexarm/math/pose.h"
#include "math/lanes.h"
#include "math/simd.h"
#include "math/so3.h"

namespace flexarm {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Some tens of operations on numbers of order one, with and without fused multiply-add.
constexpr double kRoundOff = 1e-14;

void expect_lanes(const Pack& pack, double a, double b, double c, double d) {
  EXPECT_EQ(pack[0], a);
  EXPECT_EQ(pack[1], b);
  EXPECT_EQ(pack[2], c);
  EXPECT_EQ(pack[3], d);
}

TEST(Pack, ArithmeticIsLaneByLane) {
  const Pack a(1, 2, 3, 4), b(0.5, -1, 8, 0.25);
  expect_lanes(a + b, 1.5, 1, 11, 4.25);
  expect_lanes(a - b, 0.5, 3, -5, 3.75);
  expect_lanes(a * b, 0.5, -2, 24, 1);
  expect_lanes(a / b, 2, -2, 0.375, 16);
  expect_lanes(-a, -1, -2, -3, -4);
  expect_lanes(abs(b), 0.5, 1, 8, 0.25);
  expect_lanes(sqrt(Pack(1, 4, 9, 0.25)), 1, 2, 3, 0.5);
  expect_lanes(sign_of(b), 1, -1, 1, 1);
  expect_lanes(Pack(7), 7, 7, 7, 7);
}

TEST(Pack, LanesBeyondALimitAreVisited) {
  std::vector<int> visited;
  const auto visit = [&](int lane) { visited.push_back(lane); };
  for_lanes_beyond(Pack(0, 1, 2, 3), Pack(4), visit);
  EXPECT_TRUE(visited.empty());
  for_lanes_beyond(Pack(0, 4, kNan, 3), Pack(4), visit);
  EXPECT_EQ(visited, (std::vector<int>{1, 2}));
}

TEST(Pack, AddLanesTransposes) {
  constexpr int count = 6;
  std::array<Pack, count> values;
  for (int i = 0; i < count; ++i) values[i] = Pack(i, 10 + i, 20 + i, 30 + i);
  // One more, to check that nothing is written behind the end
  std::array<std::array<double, count + 1>, Pack::kLanes> numbers{};
  std::array<double*, Pack::kLanes> targets;
  for (int lane = 0; lane < Pack::kLanes; ++lane) targets[lane] = numbers[lane].data();
  numbers[1][0] = 100;
  add_lanes<count>(values.data(), 3, targets.data());
  for (int lane = 0; lane < Pack::kLanes; ++lane) {
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(numbers[lane][i], lane == 3 ? 0 : 10 * lane + i + (lane == 1 && i == 0 ? 100 : 0));
    EXPECT_EQ(numbers[lane][count], 0);
  }
}

/// Angles for all branches of the series, with a small angle next to each large one.
constexpr double kAngles[] = {0, 1e-9, 1e-3, 0.3, 0.9999, 1.0001, 1.9999, 2.0001, 2.5, 3.1, 3.14159};

Vector3 axis() {
  return Vector3(1, -2, 0.5).normalized();
}

TEST(Pack, RotationsAreThoseOfTheLanes) {
  for (const double angle : kAngles)
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      Vector3T<Pack> vectors;
      for (int l = 0; l < Pack::kLanes; ++l) set_lane(vectors, l, (l == lane ? angle : 0.1 * l) * axis());
      QuaternionT<Pack> quaternion;
      Vector3T<Pack> logarithm, unfolded;
      Matrix3T<Pack> rotation, tangent, inverse, derivative;
      simd::run([&] {
        const so3::ExponentialMap<Pack> map(vectors);
        rotation = map.rotation();
        tangent = map.tangent();
        inverse = map.inverse_tangent();
        derivative = map.tangent_derivative(vectors);
        quaternion = so3::exp_quaternion(vectors);
        logarithm = so3::log(quaternion);
        unfolded =
            so3::unfolded_log(QuaternionT<Pack>(-quaternion.w(), -quaternion.x(), -quaternion.y(), -quaternion.z()));
      });
      for (int l = 0; l < Pack::kLanes; ++l) {
        const Vector3 vector = get_lane(vectors, l);
        const so3::ExponentialMap<double> map(vector);
        EXPECT_LE((get_lane(rotation, l) - map.rotation()).norm(), kRoundOff);
        EXPECT_LE((get_lane(tangent, l) - map.tangent()).norm(), kRoundOff);
        EXPECT_LE((get_lane(inverse, l) - map.inverse_tangent()).norm(), kRoundOff * map.inverse_tangent().norm());
        EXPECT_LE((get_lane(derivative, l) - map.tangent_derivative(vector)).norm(), kRoundOff);
        EXPECT_LE((get_lane(quaternion.coeffs(), l) - so3::exp_quaternion(vector).coeffs()).norm(), kRoundOff);
        EXPECT_LE((get_lane(logarithm, l) - vector).norm(), kRoundOff);
        const Quaternion opposite(-so3::exp_quaternion(vector).coeffs());
        if (vector.norm() > 0.01) {  // for smaller angles the axis is round-off
          EXPECT_LE((get_lane(unfolded, l) - so3::unfolded_log(opposite)).norm(), 1e2 * kRoundOff) << vector.norm();
        }
      }
    }
}

TEST(Pack, BadLanesStayAlone) {
  const Vector3T<Pack> good(Pack(0.1, 2.5, 0.2, 0.3), Pack(0.2), Pack(-0.3));
  Vector3T<Pack> bad = good;
  bad[0].set(2, kNan);
  Matrix3T<Pack> of_good, of_bad;
  simd::run([&] {
    of_good = so3::exp(good);
    of_bad = so3::exp(bad);
  });
  for (int lane = 0; lane < Pack::kLanes; ++lane) {
    if (lane != 2) {
      EXPECT_EQ(get_lane(of_good, lane), get_lane(of_bad, lane));
    }
  }
  EXPECT_FALSE(get_lane(of_bad, 2).allFinite());
}

}  // namespace
}  // namespace flexarm
