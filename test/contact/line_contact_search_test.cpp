// Tests which places of a beam's line a contact finds: nearest points, near pairs, and stations that touch.
#include "contact/line_contact.h"

#include <gtest/gtest.h>

#include "contact/line_contact_parts.h"
#include "math/shape_functions.h"
#include "model/state.h"
#include "support/node_poses.h"

namespace flexarm::test::lines {
namespace {

TEST(LineContact, FindsTheNearestPlaceOfALine) {
  Random random(5);
  for (int order = 1; order <= 4; ++order)
    for (int run = 0; run < 200; ++run) {
      std::array<Vector3, 5> nodes;
      for (int i = 0; i <= order; ++i) nodes[i] = Vector3(node_coordinate(order + 1, i), 0, 0) + random.vector(0.15);
      const Vector3 point = random.vector(1.5);
      const LinePiece piece = line_piece(order, nodes);
      const double low = run % 2 ? -1 : -0.3, high = run % 3 ? 1 : 0.4;
      const ClosestPoint found = closest_point(piece, point, low, high);
      const auto distance_at = [&](double xi) {
        const ElementWeights weights = line_weights(order, xi).values;
        Vector3 at = -point;
        for (int i = 0; i <= order; ++i) at += weights[i] * nodes[i];
        return at.norm();
      };
      EXPECT_NEAR(std::sqrt(found.square), distance_at(found.xi), 1e-14);
      for (int k = 0; k <= 300; ++k)
        EXPECT_GE(distance_at(low + (high - low) * k / 300), std::sqrt(found.square) - 1e-13) << order << " " << run;
      // The distance is stationary at the nearest point, so the point is as exact as the derivative.
      if (!found.is_clamped && found.square > 1e-4) {
        const double h = 1e-4, slope = (distance_at(found.xi + h) - distance_at(found.xi - h)) / (2 * h);
        EXPECT_LE(std::abs(slope), 1e-6) << order << " " << run;
      }
      EXPECT_LE((piece.middle() - nodes[0]).norm(), piece.reach + 1e-14);
      EXPECT_LE(piece.least_distance(point), std::sqrt(found.square) + 1e-14);
    }
}

/// A small ball beside a line of ten elements of order 1 along x. Over a step it moves from one position to another at
/// constant speed.
struct BallAndLine {
  BallAndLine(const Vector3& from, const Vector3& to) {
    LineTouch touch;
    for (int i = 0; i <= 10; ++i) begin.push_back(node_at({0.1 * i, 0, 0}, Quaternion::Identity()));
    touch.line.order = 1;
    for (int i = 0; i < 10; ++i) {
      touch.line.elements.push_back({i, i + 1});
      touch.line.lengths.push_back(0.1);
    }
    touch.line.radius = 0.001;
    end = begin;
    begin.push_back(node_at(from, Quaternion::Identity()));
    end.push_back(node_at(to, Quaternion::Identity()));
    velocities.assign(begin.size(), Vector6::Zero());
    velocities.back().head<3>() = (to - from) / 0.05;
    ContactStation ball;
    ball.radius = 0.02;
    touch.side = {{11}, {ball}};
    touch.pairs = {{0, {}, {}}};
    element = std::make_unique<LineContact>(std::vector<std::string>{"", ""}, touch, gripping_law(0, 1));
  }
  std::vector<int> near() const {
    std::vector<int> nodes(element->most_nodes());
    nodes.resize(element->find_nodes({begin, velocities, 0.05}, nodes.data()));
    return nodes;
  }
  bool asks_for_halves(bool was_near) const {
    const double memory[LineMemory::kSize] = {};
    ForceStep step{begin, end, velocities};
    step.duration = 0.05;
    step.memory = memory;
    const std::vector<int> nodes = near();
    return element->needs_halves(step, nodes.data(), was_near ? static_cast<int>(nodes.size()) : 0);
  }

  Poses begin, end;
  std::vector<Vector6> velocities;
  std::unique_ptr<LineContact> element;
};

TEST(LineContact, ActsOnNodesThatAreNearAlone) {
  const Vector3 at(0.55, 0, 0.1);
  EXPECT_EQ(BallAndLine(at, at).near(), std::vector<int>());
  EXPECT_EQ(BallAndLine(at, at - Vector3(0, 0, 0.03)).near(), std::vector<int>()) << "twice this way: not yet";
  EXPECT_EQ(BallAndLine(at, at - Vector3(0, 0, 0.045)).near(), (std::vector<int>{11, 5, 6}));
  EXPECT_EQ(BallAndLine({0.602, 0, 0.021}, {0.602, 0, 0.021}).near(), (std::vector<int>{11, 6, 7, 5}));
}

TEST(LineContact, AsksForHalvesOfStepsThatItWouldNotSee) {
  const auto asks = [](double from, double to, bool was_near) {
    return BallAndLine({0.55, 0, from}, {0.55, 0, to}).asks_for_halves(was_near);
  };
  EXPECT_TRUE(asks(0.1, -0.3, true)) << "through";
  EXPECT_TRUE(asks(0.022, -0.015, true)) << "to the other side, still inside";
  EXPECT_TRUE(asks(0.0215, 0.0205, false)) << "it was not near";
  EXPECT_FALSE(asks(0.0215, 0.0209, true)) << "a light touch";
  EXPECT_FALSE(asks(0.1, 0.03, false));
  EXPECT_FALSE(BallAndLine({0.55, 0.03, 0.1}, {0.55, 0.03, -0.1}).asks_for_halves(true)) << "beside it";
  const auto grazes = [](double y, double z) { return BallAndLine({0.55, y, z}, {0.55, -y, z}).asks_for_halves(true); };
  EXPECT_TRUE(grazes(1.1e-3, 0.02098)) << "by its way it goes in by a thousandth";
  EXPECT_FALSE(grazes(1e-6, 0.021 - 1e-11)) << "round-off: what lies alongside would be halved for ever";
}

/// A line of elements of order 1 along x, 0.1 m long each, and two balls a half metre apart, at a node or in the world.
struct TwoBallsAndLine {
  TwoBallsAndLine(bool is_body, const Vector3& middle, const Vector3& arm) {
    LineTouch touch;
    constexpr int kElements = 60;
    for (int i = 0; i <= kElements; ++i) poses.push_back(node_at({0.1 * i, 0, 0}, Quaternion::Identity()));
    touch.line.order = 1;
    for (int i = 0; i < kElements; ++i) touch.line.elements.push_back({i, i + 1});
    touch.line.lengths.assign(kElements, 0.1);
    touch.line.radius = 0.01;
    if (is_body) poses.push_back(node_at(middle, Quaternion::Identity()));
    touch.side.nodes = {is_body ? kElements + 1 : -1};
    for (const double x : {-0.25, 0.25}) {
      ContactStation ball;
      ball.arm = arm + Vector3(x, 0, 0) + (is_body ? Vector3(Vector3::Zero()) : middle);
      ball.radius = 0.02;
      touch.pairs.push_back({static_cast<int>(touch.side.stations.size()), {}, {}});
      touch.side.stations.push_back(ball);
    }
    element = std::make_unique<LineContact>(std::vector<std::string>{"", ""}, touch, gripping_law(0.1, 0.5));
  }

  Poses poses;
  std::unique_ptr<LineContact> element;
};

// The nodes of small motions are those that the stations touch, wherever stations are relative to their node or to the
// world's origin, and however many elements are between them.
TEST(LineContact, MeasuresTheStationsThatTouch) {
  for (const bool is_body : {true, false})
    for (const Vector3& arm : {Vector3(0, 0, 0), Vector3(-3, 0, 0), Vector3(0, 2, 1)}) {
      const TwoBallsAndLine scene(is_body, Vector3(3.05, 0, 0.029) - arm, arm);
      const State state = state_at(scene.poses);
      std::vector<int> nodes(scene.element->most_nodes());
      const std::vector<Vector6> at_rest(scene.poses.size(), Vector6::Zero());
      nodes.resize(scene.element->find_nodes({scene.poses, at_rest}, nodes.data()));
      const ForceMeasures measures = scene.element->measures(state, nullptr, nodes.data());
      ASSERT_EQ(measures.rows.rows(), 6) << is_body << arm.transpose();
      ASSERT_EQ(measures.rows.cols(), 6 * static_cast<Eigen::Index>(nodes.size()));
      // The balls are over the line's nodes 28 and 33, so each normal measure is the height over one of these.
      for (const auto& [row, below] : {std::pair<Eigen::Index, int>(0, 28), {3, 33}}) {
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(measures.rows.cols());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          const auto at = 6 * static_cast<Eigen::Index>(i);
          if (nodes[i] == below) expected[at + 2] = -1;
          if (nodes[i] == 61) {
            expected[at + 2] = 1;
            expected.segment<3>(at + 3) = (arm + Vector3(row == 0 ? -0.25 : 0.25, 0, 0)).cross(Vector3::UnitZ());
          }
        }
        EXPECT_LE((measures.rows.row(row).transpose() - expected).norm(), 1e-12) << is_body << arm.transpose();
      }
      const DamperTensions dampers = scene.element->dampers(state, nullptr, Eigen::VectorXd::Ones(6));
      EXPECT_GT(dampers.tension[0], 0);
      EXPECT_GT(dampers.tension[3], 0);
    }
}

}  // namespace
}  // namespace flexarm::test::lines
