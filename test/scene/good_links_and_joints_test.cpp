/// Tests that links, beams and joints of a good scene are read into the right members of their descriptions.
#include <fstream>

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

constexpr double kRoundOff = 1e-15;

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

TEST(GoodScene, RestitutionOfStops) {
  const ReadResult result =
      read(good_scene_with("upper=\"3\" effort=\"0\"", "upper=\"3\" restitution=\"0.6\" effort=\"0\""));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(joint(*result.scene, "finger").limits->restitution, 0.6);
  EXPECT_FALSE(joint(*result.scene, "shoulder").limits->restitution);
}

}  // namespace flexarm::scene
