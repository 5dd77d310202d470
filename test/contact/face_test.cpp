// Tests by which face a corner enters a box, a cylinder or a convex hull.
#include <gtest/gtest.h>

#include "contact/point_contact.h"
#include "support/polytopes.h"

namespace flexarm::test {
namespace {

const ContactShape kBox{Box{{0.3, 0.2, 0.1}}, Pose()};
const ContactShape kCylinder{Cylinder{0.3, 0.1}, Pose()};

TEST(Faces, AreEnteredWhereThePointComesIn) {
  EXPECT_EQ(entered_face(kBox, {0.1, 0.1, 0.2}, {0.1, 0.1, 0.05}), 5);
  EXPECT_EQ(entered_face(kBox, {0.1, 0.1, -0.2}, {0.1, 0.1, -0.05}), 6);
  EXPECT_EQ(entered_face(kBox, {-0.4, 0, 0}, {0.4, 0, 0}), 2) << "right through";
  EXPECT_EQ(entered_face(kBox, {0.1, 0.1, 0.2}, {0.1, 0.1, 0.15}), 0) << "not there yet";
  EXPECT_EQ(entered_face(kBox, {0.35, 0.1, 0.2}, {0.35, 0.1, 0}), 0) << "passes by";
  EXPECT_EQ(entered_face(kBox, {0.4, 0, 0.12}, {0.2, 0, 0.05}), 1) << "over the edge, beside it last";
  EXPECT_EQ(entered_face(kBox, {0.31, 0, 0.2}, {0.2, 0, 0.05}), 5) << "over the edge, above it last";
  EXPECT_EQ(entered_face(kCylinder, {0.1, 0.1, 0.2}, {0.1, 0.1, 0.05}), 2);
  EXPECT_EQ(entered_face(kCylinder, {0, 0.4, 0}, {0, 0.2, 0}), 1);
}

TEST(Faces, AreNotThoseThatThePointPassesBeside) {
  const ContactShape thin{Box{{0.05, 0.005, 0.05}}, Pose()};
  EXPECT_EQ(entered_face(thin, {0.06, -0.001, 0}, {0.04, 0.02, 0}), 0) << "over the middle of another side";
  EXPECT_EQ(entered_face(thin, {0.06, 0.001, 0}, {0.04, 0.003, 0}), 1);
  EXPECT_EQ(entered_face(kBox, {0.32, 0.18, 0}, {0.28, 0.3, 0}), 0) << "past the edge";
}

// Corners of equal boxes that stand on each other lie on edges.
TEST(Faces, OfEdgesAreThoseTowardsWhichThePointMoves) {
  EXPECT_EQ(entered_face(kBox, {0.3, -0.2, 0.11}, {0.3, -0.2, 0.09}), 5);
  EXPECT_EQ(entered_face(kBox, {0.3, -0.2, 0.1}, {0.3, -0.2, 0.09}), 5) << "which it touches to begin with";
  EXPECT_EQ(entered_face(kBox, {0.3, -0.2, 0.1}, {0.3, -0.19, 0.1}), 4);
  EXPECT_EQ(entered_face(kBox, {0.3, -0.2, 0.1 - 1e-6}, {0.3, -0.2, 0.09}), 5)
      << "in which it is a little to begin with";
  EXPECT_TRUE(is_over_face(kBox, 5, {0.3, -0.2, 0.09}));
  EXPECT_FALSE(is_over_face(kBox, 5, {0.3, -0.2001, 0.09}));
}

TEST(Faces, BoundHalfSpacesAndEndlessCylinders) {
  EXPECT_NEAR(beyond_face(kBox, 5).distance({5, 5, 0.15}).value, 0.05, 1e-15);
  EXPECT_NEAR(beyond_face(kBox, 4).distance({5, -0.15, 5}).value, -0.05, 1e-14);  // tolerance: round-off of 5
  EXPECT_NEAR(beyond_face(kCylinder, 1).distance({0.4, 0, 7}).value, 0.1, 1e-15);
  EXPECT_NEAR(beyond_face(kCylinder, 3).distance({4, 0, -0.3}).value, 0.2, 1e-15);
}

TEST(Shapes, AreMetByWhatGoesThroughThem) {
  const ContactShape plate{Box{{0.001, 1, 1}}, Pose()}, rod{Cylinder{0.01, 1}, Pose()};
  EXPECT_TRUE(passes_through(plate, {-0.3, 0, 0}, {0.5, 0.1, 0}, 0.02));
  EXPECT_TRUE(passes_through(plate, {-0.3, 0.99, 0}, {0.3, 1.015, 0}, 0.02)) << "by its edge";
  EXPECT_FALSE(passes_through(plate, {-0.3, 1.03, 0}, {0.3, 1.03, 0}, 0.02)) << "beside it";
  EXPECT_FALSE(passes_through(plate, {-0.3, 0, 0}, {-0.03, 0, 0}, 0.02)) << "in front of it";
  EXPECT_TRUE(passes_through(rod, {-0.015, 0, 0}, {0.015, 0, 0}, 0));
  EXPECT_FALSE(passes_through(rod, {-0.015, 0.011, 0}, {0.015, 0.011, 0}, 0));
}

// When a point moves on to another face of a hull, this face takes over. The roof has two faces on top.
TEST(Faces, OfHullsAreLeftForTheNextOnes) {
  const ContactShape roof{Hull{std::make_shared<Polytope>(roof_polytope({0.3, 0.2, 0.1}, 0.03))}, Pose()};
  EXPECT_EQ(entered_face(roof, {0.1, 0, 0.3}, {0.1, 0, 0.1}), 5);
  EXPECT_EQ(entered_face(roof, {-0.1, 0, 0.3}, {-0.1, 0, 0.1}), 6);
  EXPECT_EQ(entered_face(roof, {0.4, 0, 0}, {0.2, 0, 0}), 1);
  EXPECT_EQ(entered_face(roof, {0.1, 0.3, 0.12}, {0.1, 0.1, 0.11}), 3) << "by the gable";
  EXPECT_EQ(entered_face(roof, {0.29, 0.3, 0.12}, {0.29, 0.1, 0.12}), 0) << "above the slope";
  EXPECT_NEAR(beyond_face(roof, 5).distance({0.3, 5, 0.1}).value, 0, 1e-14);
  ContactLaw law;
  law.stiffness = 100;
  // Over the ridge, the second slope takes over from the first. The second slope is nearer to the point, and the
  // difference of the two elastic energies is let go.
  const Vector3 over(-0.003, 0, 0.12);  // a slope is inclined by one tenth
  PointMotion motion;
  motion.begin = over;
  motion.end = {-0.01, 0, 0.119};
  PointMemory memory;
  memory.face = 5;
  const FeltShape felt = felt_shape(roof, law, 0, motion, memory);
  EXPECT_EQ(felt.face, 6);
  const double before = -beyond_face(roof, 5).distance(over).value, after = -felt.shape.distance(over).value;
  EXPECT_GT(before, after);
  EXPECT_NEAR(felt.let_go, 50 * (before * before - after * after), 1e-15);
}

// A point that leaves its face sideways is released, and its stored energy is dissipated. A point that leaves through
// its face is forgotten.
TEST(Faces, AreKeptUntilThePointIsOut) {
  ContactLaw law;
  law.stiffness = 100;
  law.frequency = 10;
  const auto felt = [&](const Vector3& from, const Vector3& to, int face, double within = 0) {
    PointMotion motion;
    motion.begin = from;
    motion.end = to;
    PointMemory memory;
    memory.face = face;
    memory.within = within;
    return felt_shape(kBox, law, 0, motion, memory);
  };
  const FeltShape kept = felt({0.29, 0, 0.02}, {0.28, 0, 0.03}, 5);
  EXPECT_EQ(kept.face, 5) << "though another face is nearer";
  EXPECT_EQ(kept.let_go, 0);
  const FeltShape beside = felt({0.31, 0, 0.08}, {0.32, 0, 0.08}, 5);
  EXPECT_FALSE(beside.is_felt);
  EXPECT_NEAR(beside.let_go, 0.5 * 100 * 0.02 * 0.02, 1e-15);
  EXPECT_NEAR(felt({0.31, 0, 0.08}, {0.32, 0, 0.08}, 5, 0.005).let_go, 0.5 * 100 * 0.015 * 0.015, 1e-15);
  const FeltShape inside = felt({0.05, 0, 0.08}, {0.05, 0, 0.09}, 0);
  EXPECT_EQ(inside.face, 5) << "of a start inside the nearest one";
}

// A block slides off a table, so that the table's edge enters the block through its front. The block's bottom must
// count as the entered face, since it lies on the edge. The front counts for points that it can lie on, e.g. a corner
// of another block.
TEST(Faces, AreThoseThatACornerCanLieOn) {
  const ContactShape block{Box{{0.3, 0.2, 0.1}}, Pose()};
  ContactLaw law;
  law.stiffness = 100;
  law.frequency = 10;
  law.depth = 0.01;
  PointMotion motion;
  motion.begin = {0.301, 0, -0.0981};
  motion.end = {0.299, 0, -0.0981};
  motion.outwards.col(0) = Vector3::UnitX();  // outward direction of the table
  motion.outwards.col(2) = Vector3::UnitZ();
  const FeltShape laid = felt_shape(block, law, 0, motion, {});
  EXPECT_EQ(laid.face, 6);
  EXPECT_NEAR(laid.radius, -0.0019, 1e-15) << "felt from here on";
  PointAction action = point_action(block, law, 0, motion, {}, false);
  EXPECT_EQ(action.memory.face, 6);
  EXPECT_NEAR(action.memory.within, 0.0019, 1e-15);
  EXPECT_EQ(action.dissipated, 0);
  EXPECT_EQ(stored_energy(block, law, 0, motion.end, action.memory), 0);
  PointMotion down = motion;
  down.begin = {0.29, 0, -0.0981};
  down.end = {0.29, 0, -0.0971};
  down.duration = 1e-3;
  action = point_action(block, law, 0, down, action.memory, false);
  const double hardened = 0.001 / (0.99 * 0.99);  // p / (1 - s^2)^2, s = 0.1
  EXPECT_NEAR(stored_energy(block, law, 0, down.end, action.memory), 0.5 * 100 * hardened * hardened, 1e-15);
  EXPECT_NEAR(action.wrench.head<3>().dot(down.begin - down.end), stored_energy(block, law, 0, down.end, action.memory),
              1e-15);
  motion.outwards.col(0) = -Vector3::UnitX();
  EXPECT_EQ(felt_shape(block, law, 0, motion, {}).face, 6) << "of another table, that looks this way, so low";
  motion.begin.z() = motion.end.z() = -0.097;
  EXPECT_EQ(felt_shape(block, law, 0, motion, {}).face, 1) << "of a higher one";
  motion.outwards.col(0) = Vector3::UnitX();
  motion.begin.z() = motion.end.z() = -0.05;
  EXPECT_EQ(felt_shape(block, law, 0, motion, {}).face, 1) << "too far above the bottom";
}

}  // namespace
}  // namespace flexarm::test
