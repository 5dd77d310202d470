// Tests messages and arrows about contacts, for a block and a ball at rest on a floor.
#include <algorithm>

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"
#include "messages/contact_messages.h"
#include "messages/marker_messages.h"
#include "messages/sensor_messages.h"

namespace flexarm::messages::touching {
namespace {

constexpr double kWeight = 2 * 9.81;

/// A block and a ball on the floor. Neither can turn.
constexpr const char* kScene = R"(<robot name="rest"><link name="world"/><ground name="floor"/>
<joint name="of_block" type="prismatic"><parent link="world"/><child link="block"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<link name="block"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.2 0.1 0.1"/></geometry></collision></link>
<joint name="of_ball" type="prismatic"><parent link="world"/><child link="ball"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<link name="ball"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.05"/></geometry></collision></link>
<contact first="floor" second="ball"/><contact first="*" second="*"/>
<sensor name="bumper" kind="contact" link="block"/>
<simulation><initial joint="of_block" position="0.05"/><initial joint="of_ball" position="0.05"/></simulation></robot>)";

Simulation resting() {
  scene::ReadResult result = scene::read_scene_text(kScene, "rest.urdf");
  Simulation simulation(result.scene.value());
  for (int n = 0; n < 1000; ++n) EXPECT_TRUE(simulation.step().converged);
  return simulation;
}

TEST(ContactMessages, HaveEachPoint) {
  const ContactArray message = contact_message(resting(), ros::Time(3), "left/");
  EXPECT_EQ(message.header.stamp, ros::Time(3));
  EXPECT_EQ(message.header.frame_id, "left/world");
  double on_block = 0, on_floor = 0;
  for (const Contact& contact : message.contacts) {
    EXPECT_GT(contact.penetration, 0);
    if (contact.first == "block") {
      EXPECT_EQ(contact.second, "floor");
      EXPECT_NEAR(contact.normal.z, 1, 1e-12);
      EXPECT_NEAR(std::abs(contact.position.y), 0.05, 1e-12);
      on_block += contact.force.z;
    } else {
      EXPECT_EQ(contact.first, "floor");
      EXPECT_EQ(contact.second, "ball");
      EXPECT_NEAR(contact.normal.z, -1, 1e-12);
      EXPECT_NEAR(contact.position.x, 1, 1e-12);
      on_floor += contact.force.z;
    }
  }
  EXPECT_NEAR(on_block, kWeight, 1e-4);
  EXPECT_NEAR(on_floor, -kWeight, 1e-4);
}

/// Types with the same fields as gazebo_msgs/ContactState and ContactsState.
struct GazeboState {
  std::string info, collision1_name, collision2_name;
  std::vector<geometry_msgs::Wrench> wrenches;
  geometry_msgs::Wrench total_wrench;
  std::vector<geometry_msgs::Vector3> contact_positions, contact_normals;
  std::vector<double> depths;
};
struct GazeboStates {
  std_msgs::Header header;
  std::vector<GazeboState> states;
};

TEST(ContactMessages, OfGazeboHaveAStateForEachPair) {
  const ContactArray contacts = contact_message(resting(), ros::Time(3), "");
  const auto message = gazebo_message<GazeboStates>(contacts);
  EXPECT_EQ(message.header.frame_id, "world");
  ASSERT_EQ(message.states.size(), 2u);
  std::size_t points = 0;
  for (const GazeboState& state : message.states) {
    points += state.depths.size();
    EXPECT_EQ(state.wrenches.size(), state.depths.size());
    EXPECT_EQ(state.contact_positions.size(), state.depths.size());
    EXPECT_EQ(state.contact_normals.size(), state.depths.size());
    const bool is_ball = state.collision2_name == "ball";
    EXPECT_EQ(state.collision1_name, is_ball ? "floor" : "block");
    EXPECT_NEAR(state.total_wrench.force.z, is_ball ? -kWeight : kWeight, 1e-4);
    EXPECT_NEAR(state.total_wrench.torque.y, is_ball ? kWeight : 0.0, 1e-4) << "of -m g at x = 1 about the origin";
  }
  EXPECT_EQ(points, contacts.contacts.size());
}

TEST(ContactMessages, OfSensorsStandInTheLinksFrame) {
  const Simulation simulation = resting();
  const auto message = std::get<geometry_msgs::WrenchStamped>(sensor_message(simulation, 0, ros::Time(3), "left/"));
  EXPECT_EQ(message.header.frame_id, "left/block");
  EXPECT_NEAR(message.wrench.force.z, kWeight, 1e-4);
}

// Each point has an arrow. Its length is proportional to its part of the largest force, and the legend has the same
// colour.
TEST(ContactMessages, AreArrows) {
  const Simulation simulation = resting();
  MarkerChoice choice;
  for (const bool is_shown : {true, false}) {
    choice.contacts = is_shown;
    MarkerMessages markers(simulation, "world", choice, [](const std::string&) {});
    const visualization_msgs::MarkerArray message = markers.make(ros::Time(1), 1.0);
    const auto count = [&](const auto& fits) {
      return std::count_if(message.markers.begin(), message.markers.end(), fits);
    };
    EXPECT_EQ(count([](const auto& marker) { return marker.ns == "contacts" && !marker.points.empty(); }), is_shown);
    EXPECT_EQ(count([](const auto& marker) { return marker.ns == "legend" && marker.text == "contacts"; }), is_shown);
    for (const visualization_msgs::Marker& marker : message.markers) {
      if (marker.ns != "contacts") continue;
      double lowest = 0, highest = 0;
      for (const geometry_msgs::Point& point : marker.points) {
        lowest = std::min(lowest, point.z);
        highest = std::max(highest, point.z);
      }
      // The corners and edge points of the block share its weight. The single point of the ball carries the whole
      // weight, downwards.
      EXPECT_GT(highest, 0.01);
      EXPECT_LT(lowest, -2 * highest);
    }
  }
}

}  // namespace
}  // namespace flexarm::messages::touching
