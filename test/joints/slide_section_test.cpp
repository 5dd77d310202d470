// Tests sections of plain and smooth lines: partition of unity, continuity, derivatives, objectivity.
#include "joints/slide_section.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "elements/random_element.h"
#include "joints/slide_variation.h"

namespace flexarm {
namespace {

using namespace test;

/// A line of unequal elements of several orders, bent in space by up to 1 rad per element.
struct BentLine {
  SlideLine line;
  std::vector<PoseT<double>> poses;

  explicit BentLine(bool smooth, double bend = 1) {
    const double borders[] = {-0.2, 0.4, 1.1, 1.5, 1.8};
    const int orders[] = {2, 3, 1, 4};
    line.smooth = smooth;
    int node = 0;
    for (int e = 0; e < 4; ++e) {
      line.pieces.push_back({node, orders[e] + 1, borders[e], borders[e + 1]});
      node += orders[e];
    }
    RandomSource random(3);
    for (int e = 0; e < 4; ++e)
      for (int i = e == 0 ? 0 : 1; i <= orders[e]; ++i) {
        const double x = borders[e] + 0.5 * (1 + node_coordinate(orders[e] + 1, i)) * line.pieces[e].length();
        line.nodes.push_back(static_cast<int>(poses.size()));
        poses.push_back(
            {Vector3(x, 0.3 * x * x, std::sin(2 * x)) + 0.02 * random.vector(),
             so3::exp_quaternion(Vector3(bend * Vector3(0.9 * x, std::cos(x), 0.7 * x * x))) * random.rotation(0.1)});
      }
  }
  PoseT<double> operator()(int i) const { return poses[i]; }
  Section<double> at(int piece, double x) const { return section_at(line, piece, x, *this); }
  Section<double> at(double x) const { return at(line.piece_at(x), x); }
};

class SlideSection : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Lines, SlideSection, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "smooth" : "elements"; });

TEST_P(SlideSection, WeightsAreAPartitionOfUnity) {
  const BentLine bent(GetParam());
  for (double x = -0.2; x <= 1.8; x += 0.01) {
    const int piece = bent.line.piece_at(x);
    const slide::LineWeights<double> w = slide::line_weights(bent.line, piece, x);
    const FrameVariation frame(bent.line, piece, x, bent);
    double sum = 0, slope = 0;
    Matrix3 spin = Matrix3::Zero(), spin_slope = Matrix3::Zero();
    for (int i = 0; i < w.count; ++i) {
      sum += w.values[i];
      slope += w.derivatives[i];
      spin += frame.values[i];
      spin_slope += frame.derivatives[i];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_NEAR(slope, 0, 1e-13);
    EXPECT_LE((spin - Matrix3::Identity()).norm(), 1e-13);
    EXPECT_LE(spin_slope.norm(), 1e-12);
  }
}

TEST_P(SlideSection, NodesStayWhereTheyAre) {
  const BentLine bent(GetParam());
  for (std::size_t e = 0; e < 4; ++e) {
    const SlidePiece& piece = bent.line.pieces[e];
    for (int i : {0, piece.node_count - 1}) {
      const Section<double> section = bent.at(static_cast<int>(e), i == 0 ? piece.begin : piece.end);
      const PoseT<double>& pose = bent.poses[piece.first_node + i];
      EXPECT_LE((section.position - pose.position).norm(), 1e-14);
      EXPECT_LE((section.rotation - pose.orientation.toRotationMatrix()).norm(), 1e-14);
    }
  }
}

// At borders, the tangent of a line of elements jumps. On a smooth line, neither the tangent nor the frame jumps.
TEST_P(SlideSection, TangentsOverBorders) {
  const BentLine bent(GetParam());
  for (int e = 0; e < 3; ++e) {
    const double border = bent.line.pieces[e].end;
    const Section<double> before = bent.at(e, border), after = bent.at(e + 1, border);
    EXPECT_LE((before.position - after.position).norm(), 1e-14);
    EXPECT_LE((before.rotation - after.rotation).norm(), 1e-14);
    if (GetParam()) {
      EXPECT_LE((before.tangent - after.tangent).norm(), 1e-13);
      EXPECT_LE((before.spatial_curvature - after.spatial_curvature).norm(), 1e-13);
    } else {
      EXPECT_GE((before.tangent - after.tangent).norm(), 1e-2);
      EXPECT_GE((before.spatial_curvature - after.spatial_curvature).norm(), 1e-2);
    }
  }
}

// The tangent at a border is the mean weighted by lengths, i.e. the derivative of a parabola through three nodes. It is
// exact for a line of the second degree.
TEST(SlideSection, GradedLinesOfTheSecondDegreeHaveExactTangentsAtBorders) {
  SlideLine line;
  line.smooth = true;
  line.pieces = {{0, 2, 0, 0.3}, {1, 2, 0.3, 1.2}, {2, 2, 1.2, 1.4}};
  const double places[] = {0, 0.3, 1.2, 1.4};
  const auto poses = [&](int i) {
    const double x = places[i];
    return PoseT<double>{Vector3(x, 0.7 * x * x - x, 0), so3::exp_quaternion(Vector3(0, 0, x * x))};
  };
  for (int e = 0; e < 2; ++e) {
    const double x = line.pieces[e].end;
    const Section<double> section = section_at(line, e, x, poses);
    EXPECT_LE((section.tangent - Vector3(1, 1.4 * x - 1, 0)).norm(), 1e-14);
    EXPECT_LE((section.spatial_curvature - Vector3(0, 0, 2 * x)).norm(), 1e-14);
  }
}

TEST_P(SlideSection, TangentAndCurvatureAreDerivatives) {
  const BentLine bent(GetParam());
  for (const double x : {-0.1, 0.35, 0.45, 0.9, 1.2, 1.45, 1.6}) {
    const int piece = bent.line.piece_at(x);
    const Section<double> section = bent.at(piece, x);
    const auto derivative = difference(
        [&](double h) {
          const Section<double> moved = bent.at(piece, x + h);
          Vector6 change;
          change << moved.position, so3::log(Matrix3(moved.rotation * section.rotation.transpose()));
          return change;
        },
        difference_step);
    Vector6 actual;
    actual << section.tangent, section.spatial_curvature;
    // The tolerance is larger, because elements of 0.3 m have large seventh derivatives.
    EXPECT_LE((derivative - actual).norm(), 100 * difference_tolerance) << x;
    const FrameVariation frame(bent.line, piece, x, bent);
    EXPECT_LE((frame.spatial_curvature - section.spatial_curvature).norm(), 1e-13);
    const auto slopes = difference(
        [&](double h) {
          const FrameVariation moved(bent.line, piece, x + h, bent);
          Eigen::MatrixXd all(3, 3 * moved.count);
          for (int i = 0; i < moved.count; ++i) all.middleCols<3>(3 * i) = moved.values[i];
          return all;
        },
        difference_step);
    for (int i = 0; i < frame.count; ++i)
      EXPECT_LE((slopes.middleCols<3>(3 * i) - frame.derivatives[i]).norm(), 1000 * difference_tolerance) << x;
  }
}

TEST_P(SlideSection, FollowsARigidMotion) {
  const BentLine bent(GetParam());
  BentLine moved = bent;
  RandomSource random(5);
  const Quaternion turn = random.rotation(3);
  const Vector3 shift = random.vector();
  for (PoseT<double>& pose : moved.poses) {
    pose.position = turn * pose.position + shift;
    pose.orientation = turn * pose.orientation;
  }
  for (double x = -0.2; x <= 1.8; x += 0.05) {
    const Section<double> a = bent.at(x), b = moved.at(x);
    EXPECT_LE((turn * a.position + shift - b.position).norm(), 1e-14);
    EXPECT_LE((turn * a.tangent - b.tangent).norm(), 1e-13);
    EXPECT_LE((turn.toRotationMatrix() * a.rotation - b.rotation).norm(), 1e-13);
    EXPECT_LE((turn * a.spatial_curvature - b.spatial_curvature).norm(), 1e-12);
  }
}

// The frame depends only on its own element and the curvatures of the neighbours, so lines may roll up.
TEST(SlideSection, SmoothLinesMayRollUp) {
  SlideLine line;
  line.smooth = true;
  const int elements = 6;
  const double turn = 2.5;  // rotation over each element, more than two turns altogether [rad]
  for (int e = 0; e < elements; ++e) line.pieces.push_back({2 * e, 3, 1.0 * e, e + 1.0});
  const auto poses = [&](int i) {
    const double a = 0.5 * turn * i;
    return PoseT<double>{Vector3(std::sin(a), 1 - std::cos(a), 0) / turn, so3::exp_quaternion(Vector3(0, 0, a))};
  };
  for (double x = 0; x < elements; x += 0.1) {
    const Section<double> section = section_at(line, line.piece_at(x), x, poses);
    EXPECT_LE((section.rotation - so3::exp(Vector3(0, 0, turn * x))).norm(), 1e-13) << x;
    EXPECT_NEAR(section.spatial_curvature.z(), turn, 1e-13);
  }
}

}  // namespace
}  // namespace flexarm
