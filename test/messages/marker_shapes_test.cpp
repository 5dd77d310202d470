// Tests the shapes, arrows and trails that show a simulation in rviz.
#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "flexarm/scene/point_spring.h"
#include "flexarm/scene/urdf_reader.h"
#include "messages/conversions.h"
#include "messages/marker_messages.h"
#include "messages/shown_arm.h"
#include "messages/state_messages.h"
#include "scene/scene_builder.h"

namespace flexarm::messages {
namespace {

std::set<std::string> names(const MarkerArray& message) {
  std::set<std::string> names;
  for (const Marker& marker : message.markers)
    if (marker.action == Marker::ADD) names.insert(marker.ns);
  return names;
}

/// Returns how far the points of a marker reach along a line. Checks their largest distance from the line.
double reach_along(const Marker& marker, const Vector3& from, const Vector3& along) {
  double farthest = 0;
  for (const geometry_msgs::Point& point : marker.points)
    farthest = std::max(farthest, (to_vector(point) - from).dot(along.normalized()));
  return farthest;
}

// The robot description that rviz shows has no barrels and rods.
TEST(CylinderMarkers, ShowBarrelAndRod) {
  const scene::ReadResult read = scene::read_scene_text(
      "<robot name='boom'><link name='world'/><link name='boom'><inertial><mass value='1'/>"
      "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
      "<joint name='hinge' type='continuous'><parent link='world'/><child link='boom'/><axis xyz='0 1 0'/></joint>"
      "<cylinder name='lift' from='world' from_at='0 0 -1' to='boom' to_at='1 0 -1'>"
      "<barrel radius='0.1' length='0.7'/></cylinder></robot>",
      "boom.urdf");
  ASSERT_TRUE(read.scene) << scene::to_text(read.diagnostics);
  const Simulation simulation(*read.scene);
  MarkerMessages messages(simulation, "frame", {}, [](const std::string& text) { ADD_FAILURE() << text; });
  const MarkerArray message = shown(messages);
  const Marker *barrel = find(message, "lift_barrel"), *rod = find(message, "lift_rod");
  ASSERT_TRUE(barrel && rod);
  EXPECT_EQ(barrel->type, Marker::CYLINDER);
  EXPECT_DOUBLE_EQ(barrel->scale.x, 0.2);
  EXPECT_DOUBLE_EQ(barrel->scale.z, 0.7);
  EXPECT_LT((to_vector(barrel->pose.position) - Vector3(0.35, 0, -1)).norm(), 1e-12);
  EXPECT_LT((to_vector(rod->pose.position) - Vector3(1 - 0.3, 0, -1)).norm(), 1e-12);
  EXPECT_LT(rod->scale.x, barrel->scale.x);
}

TEST_F(Markers, HaveAllThatThereIs) {
  MarkerMessages messages = this->messages();
  simulation_.command_effort(0, 5);
  simulation_.apply_wrenches({{2, {2, 0, 0}, {{0, 0, 3}, Vector3::Zero()}, false, {}}});
  shown(messages);
  step(5);
  const MarkerArray message = shown(messages);
  EXPECT_EQ(names(message), (std::set<std::string>{"boom", "trails", "joint efforts", "applied wrenches", "reactions",
                                                   "masses", "text", "legend"}));
  std::set<std::pair<std::string, int>> ids;
  for (const Marker& marker : message.markers) {
    EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second) << marker.ns << marker.id;
    EXPECT_EQ(marker.header.frame_id, "frame");
    EXPECT_EQ(marker.header.stamp, ros::Time(1));
    for (const geometry_msgs::Point& point : marker.points) EXPECT_TRUE(to_vector(point).allFinite());
    if (marker.type == Marker::TRIANGLE_LIST) EXPECT_EQ(marker.points.size() % 3, 0u);
  }
}

/// Returns the same arm with a rigid boom.
scene::SceneBuilder rigid_arm() {
  scene::SceneBuilder b = arm();
  b.scene.links.back().beam->elements = 0;
  return b;
}

class RigidMarkers : public Markers {
 protected:
  RigidMarkers() : Markers(rigid_arm()) {}
};

TEST_F(RigidMarkers, HaveTheShapeOfTheBeam) {
  MarkerMessages rigid = messages();
  const MarkerArray message = shown(rigid);
  ASSERT_TRUE(find(message, "boom"));
  double reach = 0;
  for (const auto& point : find(message, "boom")->points) {
    ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
    reach = std::max(reach, point.x);
  }
  EXPECT_NEAR(reach, 2, 1e-6);  // digits of a float
}

TEST_F(RigidMarkers, ComeWithAFrameAtTheTipThatStandsStill) {
  const auto has = [](const tf2_msgs::TFMessage& message) {
    return std::any_of(message.transforms.begin(), message.transforms.end(), [](const auto& transform) {
      return transform.header.frame_id == "boom" && transform.child_frame_id == "boom/tip" &&
             std::abs(transform.transform.translation.x - 2) < 1e-12;
    });
  };
  const StateMessages rigid(simulation_, "");
  EXPECT_TRUE(has(rigid.static_transforms(ros::Time(1))));
  EXPECT_FALSE(has(rigid.transforms()));
  EXPECT_EQ(rigid.frames().count("boom/tip"), 1u);
}

// A spring between points is a line from one point to the other; without one there is no such marker.
TEST(LineMarkers, FollowTheirPoints) {
  scene::SceneBuilder b = arm();
  auto spring = std::make_shared<scene::PointSpring>();
  spring->from = "world";
  spring->from_at = {0, 0, 1};
  spring->to = "boom";
  spring->to_at = {2, 0, 0};
  spring->stiffness = 10;
  b.scene.force_elements.push_back(spring);
  Simulation simulation(b.scene);
  MarkerMessages messages(simulation, "frame", {}, [](const std::string&) {});
  for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
  const MarkerArray message = shown(messages);
  const Marker* line = find(message, "lines");
  ASSERT_NE(line, nullptr);
  ASSERT_EQ(line->points.size(), 2u);
  EXPECT_EQ(line->points[0].z, 1);
  const Vector3 tip = simulation.probe_pose(0).position;
  EXPECT_NEAR(line->points[1].x, tip.x(), 1e-12);
  EXPECT_NEAR(line->points[1].z, tip.z(), 1e-12);
}

TEST_F(Markers, HaveWhatIsChosen) {
  simulation_.command_effort(0, 5);
  step(5);
  for (const std::string& name : MarkerChoice::names()) {
    MarkerChoice choice{false, false, false, false, false, false, false, false, false, false, false};
    *choice.find(name) = true;
    MarkerMessages messages = this->messages(choice);
    shown(messages);
    EXPECT_LE(names(shown(messages)).size(), 1u) << name;
  }
  EXPECT_EQ(MarkerChoice().find("beam"), nullptr);
}

// A mass that nothing else shows is a ball, with a line to it from the link's origin.
TEST(MassMarkers, ShowLinksWithoutShapes) {
  constexpr double kMass = 4, kRadius = 0.1;
  scene::SceneBuilder b("pendulum");
  b.body("bob", kMass, {0, 0, -2}, 0.4 * kMass * kRadius * kRadius * Matrix3::Identity());
  b.body("box", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
  b.scene.links.back().visuals.push_back({Pose(), scene::BoxShape{{1, 1, 1}}});
  b.joint("hinge", JointKind::Continuous, "world", "bob").axis = Vector3::UnitY();
  b.joint("other", JointKind::Continuous, "world", "box").axis = Vector3::UnitY();
  Simulation simulation(b.scene);
  simulation.set_joint_state({{0, M_PI / 2, {}}});
  MarkerMessages messages(simulation, "frame", {}, nullptr);
  const MarkerArray message = shown(messages);
  const auto is_ball = [](const Marker& marker) { return marker.type == Marker::SPHERE; };
  ASSERT_EQ(std::count_if(message.markers.begin(), message.markers.end(), is_ball), 1);
  const Marker& ball = *std::find_if(message.markers.begin(), message.markers.end(), is_ball);
  EXPECT_EQ(ball.ns, "masses");
  EXPECT_DOUBLE_EQ(ball.scale.x, 2 * kRadius);
  EXPECT_LT((to_vector(ball.pose.position) - Vector3(-2, 0, 0)).norm(), 1e-12);
  const auto lines = std::find_if(message.markers.begin(), message.markers.end(), [](const Marker& marker) {
    return marker.ns == "masses" && marker.type == Marker::LINE_LIST;
  });
  ASSERT_NE(lines, message.markers.end());
  const auto& points = lines->points;
  EXPECT_TRUE(std::any_of(points.begin(), points.end(), [](const geometry_msgs::Point& point) {
    return (to_vector(point) - Vector3(-2, 0, 0)).norm() < 1e-12;
  }));
}

// Grounds have no end, but are drawn where the arm is: the box around all that it reaches, 2 m each way, and a margin.
TEST(GroundMarkers, AreAsLargeAsNeeded) {
  scene::SceneBuilder b = arm();
  b.scene.grounds.push_back({"floor", Vector3::UnitZ(), -0.5});
  const Simulation simulation(b.scene);
  MarkerMessages messages(simulation, "frame", {}, nullptr);
  const MarkerArray message = shown(messages);
  const Marker* plane = find(message, "grounds");
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->type, Marker::CUBE);
  EXPECT_EQ(plane->pose.position.z, -0.5);
  for (const double size : {plane->scale.x, plane->scale.y}) {
    EXPECT_GT(size, 4);
    EXPECT_LT(size, 6);
  }
}

// The longest arrow is the largest force since the start, and the legend names this force. A reset starts anew.
TEST_F(Markers, ArrowsAreAsLongAsForcesAreLarge) {
  MarkerMessages messages = this->messages();
  const double radius = pictures::scene_extent(simulation_).radius;
  const auto force = [&](double z) {
    simulation_.apply_wrenches({{2, {2, 0, 0}, {{0, 0, z}, Vector3::Zero()}, false, {}}});
    return shown(messages);
  };
  const auto length = [&](const MarkerArray& message) {
    return reach_along(*find(message, "applied wrenches"), simulation_.tip_pose(2).position, Vector3::UnitZ());
  };
  EXPECT_EQ(find(force(0), "applied wrenches"), nullptr);
  EXPECT_NEAR(length(force(8)), kLongestArrow * radius, 1e-9);
  EXPECT_NEAR(length(force(2)), kLongestArrow * radius / 4, 1e-9);
  const MarkerArray message = force(2);
  EXPECT_TRUE(std::any_of(message.markers.begin(), message.markers.end(),
                          [](const Marker& marker) { return marker.text == "8 N"; }));
  messages.begin_anew();
  EXPECT_NEAR(length(force(2)), kLongestArrow * radius, 1e-9);
}

TEST_F(Markers, MomentsGoAroundTheirAxes) {
  MarkerMessages messages = this->messages();
  simulation_.command_effort(0, 5);
  step(1);
  const Marker efforts = *find(shown(messages), "joint efforts");
  const double circle = kLargestCircle * pictures::scene_extent(simulation_).radius;
  double turn = 0;
  for (const geometry_msgs::Point& point : efforts.points) {
    EXPECT_NEAR(std::hypot(point.x, point.y), circle, 0.2 * circle);
    turn = std::max(turn, std::atan2(point.y, point.x));
  }
  EXPECT_GT(turn, 3);  // the arrow goes around the axis
}

// rviz keeps what it has drawn, so the sender must delete markers that are gone.
TEST_F(Markers, WhatIsNotThereAnyMoreIsDeleted) {
  MarkerMessages messages = this->messages();
  simulation_.apply_wrenches({{2, {2, 0, 0}, {{0, 0, 3}, Vector3::Zero()}, false, {}}});
  EXPECT_NE(find(shown(messages), "applied wrenches"), nullptr);
  simulation_.apply_wrenches({});
  for (int k = 0; k < 2; ++k) {  // the deletion is repeated, in case a message was lost
    const MarkerArray message = shown(messages);
    EXPECT_EQ(find(message, "applied wrenches"), nullptr);
    EXPECT_NE(find(message, "applied wrenches", Marker::DELETE), nullptr);
  }
}

TEST_F(Markers, TrailsAreBounded) {
  MarkerChoice choice;
  choice.trail_duration = 0.5;
  MarkerMessages messages = this->messages(choice);
  simulation_.command_effort(0, 5);
  for (int n = 0; n < 100; ++n) {
    step(1);
    shown(messages);
  }
  const Marker trail = *find(shown(messages), "trails");
  EXPECT_NEAR(static_cast<double>(trail.points.size()), 51, 1);
  EXPECT_LT((to_vector(trail.points.back()) - simulation_.tip_pose(2).position).norm(), 1e-12);
  EXPECT_NEAR(trail.colors.front().a, 0, 0.05);
  EXPECT_EQ(trail.colors.back().a, 1);
  simulation_.reset();
  EXPECT_EQ(find(shown(messages), "trails"), nullptr);
  // Trails stay bounded, however many messages are made.
  choice.trail_duration = 50;
  MarkerMessages others = this->messages(choice);
  for (int n = 0; n < 1500; ++n) {
    step(1);
    others.make(ros::Time(1), 1.0);
  }
  EXPECT_LE(find(shown(others), "trails")->points.size(), 502u);
  EXPECT_GE(find(shown(others), "trails")->points.size(), 100u);
}

TEST_F(Markers, ShapesThatCannotBeReadAreToldOfOnceAndTheTubeStays) {
  scene::SceneBuilder b = arm();
  scene::LinkDescription& boom = b.scene.links.back();
  boom.visuals.push_back({Pose(), scene::MeshShape{"package://no_such_package/boom.stl"}});
  Simulation simulation(b.scene);
  MarkerMessages broken(simulation, "frame", {}, [this](const std::string& text) { warnings_.push_back(text); });
  MarkerMessages plain = messages();
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("'boom'"), std::string::npos);
  EXPECT_NE(warnings_[0].find("package://no_such_package/boom.stl"), std::string::npos);
  const std::vector<geometry_msgs::Point> points = find(shown(broken), "boom")->points,
                                          expected = find(shown(plain), "boom")->points;
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_TRUE(points[i].x == expected[i].x && points[i].y == expected[i].y && points[i].z == expected[i].z) << i;
  EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(Markers, ShapesTakeTheTubesPlace) {
  scene::SceneBuilder b = arm();
  b.scene.links.back().visuals.push_back({{Vector3(1, 0, 0), Quaternion::Identity()}, scene::BoxShape{{2, 0.3, 0.2}}});
  Simulation simulation(b.scene);
  MarkerMessages messages(simulation, "frame", {}, nullptr);
  const Marker boom = *find(shown(messages), "boom");
  double y = 0, z = 0;
  for (const geometry_msgs::Point& point : boom.points) {
    y = std::max(y, std::abs(point.y));
    z = std::max(z, std::abs(point.z));
  }
  EXPECT_NEAR(y, 0.15, 1e-12);
  EXPECT_NEAR(z, 0.1, 1e-12);
}

}  // namespace
}  // namespace flexarm::messages
