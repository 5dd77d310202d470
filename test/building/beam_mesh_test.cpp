// Tests meshes of flexible links.
#include "building/beam_mesh.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "math/pi.h"
#include "math/shape_functions.h"
#include "math/so3.h"
#include "support/scene_builder.h"

namespace flexarm {
namespace {

using namespace test;
using scene::CentrelinePiece;

scene::BeamDescription beam_along(const std::vector<Vector3>& points, std::optional<int> elements, int order) {
  scene::BeamDescription beam;
  for (const Vector3& point : points) {
    CentrelinePiece piece;
    piece.to = point;
    beam.centreline.push_back(piece);
  }
  beam.elements = elements;
  beam.order = order;
  beam.section = section(1, 1, 1, 1, 2, 1, 1);
  return beam;
}
BeamMesh mesh_of(const scene::BeamDescription& beam, const std::vector<double>& attachments = {}) {
  return mesh_beam(beam, Centreline(beam.centreline, beam.section_y), attachments);
}

TEST(BeamMesh, NodesLieExactlyOnTheArc) {
  scene::BeamDescription beam = beam_along({}, 3, 2);
  CentrelinePiece arc;
  arc.kind = CentrelinePiece::Kind::Arc;
  arc.center = Vector3(0, 2, 0);
  arc.to = Vector3(2, 2, 0);
  arc.twist = 0.5;
  beam.centreline = {arc};
  for (int order = 1; order <= 4; ++order) {
    beam.order = order;
    const BeamMesh mesh = mesh_of(beam);
    ASSERT_EQ(mesh.nodes.size(), 3u * order + 1);
    ASSERT_EQ(mesh.elements.size(), 3u);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const int e = std::min<int>(i / order, 2), k = static_cast<int>(i) - e * order;
      const double angle = kPi / 6 * (e + 0.5 * (1 + node_coordinate(order + 1, k)));
      EXPECT_NEAR(mesh.nodes[i].arc_length, 2 * angle, 1e-14);
      EXPECT_LE((mesh.nodes[i].pose.position - Vector3(2 * std::sin(angle), 2 - 2 * std::cos(angle), 0)).norm(), 1e-14);
      EXPECT_EQ(mesh.nodes[i].welded_to, -1);
    }
    for (std::size_t e = 0; e < 3; ++e) {
      ASSERT_EQ(mesh.elements[e].nodes.size(), static_cast<std::size_t>(order) + 1);
      for (int i = 0; i <= order; ++i) EXPECT_EQ(mesh.elements[e].nodes[i], static_cast<int>(e) * order + i);
    }
    EXPECT_NEAR(mesh.elements.back().end, kPi, 1e-14);
  }
}

TEST(BeamMesh, BordersAtAttachmentsAndPieces) {
  const BeamMesh mesh = mesh_of(beam_along({{1, 0, 0}, {3, 0, 0}}, 8, 1), {0.25, 2.5, 0.0, 3.0, 0.25 + 1e-13});
  for (const double s : {0.0, 0.25, 1.0, 2.5, 3.0}) EXPECT_NEAR(mesh.nodes[mesh.node_at(s)].arc_length, s, 1e-12);
  EXPECT_EQ(mesh.elements.size(), 8u);
  EXPECT_EQ(mesh.nodes.size(), 9u);  // without a kink, no node occurs twice
  // The elements are distributed in proportion to the lengths 0.25, 0.75, 1.5, 0.5, with at least one on each.
  std::vector<double> lengths;
  double from = 0;
  for (const MeshElement& element : mesh.elements) lengths.push_back(element.end - from), from = element.end;
  for (const double length : lengths) EXPECT_LE(length, 0.5 + 1e-12);
}

TEST(BeamMesh, NodeAtIsTheNearestAndTheFirstOfTwo) {
  const BeamMesh mesh = mesh_of(beam_along({{1, 0, 0}, {1, 2, 0}}, 6, 2), {0.3, 2.2});
  const auto distance = [&](std::size_t i, double s) { return std::abs(mesh.nodes[i].arc_length - s); };
  for (double s = -0.5; s < 3.5; s += 0.01) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (distance(i, s) < distance(nearest, s) - 1e-12) nearest = i;
    EXPECT_EQ(mesh.node_at(s), static_cast<int>(nearest)) << s;
  }
  const int kink = mesh.node_at(1);
  EXPECT_EQ(mesh.nodes[kink + 1].welded_to, kink) << "a kink has two nodes";
  EXPECT_EQ(mesh.node_at(1 + 1e-15), kink);
}

TEST(BeamMesh, FewerElementsThanIntervalsGivesOneEach) {
  EXPECT_EQ(mesh_of(beam_along({{1, 0, 0}}, 1, 2), {0.2, 0.7}).elements.size(), 3u);
}

TEST(BeamMesh, KinkHasTwoWeldedNodes) {
  const BeamMesh mesh = mesh_of(beam_along({{1, 0, 0}, {1, 1, 0}}, 4, 2));
  ASSERT_EQ(mesh.nodes.size(), 2u * (2 * 2 + 1));
  int welded = -1;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].welded_to >= 0) welded = static_cast<int>(i);
  ASSERT_EQ(welded, 5);
  EXPECT_EQ(mesh.nodes[5].welded_to, 4);
  EXPECT_LE((mesh.nodes[5].pose.position - mesh.nodes[4].pose.position).norm(), 1e-15);
  EXPECT_LE((mesh.nodes[4].pose.orientation * Vector3::UnitX() - Vector3::UnitX()).norm(), 1e-14);
  EXPECT_LE((mesh.nodes[5].pose.orientation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-14);
  EXPECT_EQ(mesh.elements[2].nodes.front(), 5);
}

// An attachment at a kink must keep the kink, whatever round-off its arc length has.
TEST(BeamMesh, AttachmentAtAKink) {
  for (const double first : {1.0, 0.1, 0.3, 1.0 / 3, 0.7, 2.1}) {
    const scene::BeamDescription beam = beam_along({{first, 0.2, 0.05}, {first, 1.3, 0.05}}, 4, 2);
    const Centreline centreline(beam.centreline, beam.section_y);
    const double kink = centreline.piece_ends()[0];
    for (const double offset : {0.0, 1e-16, -1e-16, 4e-16, -4e-16, 1e-12, -1e-12}) {
      const BeamMesh mesh = mesh_beam(beam, centreline, {kink + offset, centreline.nearest({first, 0.2, 0.05})});
      int welded = 0;
      for (const MeshNode& node : mesh.nodes) welded += node.welded_to >= 0;
      EXPECT_EQ(welded, 1) << first << ", offset " << offset;
      // Every element is straight along its own piece.
      for (const MeshElement& element : mesh.elements) {
        const Pose &a = mesh.nodes[element.nodes.front()].pose, &b = mesh.nodes[element.nodes.back()].pose;
        EXPECT_LE(a.orientation.angularDistance(b.orientation), 1e-7) << first << ", offset " << offset;
      }
    }
  }
}

TEST(BeamMesh, AutomaticElementCount) {
  for (int order = 1; order <= 4; ++order) {
    EXPECT_GE(automatic_element_count(order, 0), 1);
    EXPECT_GE(automatic_element_count(order, 10), automatic_element_count(order, 1));
    const BeamMesh mesh = mesh_of(beam_along({{1, 0, 0}}, {}, order));
    EXPECT_EQ(static_cast<int>(mesh.elements.size()), automatic_element_count(order, 0));
  }
  EXPECT_GT(automatic_element_count(1, 0), automatic_element_count(2, 0));
}

// The nodes are on the line of centroids; the lengths are those of the reference line.
TEST(BeamMesh, OffsetCentroid) {
  scene::BeamDescription beam = beam_along({{2, 0, 0}}, 2, 2);
  scene::MatrixSection matrix;
  matrix.stiffness = Matrix6::Identity();
  const Matrix3 d = so3::hat(Vector3(0, 0.1, 0.2));
  matrix.inertia << 3 * Matrix3::Identity(), -3 * d, 3 * d, Matrix3::Identity() - 3 * d * d;
  beam.section = matrix;
  const BeamMesh mesh = mesh_of(beam);
  EXPECT_LE((mesh.centroid - Vector3(0, 0.1, 0.2)).norm(), 1e-15);
  for (const MeshNode& node : mesh.nodes)
    EXPECT_LE((node.pose.position - Vector3(node.arc_length, 0.1, 0.2)).norm(), 1e-14);
  const BeamElement<3> element = beam_element<3>(mesh, mesh.elements[0], beam);
  EXPECT_NEAR(element.mass.sum(), 3 * 1.0, 1e-13);
  double length = 0;
  for (const auto& point : element.stiffness_points) length += point.weight;
  EXPECT_NEAR(length, 1, 1e-14);
}

TEST(BeamElement, MassIsConsistent) {
  const scene::BeamDescription beam = beam_along({{1.2, 0, 0}}, 1, 1);
  const BeamMesh mesh = mesh_of(beam);
  const BeamElement<2> element = beam_element<2>(mesh, mesh.elements[0], beam);
  Eigen::Matrix2d expected;  // m L / 6 [2 1; 1 2]
  expected << 2, 1, 1, 2;
  EXPECT_LE(largest(element.mass - 2 * 1.2 / 6 * expected), 1e-14);
}

}  // namespace
}  // namespace flexarm
