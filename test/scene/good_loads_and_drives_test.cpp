/// Tests that <simulation>, loads, contacts, springs, drives, servos and sensors of a good scene are read into the
/// right members of their descriptions.
#include <cmath>

#include "flexarm/scene/bushing.h"
#include "flexarm/scene/point_spring.h"
#include "scene/scene_text.h"

namespace flexarm::scene {

TEST(GoodScene, RestitutionBySpeed) {
  const SceneDescription scene =
      read(good_scene_with("restitution=\"0.4\"", "restitution=\"0.9 0.6\" speeds=\"0 2\"")).scene.value();
  EXPECT_EQ(scene.contacts[0].restitution.values, (std::vector<double>{0.9, 0.6}));
  EXPECT_EQ(scene.contacts[0].restitution.speeds, (std::vector<double>{0, 2}));
}

TEST(GoodScene, Simulation) {
  const SceneDescription scene = good_scene();
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -1.62));
  EXPECT_EQ(scene.integrator.scheme, "edmc2");
  EXPECT_EQ(scene.integrator.step, 0.002);
  EXPECT_EQ(scene.integrator.tolerance, 1e-9);
  EXPECT_EQ(scene.integrator.max_iterations, 11);
  EXPECT_EQ(scene.integrator.max_halvings, 3);
  EXPECT_EQ(scene.integrator.rho_infinity, 0.9);
  ASSERT_EQ(scene.initial_joints.size(), 1u);
  EXPECT_EQ(scene.initial_joints[0].coordinate, "shoulder");
  EXPECT_EQ(scene.initial_joints[0].position, 0.3);
  EXPECT_EQ(scene.initial_joints[0].velocity, 0.4);
  ASSERT_EQ(scene.initial_links.size(), 1u);
  EXPECT_EQ(scene.initial_links[0].link, "forearm");
  EXPECT_EQ(scene.initial_links[0].linear, Vector3(1, 2, 3));
  EXPECT_EQ(scene.initial_links[0].angular, Vector3(4, 5, 6));
  ASSERT_EQ(scene.motions.size(), 1u);
  EXPECT_EQ(scene.motions[0].coordinate, "wrist/2");
  EXPECT_EQ(scene.motions[0].position(1), std::sin(1.0));
  ASSERT_EQ(scene.efforts.size(), 1u);
  EXPECT_EQ(scene.efforts[0].history(0.5), 3);
  EXPECT_EQ(scene.efforts[0].history(1.5), 4);
  ASSERT_EQ(scene.probes.size(), 1u);
  EXPECT_EQ(scene.probes[0].name, "end");
  EXPECT_EQ(scene.probes[0].link, "tip");
  EXPECT_EQ(scene.probes[0].at, Vector3(0, 0, 1));
}

TEST(GoodScene, Loads) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.loads.size(), 1u);
  EXPECT_EQ(scene.loads[0].link, "forearm");
  EXPECT_EQ(scene.loads[0].at, Vector3(1, 0, 0));
  EXPECT_EQ(scene.loads[0].force, Vector3(0, 0, 50));
  EXPECT_EQ(scene.loads[0].moment, Vector3(1, 2, 3));
  EXPECT_EQ(scene.loads[0].frame, LoadFrame::Follower);
  EXPECT_EQ(scene.loads[0].history(0.5), 25);
  ASSERT_EQ(scene.distributed_loads.size(), 1u);
  EXPECT_EQ(scene.distributed_loads[0].link, "tip");
  EXPECT_EQ(scene.distributed_loads[0].force, Vector3(0, 0, 1));
  EXPECT_EQ(scene.distributed_loads[0].frame, LoadFrame::World);
  EXPECT_EQ(scene.distributed_loads[0].history(3), 9);
}

TEST(GoodScene, SimulationDefaults) {
  const ReadResult result = read(R"(<robot name="r"><link name="base"/></robot>)");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->gravity, Vector3(0, 0, -9.81));
  EXPECT_EQ(result.scene->integrator.scheme, "auto");
  EXPECT_EQ(result.scene->integrator.step, 1e-3);
  EXPECT_FALSE(result.scene->integrator.rho_infinity);
  EXPECT_EQ(result.scene->root_link, "base");
}

TEST(GoodScene, Sensors) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.sensors.size(), 2u);
  const Sensor& cell = scene.sensors[0];
  EXPECT_EQ(cell.name, "cell");
  EXPECT_EQ(cell.kind, SensorKind::Wrench);
  EXPECT_EQ(cell.link, "hand");
  EXPECT_EQ(cell.at, Vector3(0, 0, 0.1));
  EXPECT_EQ(cell.rate, 500);
  EXPECT_EQ(cell.noise, std::vector<double>{0.05});
  EXPECT_EQ(cell.bias, (std::vector<double>{0.1, 0, 0, 0, 0, 0.2}));
  EXPECT_EQ(cell.seed, 7);
  EXPECT_EQ(cell.location.line, 74);
  EXPECT_EQ(scene.sensors[1].kind, SensorKind::Strain);
  EXPECT_EQ(scene.sensors[1].rate, 0);
  EXPECT_TRUE(scene.sensors[1].noise.empty());
}

TEST(GoodScene, SensorsOfContactsHaveGroups) {
  const ReadResult result = read(good_scene_with(
      "</robot>", "<sensor name=\"bumper\" kind=\"contact\" link=\"hand\" group=\" tip  floor\"/> </robot>"));
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  const Sensor& bumper = result.scene.value().sensors.back();
  EXPECT_EQ(bumper.kind, SensorKind::Contact);
  EXPECT_EQ(bumper.group, (std::vector<std::string>{"tip", "floor"}));
}

// A <sensor> with a <parent> is in the form that was once proposed for URDF. It belongs to other programs.
TEST(GoodScene, SensorsOfOthersAreLeftAlone) {
  const ReadResult result = read(
      good_scene_with("</robot>", "<sensor name=\"camera\"> <parent link=\"hand\"/> <camera/> </sensor> </robot>"));
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene.value().sensors.size(), 2u);
}

TEST(GoodScene, SpringBetweenPoints) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.force_elements.size(), 2u);
  const auto& spring = dynamic_cast<const PointSpring&>(*scene.force_elements[0]);
  EXPECT_EQ(spring.name, "tie");
  EXPECT_EQ(spring.from, "upper");
  EXPECT_EQ(spring.from_at, Vector3(0.1, 0, 0));
  EXPECT_EQ(spring.to, "hand");
  EXPECT_EQ(spring.to_at, Vector3(0, 0, 1));
  EXPECT_EQ(spring.stiffness, 20);
  EXPECT_EQ(spring.rest_length, 0.3);
  EXPECT_EQ(spring.damping, 0.5);
}

TEST(GoodScene, Bushing) {
  const SceneDescription scene = good_scene();
  const auto& bushing = dynamic_cast<const BushingDescription&>(*scene.force_elements.at(1));
  EXPECT_EQ(bushing.from, "forearm");
  EXPECT_EQ(bushing.stiffness.diagonal(), (Eigen::Matrix<double, 6, 1>() << 9, 9, 9, 1, 1, 1).finished());
  EXPECT_NEAR(bushing.axes.y(), std::sin(0.05), 1e-12);
  EXPECT_EQ(bushing.damping(3, 3), 0);
}

TEST(GoodScene, Contacts) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.grounds.size(), 1u);
  EXPECT_EQ(scene.grounds[0].name, "floor");
  EXPECT_EQ(scene.grounds[0].normal, Vector3(0, 0, 1));
  EXPECT_EQ(scene.grounds[0].offset, -30);
  ASSERT_EQ(scene.contacts.size(), 1u);
  EXPECT_EQ(scene.contacts[0].first, "*");
  EXPECT_EQ(scene.contacts[0].second, "floor");
  EXPECT_EQ(scene.contacts[0].restitution.values, std::vector<double>{0.4});
  EXPECT_TRUE(scene.contacts[0].restitution.speeds.empty());
  EXPECT_EQ(scene.contacts[0].friction, 0.25);
  EXPECT_EQ(scene.contacts[0].stiffness, 1e4);
  ASSERT_EQ(scene.no_contacts.size(), 1u);
  EXPECT_EQ(scene.no_contacts[0].first, "hand");
}

TEST(GoodScene, Springs) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.springs.size(), 1u);
  EXPECT_EQ(scene.springs[0].coordinate, "elbow");
  EXPECT_EQ(scene.springs[0].stiffness, 2);
  EXPECT_EQ(scene.springs[0].rest, 0.1);
  EXPECT_EQ(scene.springs[0].damping_ratio, 0);
  EXPECT_EQ(scene.springs[0].location.line, 70);
  const ReadResult damped = read(good_scene_with("rest=\"0.1\"", "damping_ratio=\"0.2\""));
  ASSERT_TRUE(damped.scene) << to_text(damped.diagnostics);
  EXPECT_EQ(damped.scene->springs[0].damping_ratio, 0.2);
}

TEST(GoodScene, Drive) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.drives.size(), 1u);
  const DriveDescription& drive = scene.drives[0];
  EXPECT_EQ(drive.coordinate, "elbow");
  EXPECT_EQ(drive.gear, 50);
  EXPECT_EQ(drive.rotor_inertia, 2e-4);
  EXPECT_EQ(drive.stiffness, 900);
  EXPECT_EQ(drive.damping, 0.4);
  EXPECT_EQ(drive.damping_ratio, 0);
  EXPECT_EQ(drive.backlash, 1e-3);
  EXPECT_EQ(drive.friction, 0.3);
  EXPECT_EQ(drive.efficiency, 0.8);
  EXPECT_EQ(drive.effort_limit, 40);
  EXPECT_EQ(drive.velocity_limit, 3);
  EXPECT_FALSE(drive.axis);
}

TEST(GoodScene, GearOfATransmission) {
  const ReadResult result = read(good_scene_with("gear=\"50\" ", ""));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->drives[0].gear, 50);
}

// Exporters write a reduction of 1 for every joint, whatever its gear is. So an explicit gear takes precedence.
TEST(GoodScene, AnExplicitGearGoesBeforeThatOfATransmission) {
  const ReadResult result = read(good_scene_with("gear=\"50\" ", "gear=\"60\" "));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->drives[0].gear, 60);
  EXPECT_EQ(to_text(result.diagnostics),
            "scene.urdf:71: warning: <drive> of robot: gear counts, not the <mechanicalReduction> of the joint's "
            "<transmission>: 'elbow' (60, line 73 has 50)\n");
}

TEST(GoodScene, OneWarningNamesAllGearsThatAreNotThoseOfTransmissions) {
  std::string text = "<robot name=\"r\"> <link name=\"l0\"/>";
  for (int i = 1; i < 4; ++i) {
    const std::string n = std::to_string(i), before = std::to_string(i - 1);
    text += "\n<link name=\"l" + n +
            "\"> <inertial> <mass value=\"1\"/> <inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" "
            "ixz=\"0\" iyz=\"0\"/> </inertial> </link> <joint name=\"j" +
            n + "\" type=\"continuous\"> <parent link=\"l" + before + "\"/> <child link=\"l" + n +
            "\"/> <axis xyz=\"0 1 0\"/> </joint> <transmission name=\"t" + n + "\"> <joint name=\"j" + n +
            "\"/> <actuator name=\"m\"> <mechanicalReduction>1</mechanicalReduction> "
            "</actuator> </transmission> <drive joint=\"j" +
            n + "\" gear=\"" + (i == 2 ? "1" : "100") + "\"/>";
  }
  const ReadResult result = read(text + "</robot>");
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->drives[0].gear, 100);
  EXPECT_EQ(to_text(result.diagnostics),
            "scene.urdf:2: warning: <drive> of robot: gear counts, not the <mechanicalReduction> of the joint's "
            "<transmission>: 'j1' (100, line 2 has 1), 'j3' (100, line 4 has 1)\n");
}

TEST(GoodScene, Servo) {
  const SceneDescription scene = good_scene();
  ASSERT_EQ(scene.servos.size(), 1u);
  const ServoDescription& servo = scene.servos[0];
  EXPECT_EQ(servo.coordinate, "elbow");
  EXPECT_EQ(servo.mode, ServoDescription::Mode::Position);
  EXPECT_EQ(servo.kp, 70);
  EXPECT_EQ(servo.kd, 8);
  EXPECT_EQ(servo.ki, 3);
  EXPECT_EQ(servo.set_point.value()(1), std::sin(1.0));
  EXPECT_EQ(servo.feedforward.value()(1), 0.5);
  EXPECT_EQ(servo.feedforward->derivative(1), 0.1);
  EXPECT_EQ(servo.effort_limit, 25);
  EXPECT_EQ(servo.anti_windup, 0.3);
  EXPECT_EQ(servo.side, ServoDescription::Side::Link);
  EXPECT_EQ(servo.sample_time, 0.004);
  EXPECT_EQ(servo.delay, 0.003);
  ASSERT_EQ(servo.other_modes.size(), 1u);
  EXPECT_EQ(servo.other_modes[0].mode, ServoDescription::Mode::Velocity);
  EXPECT_EQ(servo.other_modes[0].kp, 9);
  EXPECT_EQ(servo.other_modes[0].kd, 0);
  EXPECT_EQ(servo.other_modes[0].ki, 2);
  EXPECT_EQ(servo.other_modes[0].anti_windup, 0.2);
}

TEST(GoodScene, LoadOnAPartOfALine) {
  const std::string load = "<distributed_load link=\"tip\"";
  const ReadResult result = read(good_scene_with(load, load + " from=\"0.25\" to=\"0.5\""));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->distributed_loads[0].from, 0.25);
  EXPECT_EQ(result.scene->distributed_loads[0].to, 0.5);
  EXPECT_FALSE(good_scene().distributed_loads[0].from);
}

}  // namespace flexarm::scene
