// Tests straight pieces of lines between points and circles: lengths by closed forms, derivatives against differences,
// exact changes over a step, and forces without a sum.
#include "elements/tendon_piece.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "math/cayley.h"
#include "math/pi.h"
#include "math/so3.h"
#include "support/node_poses.h"

namespace flexarm::test {
namespace {

GuidePlace circle(int node, const Vector3& centre, const Vector3& rotation, double radius, double sense) {
  const Matrix3 axes = so3::exp(rotation);
  return {node, centre, axes.col(0), axes.col(1), radius, sense};
}

/// A piece with its poses at both ends of a step.
struct PieceCase {
  const char* name;
  TendonPiece piece;
  PiecePoses begin, end;
};

std::vector<PieceCase> piece_cases() {
  const PiecePoses begin{turned_node({0.1, -0.2, 0.3}, {0.2, 0.1, -0.3}),
                         turned_node({1.1, 0.4, 0.2}, {-0.1, 0.3, 0.2})};
  const PiecePoses end{turned_node({0.15, -0.25, 0.32}, {0.25, 0.05, -0.2}),
                       turned_node({1.05, 0.48, 0.28}, {-0.2, 0.35, 0.5})};
  const GuidePlace point{0, {0.1, 0.05, -0.1}}, other{1, {-0.05, 0.1, 0.2}}, fixed{-1, {-0.5, 0.2, 0.1}};
  const PiecePoses from_world{NodePose(), begin.second}, from_world_end{NodePose(), end.second};
  std::vector<PieceCase> out = {{"points", {point, other}, begin, end},
                                {"world", {fixed, other}, from_world, from_world_end}};
  for (const double sense : {1.0, -1.0}) {
    const GuidePlace first = circle(0, {0.05, 0.02, 0.1}, {0.2, -0.1, 0.3}, 0.15, sense);
    const GuidePlace second = circle(1, {0.02, -0.1, 0.05}, {0.1, 0.2, -2}, 0.2, 1);
    out.push_back({"to a circle", {point, circle(1, {0.02, -0.1, 0.05}, {0.1, 0.2, -2}, 0.2, sense)}, begin, end});
    out.push_back({"from a circle", {first, other}, begin, end});
    out.push_back({"from circle to circle", {first, second}, begin, end});
    out.push_back({"from the world to a circle", {fixed, second}, from_world, from_world_end});
  }
  return out;
}

PiecePoses moved_by(const PiecePoses& poses, const Vector12& way) {
  return {moved(poses.first, way.head<6>()), moved(poses.second, way.tail<6>())};
}

/// {displacement, tangent-scaled rotation} of both nodes.
Vector12 motion(const PiecePoses& begin, const PiecePoses& end) {
  Vector12 out;
  out << end.first.position - begin.first.position, cayley::increment(begin.first.orientation, end.first.orientation),
      end.second.position - begin.second.position, cayley::increment(begin.second.orientation, end.second.orientation);
  return out;
}

const std::vector<PieceWeights> kWeights = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0.15, -0.2}};

TEST(TendonPiece, IsTangentToACircle) {
  // A point 0.5 m from the centre of a circle of 0.3 m: 0.4 m, and the angle has the cosine 0.3 / 0.5.
  for (const double sense : {1.0, -1.0}) {
    const TendonPiece piece({-1, {0.5, 0, 0}}, circle(-1, {0, 0, 0}, {0, 0, 0}, 0.3, sense));
    const PieceState state = piece.find({}, {});
    EXPECT_NEAR(state.length, 0.4, 1e-15);
    EXPECT_NEAR(state.end, sense * std::acos(0.6), 1e-15);
    const TendonPiece back(circle(-1, {0, 0, 0}, {0, 0, 0}, 0.3, sense), {-1, {0.5, 0, 0}});
    EXPECT_NEAR(back.find({}, {0, 2 * kPi, 0}).begin, 2 * kPi - sense * std::acos(0.6), 1e-14);  // a turn later
  }
}

TEST(TendonPiece, OfABeltIsTangentToBothCircles) {
  const double distance = 1, small = 0.1, large = 0.25;
  const auto length = [&](double sense) {
    const TendonPiece piece(circle(-1, {0, 0, 0}, {0, 0, 0}, small, 1),
                            circle(-1, {distance, 0, 0}, {0, 0, 0}, large, sense));
    return piece.find({}, {}).length;
  };
  EXPECT_NEAR(length(1), std::sqrt(distance * distance - (large - small) * (large - small)), 1e-15);   // open
  EXPECT_NEAR(length(-1), std::sqrt(distance * distance - (large + small) * (large + small)), 1e-15);  // crossed
}

TEST(TendonPiece, HasNoLengthInsideACircle) {
  const TendonPiece piece({-1, {0.1, 0, 0}}, circle(-1, {0, 0, 0}, {0, 0, 0}, 0.3, 1));
  EXPECT_TRUE(std::isnan(piece.find({}, {}).length));
}

// Central differences with the step 1e-6: truncation of 1e-12 times third derivatives, round-off of 1e-10.
TEST(TendonPiece, HasItsDerivatives) {
  constexpr double h = 1e-6;
  for (const PieceCase& tested : piece_cases()) {
    const TendonPiece& piece = tested.piece;
    const PiecePoses &begin = tested.begin, &end = tested.end;
    const char* const name = tested.name;
    for (const PieceWeights& weights : kWeights)
      for (const bool at_end : {false, true}) {
        const PieceState before = piece.find(begin, {}), near = piece.find(end, before);
        const PieceEnd from = piece.place(begin, before);
        const PieceChange here = piece.change(from, piece.place(end, near), weights, at_end, true);
        for (int k = 0; k < 12; ++k) {
          if (k < 6 && piece.first().node < 0) continue;
          const Vector12 way = h * Vector12::Unit(k);
          const auto value = [&](double sign) { return piece.find(moved_by(end, sign * way), near).value(weights); };
          const auto direction = [&](double sign) {
            const PiecePoses at = moved_by(end, sign * way);
            return piece.change(from, piece.place(at, near), weights, at_end, false).direction;
          };
          EXPECT_NEAR(here.end_gradient[k], (value(1) - value(-1)) / (2 * h), 3e-9) << name << k;
          const Vector12 slope = (direction(1) - direction(-1)) / (2 * h);
          EXPECT_LE((here.direction_slope.col(k) - slope).norm(), 1e-8 * (1 + slope.norm())) << name << k;
        }
        const Vector12 difference = piece.gradient(end, near, weights) - here.end_gradient;
        EXPECT_LE(difference.tail(piece.first().node < 0 ? 6 : 12).norm(), 1e-13 * (1 + here.end_gradient.norm()))
            << name;
      }
  }
}

TEST(TendonPiece, ChangesExactlyByItsDirection) {
  for (const auto& [name, piece, begin, end] : piece_cases())
    for (const PieceWeights& weights : kWeights) {
      const PieceState before = piece.find(begin, {}), after = piece.find(end, before);
      const Vector12 direction =
          piece.change(piece.place(begin, before), piece.place(end, after), weights, false, false).direction;
      EXPECT_NEAR(direction.dot(motion(begin, end)), after.value(weights) - before.value(weights), 1e-14) << name;
    }
}

TEST(TendonPiece, AddsToNoMomentum) {
  for (const auto& [name, piece, begin, end] : piece_cases()) {
    if (piece.first().node < 0) continue;
    for (const PieceWeights& weights : kWeights)
      for (const bool at_end : {false, true}) {
        const PieceState before = piece.find(begin, {}), after = piece.find(end, before);
        const Vector12 force =
            piece.change(piece.place(begin, before), piece.place(end, after), weights, at_end, false).direction;
        const double weight = at_end ? 1 : 0.5;
        const auto mean = [&](const NodePose& a, const NodePose& b) {
          return Vector3((1 - weight) * a.position + weight * b.position);
        };
        EXPECT_LE((force.head<3>() + force.segment<3>(6)).norm(), 1e-15) << name;
        const Vector3 moment = mean(begin.first, end.first).cross(force.head<3>()) + force.segment<3>(3) +
                               mean(begin.second, end.second).cross(force.segment<3>(6)) + force.segment<3>(9);
        EXPECT_LE(moment.norm(), 1e-14) << name;
      }
  }
}

}  // namespace
}  // namespace flexarm::test
