// Tests messages of sensors of tendons.
#include "messages/sensor_messages.h"

#include <gtest/gtest.h>

#include "flexarm/scene/urdf_reader.h"

namespace flexarm::messages {
namespace {

TEST(SensorMessages, OfTendonsHaveLengthAndTension) {
  const scene::ReadResult read = scene::read_scene_text(
      R"(<robot name="held"> <link name="world"/>
        <joint name="rail" type="prismatic"> <parent link="world"/> <child link="mass"/> <origin xyz="0 0 -2"/>
          <axis xyz="0 0 1"/> <limit lower="-1" upper="1" effort="0" velocity="0"/> </joint>
        <link name="mass"> <inertial> <mass value="3"/>
          <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
        <tendon name="rope" tension="50"> <via link="mass"/> <via link="world"/> </tendon>
        <sensor name="cell" kind="tendon" tendon="rope"/>
        <simulation> <motion joint="rail" position="0"/> </simulation> </robot>)",
      "held.urdf");
  const Simulation simulation(read.scene.value());
  const auto message = std::get<TendonStamped>(sensor_message(simulation, 0, ros::Time(3), "left/"));
  EXPECT_EQ(message.header.stamp, ros::Time(3));
  EXPECT_EQ(message.header.frame_id, "left/mass");
  EXPECT_NEAR(message.length, 2, 1e-14);
  EXPECT_NEAR(message.tension, 50, 1e-13);
}

}  // namespace
}  // namespace flexarm::messages
