/// Tests that each element of a good scene is read into the right members of its description.
#include <cmath>
#include <fstream>

#include "flexarm/scene/bushing.h"
#include "flexarm/scene/point_spring.h"
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

constexpr double kRoundOff = 1e-15;

SceneDescription good_scene() {
  const ReadResult result = read(kGoodScene);
  EXPECT_TRUE(result.diagnostics.empty()) << to_text(result.diagnostics);
  return result.scene.value();
}

const JointDescription& joint(const SceneDescription& scene, const std::string& name) {
  for (const JointDescription& joint : scene.joints)
    if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

}  // namespace

TEST(GoodScene, NamesInOrder) {
  const SceneDescription scene = good_scene();
  EXPECT_EQ(scene.name, "arm");
  EXPECT_EQ(scene.file, "scene.urdf");
  EXPECT_EQ(scene.root_link, "world");
  ASSERT_EQ(scene.links.size(), 5u);
  EXPECT_EQ(scene.links[1].name, "upper");
  EXPECT_EQ(scene.links[1].location.line, 13);
  EXPECT_EQ(scene.links[4].name, "tip");
  ASSERT_EQ(scene.joints.size(), 4u);
  EXPECT_EQ(scene.joints[0].location.file, "scene.urdf");
  EXPECT_EQ(scene.joints[0].location.line, 5);
}

TEST(GoodScene, StandardJoint) {
  const SceneDescription scene = good_scene();
  const JointDescription& shoulder = joint(scene, "shoulder");
  EXPECT_EQ(shoulder.kind, JointKind::Revolute);
  EXPECT_EQ(shoulder.parent, "world");
  EXPECT_EQ(shoulder.child, "upper");
  EXPECT_EQ(shoulder.origin.position, Vector3(0, 0, 0.5));
  EXPECT_LT((shoulder.origin.orientation * Vector3::UnitX() - Vector3::UnitY()).norm(), kRoundOff);
  EXPECT_EQ(shoulder.axis, Vector3::UnitZ());
  ASSERT_TRUE(shoulder.limits);
  EXPECT_EQ(shoulder.limits->lower, -1);
  EXPECT_EQ(shoulder.limits->upper, 2);
  EXPECT_EQ(shoulder.limits->velocity, 4);
  EXPECT_EQ(shoulder.effort_limit, 30);
  EXPECT_EQ(shoulder.damping, 0.1);
  EXPECT_EQ(shoulder.friction, 0.2);
  EXPECT_EQ(shoulder.friction_law.law, FrictionDescription::Law::Smooth);
  EXPECT_EQ(shoulder.friction_law.coefficient, 0);
  EXPECT_FALSE(shoulder.mimic);
}

TEST(GoodScene, JointDefaultsMimicAndRelease) {
  const SceneDescription scene = good_scene();
  const JointDescription& elbow = joint(scene, "elbow");
  EXPECT_EQ(elbow.kind, JointKind::Continuous);
  EXPECT_EQ(elbow.axis, Vector3::UnitX());
  EXPECT_FALSE(elbow.limits);
  EXPECT_EQ(elbow.effort_limit, 7);

  const JointDescription& finger = joint(scene, "finger");
  ASSERT_TRUE(finger.mimic);
  EXPECT_EQ(finger.mimic->joint, "shoulder");
  EXPECT_EQ(finger.mimic->multiplier, -2);
  EXPECT_EQ(finger.mimic->offset, 0.5);

  const JointDescription& wrist = joint(scene, "wrist");
  EXPECT_EQ(wrist.kind, JointKind::Universal);
  EXPECT_EQ(wrist.axis, Vector3::UnitY());
  EXPECT_EQ(wrist.axis2, Vector3::UnitZ());
}

TEST(GoodScene, Friction) {
  const std::string dynamics = "<dynamics damping";
  const auto friction_of_shoulder = [&](const std::string& element) {
    return joint(read(good_scene_with(dynamics, element + dynamics)).scene.value(), "shoulder").friction_law;
  };
  const FrictionDescription coulomb =
      friction_of_shoulder(R"(<friction law="coulomb" coefficient="0.2" radius="0.01"/>)");
  EXPECT_EQ(coulomb.law, FrictionDescription::Law::Coulomb);
  EXPECT_EQ(coulomb.coefficient, 0.2);
  EXPECT_EQ(coulomb.radius, 0.01);
  EXPECT_EQ(friction_of_shoulder("<friction/>").law, FrictionDescription::Law::Smooth);
  EXPECT_EQ(friction_of_shoulder(R"(<friction law="coulomb"/>)").coefficient, 0);
  EXPECT_EQ(friction_of_shoulder(R"(<friction law="coulomb"/>)").static_ratio, 1);
  EXPECT_EQ(friction_of_shoulder(R"(<friction static="1.5"/>)").stribeck_speed, 0.01);
  const FrictionDescription falling = friction_of_shoulder(R"(<friction static="1.4" stribeck="0.05"/>)");
  EXPECT_EQ(falling.static_ratio, 1.4);
  EXPECT_EQ(falling.stribeck_speed, 0.05);
}

TEST(GoodScene, RestitutionBySpeed) {
  const SceneDescription scene =
      read(good_scene_with("restitution=\"0.4\"", "restitution=\"0.9 0.6\" speeds=\"0 2\"")).scene.value();
  EXPECT_EQ(scene.contacts[0].restitution.values, (std::vector<double>{0.9, 0.6}));
  EXPECT_EQ(scene.contacts[0].restitution.speeds, (std::vector<double>{0, 2}));
}

TEST(GoodScene, RigidLink) {
  const SceneDescription scene = good_scene();
  EXPECT_FALSE(scene.links[0].inertial);
  const RigidInertia& inertia = scene.links[1].inertial.value();
  EXPECT_EQ(inertia.mass, 2);
  EXPECT_EQ(inertia.center_of_mass, Vector3(0.1, 0, 0));
  // A quarter turn about z exchanges the moments about x and y.
  EXPECT_LT((inertia.inertia - Matrix3(Vector3(0.02, 0.01, 0.025).asDiagonal())).norm(), kRoundOff);
}

TEST(GoodScene, Beam) {
  const SceneDescription scene = good_scene();
  const BeamDescription& beam = scene.links[2].beam.value();
  EXPECT_EQ(beam.elements, 4);
  EXPECT_EQ(beam.order, 3);
  ASSERT_EQ(beam.centreline.size(), 2u);
  EXPECT_EQ(beam.centreline[0].kind, CentrelinePiece::Kind::Line);
  EXPECT_EQ(beam.centreline[0].to, Vector3(1, 0, 0));
  EXPECT_EQ(beam.centreline[0].twist, 0.5);
  EXPECT_EQ(beam.centreline[1].kind, CentrelinePiece::Kind::Arc);
  EXPECT_EQ(beam.centreline[1].center, Vector3(1, 1, 0));
  EXPECT_EQ(beam.centreline[1].location.line, 31);
  EXPECT_EQ(beam.section_y, Vector3(0, 1, 0));
  const GeometricSection& section = std::get<GeometricSection>(beam.section);
  EXPECT_EQ(std::get<Tube>(section.shape).outer_radius, 0.02);
  EXPECT_EQ(std::get<Tube>(section.shape).inner_radius, 0.01);
  EXPECT_EQ(section.material.young, 70e9);
  EXPECT_EQ(section.material.poisson, 0.33);
  EXPECT_EQ(section.material.density, 2700);
  EXPECT_EQ(beam.stiffness_proportional_damping, 1e-4);
  EXPECT_EQ(beam.mass_proportional_damping, 0.1);
}

TEST(GoodScene, BeamDefaultsAndDirectSection) {
  const SceneDescription scene = good_scene();
  const BeamDescription& beam = scene.links[4].beam.value();
  EXPECT_FALSE(beam.elements);
  EXPECT_EQ(beam.order, 2);
  EXPECT_FALSE(beam.section_y);
  EXPECT_EQ(beam.stiffness_proportional_damping, 0);
  const DirectSection& s = std::get<DirectSection>(beam.section);
  const double read[] = {s.ea, s.ga2, s.ga3, s.gj, s.ei2, s.ei3, s.mass, s.j1, s.j2, s.j3};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(read[i], i + 1);
}

TEST(GoodScene, OtherSections) {
  const std::string tube = R"(<tube outer_radius="0.02" inner_radius="0.01"/>)";
  const auto shape = [&](const std::string& element) {
    const ReadResult result = read(good_scene_with(tube, element));
    EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
    return std::get<GeometricSection>(result.scene->links[2].beam->section).shape;
  };
  EXPECT_EQ(std::get<Circle>(shape(R"(<circle radius="0.1"/>)")).radius, 0.1);
  EXPECT_EQ(std::get<Rectangle>(shape(R"(<rectangle width="0.1" height="0.2"/>)")).height, 0.2);
  EXPECT_EQ(std::get<BoxTube>(shape(R"(<box_tube width="0.1" height="0.2" thickness="0.01"/>)")).thickness, 0.01);
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

TEST(GoodScene, ReleasesOfEveryKind) {
  const auto kind = [](const std::string& name) {
    std::string text = R"(<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="floating">
      <parent link="a"/><child link="b"/><release kind="NAME"/></joint></robot>)";
    const ReadResult result = read(text.replace(text.find("NAME"), 4, name));
    EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
    return result.scene->joints[0].kind;
  };
  EXPECT_EQ(kind("spherical"), JointKind::Spherical);
  EXPECT_EQ(kind("cylindrical"), JointKind::Cylindrical);
  EXPECT_EQ(kind("planar"), JointKind::Planar);
  EXPECT_EQ(kind("free"), JointKind::Floating);
}

TEST(GoodScene, CoordinateSuffixesCountTheFreedoms) {
  const auto suffixes = [](JointKind kind) {
    JointDescription joint;
    joint.kind = kind;
    return coordinate_suffixes(joint);
  };
  EXPECT_TRUE(suffixes(JointKind::Fixed).empty());
  EXPECT_EQ(suffixes(JointKind::Prismatic), std::vector<std::string>{""});
  EXPECT_EQ(suffixes(JointKind::Planar), (std::vector<std::string>{"/x", "/y", "/rz"}));
  EXPECT_EQ(suffixes(JointKind::Spherical), (std::vector<std::string>{"/rx", "/ry", "/rz"}));
  EXPECT_EQ(suffixes(JointKind::Cylindrical), (std::vector<std::string>{"/1", "/2"}));
  EXPECT_EQ(suffixes(JointKind::Floating).size(), 6u);
}

TEST(GoodScene, FileAndTextAgree) {
  const std::string path = testing::TempDir() + "flexarm_good_scene.urdf";
  std::ofstream(path) << kGoodScene;
  const ReadResult file = read_scene_file(path), text = read_scene_text(kGoodScene, path);
  ASSERT_TRUE(file.scene && text.scene);
  EXPECT_EQ(file.scene->file, path);
  EXPECT_EQ(file.scene->links.size(), text.scene->links.size());
  EXPECT_EQ(file.scene->joints.back().location.line, text.scene->joints.back().location.line);
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

TEST(GoodScene, DampingOfStrains) {
  const std::string damping = R"(<damping stiffness_proportional="1e-4" mass_proportional="0.1"/>)";
  const ReadResult result = read(
      good_scene_with(damping, R"(<damping axial="1e-4" shear_z="2e-4" bending_y="4e-4" mass_proportional="3"/>)"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const BeamDescription& beam = result.scene->links[2].beam.value();
  EXPECT_EQ(beam.stiffness_proportional_damping, 4e-4);
  Vector6 shares;
  shares << 0.25, 0, 0.5, 0, 1, 0;
  EXPECT_EQ(beam.damping_shares, shares);
  EXPECT_EQ(beam.mass_proportional_damping, 3);
  EXPECT_EQ(good_scene().links[2].beam->damping_shares, Vector6::Ones());
}

TEST(GoodScene, MaxwellElements) {
  const ReadResult result =
      read(good_scene_with(R"(<damping stiffness_proportional="1e-4" mass_proportional="0.1"/>)",
                           R"(<damping mass_proportional="3"> <maxwell modulus_ratio="0.4" relaxation_time="0.02"/>
                                <maxwell modulus_ratio="0.08" relaxation_time="0.5"/> </damping>)"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const BeamDescription& beam = result.scene->links[2].beam.value();
  EXPECT_EQ(beam.mass_proportional_damping, 3);
  ASSERT_EQ(beam.maxwell.size(), 2u);
  EXPECT_EQ(beam.maxwell[0].modulus_ratio, 0.4);
  EXPECT_EQ(beam.maxwell[1].relaxation_time, 0.5);
}

TEST(GoodScene, Prestrain) {
  const BeamDescription beam = good_scene().links[4].beam.value();
  EXPECT_EQ(beam.prestrain[0].value()(5), 1e-4);
  EXPECT_EQ(beam.prestrain[4].value()(0.5), 0.1);
  for (const int other : {1, 2, 3, 5}) EXPECT_FALSE(beam.prestrain[other]);
}

TEST(GoodScene, Hub) {
  const BeamDescription beam = good_scene().links[4].beam.value();
  ASSERT_EQ(beam.hubs.size(), 1u);
  EXPECT_EQ(beam.hubs[0].end, HubDescription::End::End);
  EXPECT_EQ(beam.hubs[0].mass, 0.1);
  EXPECT_EQ(beam.hubs[0].inertia, Vector3(1e-3, 1e-3, 2e-3));
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

TEST(GoodScene, RestitutionOfStops) {
  const ReadResult result =
      read(good_scene_with("upper=\"3\" effort=\"0\"", "upper=\"3\" restitution=\"0.6\" effort=\"0\""));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(joint(*result.scene, "finger").limits->restitution, 0.6);
  EXPECT_FALSE(joint(*result.scene, "shoulder").limits->restitution);
}

}  // namespace flexarm::scene
