// Tests undeformed centrelines.
#include "building/centreline.h"

#include <limits>

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;
using scene::CentrelinePiece;

CentrelinePiece line(const Vector3& to, double twist = 0) {
  return {CentrelinePiece::Kind::Line, to, {}, twist, {}};
}
CentrelinePiece arc(const Vector3& to, const Vector3& center, double twist = 0) {
  return {CentrelinePiece::Kind::Arc, to, center, twist, {}};
}
Vector3 tangent(const Centreline& line, double s, bool before = true) {
  return line.at(s, before).orientation * Vector3::UnitX();
}

/// A line along x, a quarter circle towards y, and a kink to a line along z with a twist.
std::vector<CentrelinePiece> hook() {
  return {line({2, 0, 0}), arc({3, 1, 0}, {2, 1, 0}, 0.4), line({3, 1, 1.5}, -0.7)};
}

TEST(Centreline, LengthAndBorders) {
  const Centreline centreline(hook(), {});
  EXPECT_NEAR(centreline.length(), 2 + kPi / 2 + 1.5, 1e-14);
  const std::vector<double> ends = centreline.piece_ends();
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_NEAR(ends[0], 2, 1e-15);
  EXPECT_NEAR(ends[1], 2 + kPi / 2, 1e-14);
  EXPECT_FALSE(centreline.is_kink(ends[0]));
  EXPECT_TRUE(centreline.is_kink(ends[1]));
  EXPECT_FALSE(centreline.is_kink(1.0));
}

TEST(Centreline, PointsOfAnArcLieOnItsCircle) {
  const Centreline centreline(hook(), {});
  for (double angle = 0; angle <= kPi / 2; angle += 0.1) {
    const Vector3 point = centreline.at(2 + angle).position;
    EXPECT_LE((point - Vector3(2 + std::sin(angle), 1 - std::cos(angle), 0)).norm(), 1e-14);
  }
  EXPECT_LE((centreline.at(centreline.length()).position - Vector3(3, 1, 1.5)).norm(), 1e-14);
}

// A flat arc causes no loss of digits.
TEST(Centreline, VeryFlatArc) {
  const double radius = 1e6, angle = 1e-6;
  const Centreline centreline(
      {arc({radius * std::sin(angle), 2 * radius * std::pow(std::sin(angle / 2), 2), 0}, {0, radius, 0})}, {});
  EXPECT_NEAR(centreline.length(), 1, 1e-9);
  EXPECT_LE((centreline.at(0.5).position - Vector3(0.5, 0.125e-6, 0)).norm(), 1e-9);
}

TEST(Centreline, SectionAxisIsTheTangentOfTheLine) {
  const Centreline centreline(hook(), {});
  for (const double s : {0.5, 1.3, 2.4, 3.1, 4.0, 4.8}) {
    const Vector3 slope = difference([&](double h) { return centreline.at(s + h).position; });
    EXPECT_LE((tangent(centreline, s) - slope).norm(), difference_tolerance);
  }
}

// In an untwisted arc, the section does not rotate about the tangent. A twist rotates it at a constant rate.
TEST(Centreline, TwistIsTheTurningAboutTheTangent) {
  const Centreline centreline(hook(), {});
  for (const auto& [arc_length, rate] :
       {std::pair(1.0, 0.0), std::pair(2.7, 0.4 / (kPi / 2)), std::pair(4.5, -0.7 / 1.5)}) {
    const double s = arc_length;
    const Quaternion at = centreline.at(s).orientation;
    const Vector3 turning =
        difference([&](double h) { return cayley::increment(at, centreline.at(s + h).orientation); });
    EXPECT_NEAR(turning.dot(at * Vector3::UnitX()), rate, difference_tolerance);
  }
}

TEST(Centreline, FirstSectionFrame) {
  EXPECT_TRUE(Centreline({line({1, 0, 0})}, {}).at(0).orientation.isApprox(Quaternion::Identity()));
  // The given axis is projected onto the section.
  const Pose given = Centreline({line({1, 0, 0})}, Vector3(5, 0, 2)).at(0);
  EXPECT_LE((given.orientation * Vector3::UnitY() - Vector3::UnitZ()).norm(), 1e-14);
  // For a line along the link's y axis, another axis is chosen, reproducibly.
  const Pose along_y = Centreline({line({0, 1, 0})}, {}).at(0);
  EXPECT_LE((along_y.orientation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-14);
  EXPECT_LE((along_y.orientation * Vector3::UnitY() - Vector3::UnitZ()).norm(), 1e-14);
}

// At a kink, the section makes the smallest rotation between both tangents.
TEST(Centreline, KinkTurnsAboutTheNormalOfBothTangents) {
  const Centreline centreline({line({1, 0, 0}), line({1, 2, 0})}, {});
  const Pose before = centreline.at(1, true), after = centreline.at(1, false);
  EXPECT_LE((tangent(centreline, 1, true) - Vector3::UnitX()).norm(), 1e-14);
  EXPECT_LE((tangent(centreline, 1, false) - Vector3::UnitY()).norm(), 1e-14);
  EXPECT_LE((cayley::increment(before.orientation, after.orientation) - Vector3(0, 0, 2 * std::tan(kPi / 4))).norm(),
            1e-13);
}

TEST(Centreline, NearestPointIsTheNearest) {
  const Centreline centreline(hook(), {});
  RandomSource random(1);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Vector3 point = Vector3(1.5, 0.5, 0.7) + 2 * random.vector();
    const double found = centreline.nearest(point);
    EXPECT_TRUE(found >= 0 && found <= centreline.length());
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 5000; ++i)
      best = std::min(best, (centreline.at(i * centreline.length() / 5000).position - point).norm());
    EXPECT_LE((centreline.at(found).position - point).norm(), best + 1e-12);
  }
}

TEST(Centreline, NearestOfItsOwnPoints) {
  const Centreline centreline(hook(), {});
  for (const double s : {0.0, 0.3, 2.0, 2.5, 2 + kPi / 2, 4.9, centreline.length()})
    EXPECT_NEAR(centreline.nearest(centreline.at(s).position), s, 1e-12);
}

TEST(Centreline, Turning) {
  const Centreline centreline(hook(), {});
  EXPECT_EQ(centreline.turning(0, 2), 0);
  const double arc_rate = std::hypot(1.0, 0.4 / (kPi / 2));
  EXPECT_NEAR(centreline.turning(1, 2.5), 0.5 * arc_rate, 1e-14);
  EXPECT_NEAR(centreline.turning(0, centreline.length()), kPi / 2 * arc_rate + 0.7, 1e-13);
}

TEST(Centreline, Errors) {
  const auto expect_error = [](const std::vector<CentrelinePiece>& pieces, const std::optional<Vector3>& y = {}) {
    EXPECT_THROW(Centreline(pieces, y), std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error({});
  expect_error({line({0, 0, 0})});
  expect_error({line({nan, 0, 0})});
  expect_error({line({1, 0, 0}), line({1, 0, 0})});
  expect_error({line({1, 0, 0}), line({0.5, 0, 0})});  // back on itself
  expect_error({arc({1, 0, 0}, {0.4, 1, 0})});         // not equidistant
  expect_error({arc({2, 0, 0}, {1, 0, 0})});           // half a circle is ambiguous
  expect_error({arc({1, 0, 0}, {0, 0, 0})});           // no radius at the start
  expect_error({line({1, 0, 0})}, Vector3(1, 0, 0));   // y along the line
}

}  // namespace
}  // namespace flexarm
