// Tests models that are built from scenes.
#include "building/model_builder.h"

#include <gtest/gtest.h>

#include "elements/differences.h"
#include "integrators/mechanism.h"
#include "math/pi.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

Pose pose_in(const Model& model, const Attachment& frame) {
  const Pose node =
      frame.node < 0 ? Pose() : Pose{model.nodes[frame.node].position, model.nodes[frame.node].orientation};
  return node * frame.offset;
}
Pose link_pose(const Model& model, const std::string& name) {
  for (const LinkFrame& link : model.links)
    if (link.name == name) return pose_in(model, link.frame);
  throw std::out_of_range(name);
}

void expect_same(const Pose& a, const Pose& b, const std::string& what) {
  EXPECT_LE((a.position - b.position).norm(), 1e-13) << what;
  EXPECT_LE(a.orientation.angularDistance(b.orientation), 1e-7) << what;  // the angle's accuracy at zero
}

// Undeformed and with all coordinates at zero, links have the URDF poses: parent * origin of the joint.
TEST(BuildModel, LinkFramesFollowTheOriginsOfJoints) {
  const scene::SceneDescription scene = every_joint_scene(false);
  const Model model = build_model(scene);
  for (const scene::JointDescription& joint : scene.joints) {
    if (joint.mimic && joint.mimic->offset != 0) continue;
    if (joint.name == "follow" || joint.parent == "follower") continue;
    if (joint.slide && joint.profile) continue;  // beside the line, at the position of its cam profile
    Pose origin = joint.origin;
    if (joint.slide)  // on the first, straight piece of its parent's line
      origin.position =
          joint.slide->start * (joint.parent == "upper" ? Vector3(1, 0, 0) : Vector3(0.6, 0.1, 0)).normalized();
    expect_same(link_pose(model, joint.child), link_pose(model, joint.parent) * origin, joint.name);
  }
}

// Initial positions of each kind of joint, against its formula.
TEST(BuildModel, InitialPositions) {
  SceneBuilder builder;
  builder.body("a", 1, Vector3::UnitX(), Matrix3::Identity());
  builder.body("b", 1, Vector3::UnitX(), Matrix3::Identity());
  builder.body("c", 1, Vector3::UnitX(), Matrix3::Identity());
  RandomSource random(3);
  const Vector3 axis_a = random.unit(), axis_1 = random.unit(), axis_2 = random.unit(), axis_c = random.unit();
  builder.joint("slide", JointKind::Prismatic, "world", "a", random.vector(), axis_a).origin.orientation =
      random.rotation(2);
  scene::JointDescription& cardan = builder.joint("cardan", JointKind::Universal, "a", "b", random.vector(), axis_1);
  cardan.axis2 = axis_2;
  builder.joint("can", JointKind::Cylindrical, "b", "c", random.vector(), axis_c);
  builder.scene.initial_joints = {{"slide", 0.7, 0, {}},
                                  {"cardan/1", 0.4, 0, {}},
                                  {"cardan/2", -0.9, 0, {}},
                                  {"can/1", 0.3, 0, {}},
                                  {"can/2", 1.1, 0, {}}};
  const Model model = build_model(builder.scene);
  const auto turn = [](const Vector3& axis, double angle) {
    return Pose{Vector3::Zero(), so3::exp_quaternion(Vector3(angle * axis))};
  };
  const Pose a = builder.scene.joints[0].origin * Pose{0.7 * axis_a, Quaternion::Identity()};
  const Pose b = a * builder.scene.joints[1].origin * turn(axis_1, 0.4) * turn(axis_2, -0.9);
  const Pose c = b * builder.scene.joints[2].origin * Pose{0.3 * axis_c, Quaternion::Identity()} * turn(axis_c, 1.1);
  expect_same(link_pose(model, "a"), a, "a");
  expect_same(link_pose(model, "b"), b, "b");
  expect_same(link_pose(model, "c"), c, "c");
}

TEST(BuildModel, CoordinatesAreNamedInTheOrderOfTheTree) {
  const Model model = build_model(every_joint_scene(false));
  std::vector<std::string> names;
  for (const Coordinate& coordinate : model.coordinates) names.push_back(coordinate.name);
  const std::vector<std::string> expected = {
      "shoulder", "wrist/1",   "wrist/2",   "ball/rx",       "ball/ry", "ball/rz", "flight/x", "flight/y",
      "flight/z", "flight/rx", "flight/ry", "flight/rz",     "plane/x", "plane/y", "plane/rz", "follow",
      "walk/s",   "walk/1",    "echo",      "slider",        "roll/1",  "roll/2",  "drive",    "run/s",
      "run/rx",   "run/ry",    "run/rz",    "cam/s",         "cam/1",   "throw/x", "throw/y",  "throw/z",
      "throw/rx", "throw/ry",  "throw/rz",  "second_slider", "clasp/1", "clasp/2", "ring/1",   "ring/2"};
  EXPECT_EQ(names, expected);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    for (int k = 0; k < released_count(model.joints[j].kind); ++k) {
      const Coordinate& coordinate = model.coordinates[model.first_coordinate[j] + k];
      EXPECT_EQ(coordinate.joint, static_cast<int>(j));
      EXPECT_EQ(coordinate.component, k);
    }
}

TEST(BuildModel, MastersComeBeforeTheirSlaves) {
  const Model model = build_model(every_joint_scene(false));
  std::vector<int> count(model.nodes.size(), 0), waiting;
  for (const JointMap& joint : model.joints) ++count[joint.slave];
  for (const int times : count) EXPECT_LE(times, 1);
  waiting = count;
  for (const JointMap& joint : model.joints) {
    EXPECT_TRUE(joint.master < 0 || waiting[joint.master] == 0);
    waiting[joint.slave] = 0;
  }
}

TEST(BuildModel, MimicsOfMimicsAreResolved) {
  const Model model = build_model(every_joint_scene(false));
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.name == "echo") {
      EXPECT_EQ(model.coordinates[coordinate.mimicked].name, "shoulder");
      EXPECT_NEAR(coordinate.mimic.multiplier, -0.5 * 0.7, 1e-15);
      EXPECT_NEAR(coordinate.mimic.offset, -0.5 * 0.1 + 0.2, 1e-15);
      EXPECT_NEAR(model.initial_released[coordinate.joint].displacement[0], coordinate.mimic.offset, 1e-15);
    }
}

// ---------------------------------------------------------------- masses

TEST(BuildModel, BodiesOfALinkAreOneCompositeAtItsCentre) {
  RandomSource random(5);
  SceneBuilder builder;
  const double m1 = 1.5, m2 = 0.7;
  const Vector3 c1 = random.vector(), c2 = random.vector();
  const Matrix3 J1 = random.positive_definite<3>(), J2 = random.positive_definite<3>();
  builder.body("arm", m1, c1, J1);
  builder.body("tool", m2, c2, J2);
  builder.joint("hinge", JointKind::Continuous, "world", "arm", random.vector());
  const Pose origin = random.pose(1, 2);
  builder.joint("glue", JointKind::Fixed, "arm", "tool").origin = origin;
  const Model model = build_model(builder.scene);
  int carriers = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    if (inertia.empty()) continue;
    ++carriers;
    EXPECT_NEAR(inertia.mass, m1 + m2, 1e-14);
    EXPECT_EQ(inertia.total_mass, inertia.mass);
    const Pose arm = link_pose(model, "arm");
    const Vector3 centre = (m1 * c1 + m2 * (origin * c2)) / (m1 + m2);
    EXPECT_LE((model.nodes[i].position - arm * centre).norm(), 1e-14);
    const auto steiner = [](double m, const Vector3& d) {
      return Matrix3(m * (d.squaredNorm() * Matrix3::Identity() - d * d.transpose()));
    };
    const Matrix3 turn = origin.orientation.toRotationMatrix();
    const Matrix3 expected =
        J1 + steiner(m1, c1 - centre) + turn * J2 * turn.transpose() + steiner(m2, origin * c2 - centre);
    EXPECT_LE(largest(inertia.rotary - expected), 1e-13);
  }
  EXPECT_EQ(carriers, 1);
}

// Nodes are moved to the centres of mass. Everything on rigid links, loads and probes included, keeps its position.
TEST(BuildModel, RigidLinksHaveOneNodeAndOneJointEach) {
  RandomSource random(6);
  SceneBuilder builder;
  const char* names[] = {"first", "second", "third"};
  std::string parent = "world";
  std::vector<Vector3> centres;
  Pose frame;
  std::vector<Pose> frames;
  for (const char* name : names) {
    centres.push_back(random.vector());
    builder.body(name, 1 + random.number(), centres.back(), random.positive_definite<3>());
    scene::JointDescription& joint = builder.joint(std::string("to_") + name, JointKind::Continuous, parent, name);
    joint.origin = random.pose(1, 2);
    frame = frame * joint.origin;
    frames.push_back(frame);
    parent = name;
  }
  const Vector3 at = random.vector();
  builder.load("second", at, random.vector());
  builder.probe("probe", "third", at);
  const Model model = build_model(builder.scene);
  ASSERT_EQ(model.nodes.size(), std::size(names));
  ASSERT_EQ(model.joints.size(), std::size(names));
  for (std::size_t i = 0; i < std::size(names); ++i) {
    const Pose link = link_pose(model, names[i]);
    EXPECT_LE((link.position - frames[i].position).norm(), 1e-14);
    EXPECT_LE(link.orientation.angularDistance(frames[i].orientation), 1e-7);
    EXPECT_LE((model.nodes[i].position - link * centres[i]).norm(), 1e-14);
  }
  const NodePose& loaded = model.nodes[model.loads.at(0).node];
  EXPECT_LE((loaded.position + loaded.rotation * model.loads[0].arm - frames[1] * at).norm(), 1e-14);
  const ProbeState probe = probe_state(model, initial_state(model), model.initial_velocity, model.probes.at(0));
  EXPECT_LE((probe.pose.position - frames[2] * at).norm(), 1e-14);
}

TEST(BuildModel, BeamMassIsThatOfItsLength) {
  const Model model = build_model(every_joint_scene(false));
  double beams = 0, nodes = 0, bodies = 0;
  for (const LinkFrame& link : model.links)
    if (link.beam) beams += link.beam->mass;
  for (const NodalInertia& inertia : model.inertias) nodes += inertia.total_mass, bodies += inertia.mass;
  EXPECT_NEAR(nodes, beams + bodies, 1e-12);
  EXPECT_NEAR(beams, 1.4 * (1.8 + std::hypot(0.5, 0.2) + std::hypot(0.3, 0.5)) + 1.5 * (std::hypot(0.6, 0.1) + 0.7),
              1e-12);
}

// Scheme and step are not part of the mechanism, so a model is valid for all of them.
TEST(BuildModel, DoesNotDependOnSchemeAndStep) {
  SceneBuilder builder;
  builder.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  builder.joint("rail", JointKind::Prismatic, "world", "block").limits = scene::JointLimits{-1, 1};
  for (const char* scheme : {"em", "hht3", "no scheme at all"}) {
    builder.scene.integrator.scheme = scheme;
    builder.scene.integrator.step *= 0.1;
    const Model model = build_model(builder.scene);
    ASSERT_TRUE(model.coordinates[0].limit);
    EXPECT_EQ(model.coordinates[0].limit->inertia, 2);
  }
}

// ---------------------------------------------------------------- attachments, loads, probes

TEST(BuildModel, LoadsAttachWithTheirOffset) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0), Vector3(1, 1, 0)}, section(1, 1, 1, 1, 1, 1, 1), 4, 2);
  builder.joint("clamp", JointKind::Fixed, "world", "beam", Vector3(0.2, 0.3, 0.4)).origin.orientation =
      so3::exp_quaternion(Vector3(0.3, -0.4, 0.5));
  const Vector3 at(0.6, 0.1, 0.2), force(1, 2, 3);  // off the line, nearest to (0.6, 0, 0)
  builder.load("beam", at, force, Vector3(4, 5, 6));
  builder.load("beam", Vector3(1.1, 0.7, 0), force, Vector3::Zero(), "1", scene::LoadFrame::Follower);
  builder.probe("p", "beam", Vector3(0.37, 0.1, 0));
  const Model model = build_model(builder.scene);
  const Pose link = link_pose(model, "beam");
  ASSERT_EQ(model.loads.size(), 2u);
  const NodePose& node = model.nodes[model.loads[0].node];
  EXPECT_LE((node.position - link * Vector3(0.6, 0, 0)).norm(), 1e-14);
  EXPECT_LE((node.position + node.rotation * model.loads[0].arm - link * at).norm(), 1e-14);
  EXPECT_EQ(model.loads[0].force, force);
  // A follower force is given in the undeformed link frame.
  const NodePose& second = model.nodes[model.loads[1].node];
  EXPECT_LE((second.position - link * Vector3(1, 0.7, 0)).norm(), 1e-14);
  EXPECT_LE((second.rotation * model.loads[1].force - link.orientation * force).norm(), 1e-14);
  const ProbeState probe = probe_state(model, initial_state(model), model.initial_velocity, model.probes.at(0));
  EXPECT_LE((probe.pose.position - link * Vector3(0.37, 0.1, 0)).norm(), 1e-13);
  EXPECT_LE(probe.pose.orientation.angularDistance(link.orientation), 1e-7);
}

TEST(BuildModel, DistributedLoadAddsUpToForceTimesLength) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0), Vector3(1, 1, 0)}, section(1, 1, 1, 1, 1, 1, 1), 3, 3);
  builder.joint("clamp", JointKind::Fixed, "world", "beam");
  builder.scene.distributed_loads.push_back({"beam", Vector3(1, 2, 3), scene::LoadFrame::World, TimeFunction(1.0), {}});
  const Model model = build_model(builder.scene);
  Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
  for (const NodalLoad& load : model.loads)
    sum += load.force, moment += model.nodes[load.node].position.cross(load.force);
  EXPECT_LE((sum - 2 * Vector3(1, 2, 3)).norm(), 1e-14);
  const Vector3 centre = 0.5 * (Vector3(0.5, 0, 0) + Vector3(1, 0.5, 0));
  EXPECT_LE((moment - centre.cross(2 * Vector3(1, 2, 3))).norm(), 1e-13);
}

// ---------------------------------------------------------------- initial velocities

/// Compares node velocities with differences of the initial positions, where every coordinate moves with its rate.
void expect_velocities_of_coordinates(const scene::SceneDescription& scene) {
  const Model model = build_model(scene);
  std::vector<Eigen::VectorXd> unused;
  const auto positions = [&](double h) {
    scene::SceneDescription moved = scene;
    for (scene::InitialJoint& initial : moved.initial_joints) initial.position += h * initial.velocity;
    const Model there = build_model(moved);
    Eigen::VectorXd all(6 * there.nodes.size());
    for (std::size_t i = 0; i < there.nodes.size(); ++i)
      all.segment<6>(6 * i) << there.nodes[i].position,
          cayley::increment(model.nodes[i].orientation, there.nodes[i].orientation);
    return all;
  };
  const Eigen::VectorXd expected = difference(positions);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    EXPECT_LE(largest(model.initial_velocity[i] - expected.segment<6>(6 * i)), 1e-9) << "node " << i;
}

TEST(InitialVelocity, OfEveryCoordinate) {
  scene::SceneDescription scene = every_joint_scene(true);
  scene.loop_joints.clear();  // loops are closed at one position only
  scene.initial_joints = {{"shoulder", 0.3, 0.9, {}}, {"wrist/1", 0.4, -0.6, {}}, {"wrist/2", -0.8, 0.7, {}},
                          {"ball/ry", 0, 0.5, {}},    {"slider", 0.2, 0.4, {}},   {"roll/1", -0.1, 0.8, {}},
                          {"roll/2", 1.2, -0.9, {}},  {"flight/x", 0.3, 0.4, {}}, {"flight/rz", 0, 0.6, {}},
                          {"plane/x", 0.2, -0.5, {}}, {"plane/y", -0.3, 0.3, {}}, {"plane/rz", 0.9, 0.7, {}},
                          {"drive", 0.5, 1.1, {}},    {"throw/y", 0.1, 0.7, {}},  {"base/z", 0.1, 0.3, {}}};
  expect_velocities_of_coordinates(scene);
}

/// A chain of two hinged links to a beam, with the initial field `field` on the last link.
scene::SceneDescription planar_arm(const scene::InitialLink& field) {
  SceneBuilder builder;
  builder.body("arm", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.body("hand", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("shoulder", JointKind::Universal, "world", "arm", Vector3::Zero(), Vector3::UnitZ()).axis2 =
      Vector3::UnitY();
  builder.joint("elbow", JointKind::Planar, "arm", "hand", Vector3(1, 0, 0), Vector3::UnitZ());
  builder.scene.initial_joints.push_back({"shoulder/1", 0.4, 0, {}});
  builder.scene.initial_links = {field};
  return builder.scene;
}

TEST(InitialVelocity, FieldThroughAPlanarJoint) {
  const scene::InitialLink field{"hand", Vector3(-0.3, 0.7, 0), Vector3(0, 0, 1.2), {"s.urdf", 7}};
  const scene::SceneDescription scene = planar_arm(field);
  const Model model = build_model(scene);
  int found = 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const Pose hand = link_pose(model, "hand");
    if ((model.nodes[i].position - hand * Vector3(0.5, 0, 0)).norm() > 1e-12) continue;
    ++found;
    const Vector3 expected = field.linear + field.angular.cross(model.nodes[i].position - hand.position);
    EXPECT_LE((model.initial_velocity[i].head<3>() - expected).norm(), 1e-13);
    EXPECT_LE((model.initial_velocity[i].tail<3>() - field.angular).norm(), 1e-13);
  }
  EXPECT_EQ(found, 1);
}

TEST(InitialVelocity, FieldThroughAUniversalJoint) {
  SceneBuilder builder;
  builder.body("arm", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("shoulder", JointKind::Universal, "world", "arm", Vector3(1, 2, 3), Vector3::UnitZ()).axis2 =
      Vector3::UnitY();
  builder.scene.initial_joints.push_back({"shoulder/2", 0.0, 0, {}});
  builder.scene.initial_links = {{"arm", Vector3::Zero(), Vector3(0, 0.3, 0.8), {}}};
  builder.scene.initial_joints.clear();
  const Model model = build_model(builder.scene);
  EXPECT_LE((model.initial_velocity.back().tail<3>() - Vector3(0, 0.3, 0.8)).norm(), 1e-13);
}

TEST(InitialVelocity, RefusedWhereJointsDoNotAllowIt) {
  for (const scene::InitialLink& field :
       {scene::InitialLink{"hand", Vector3(0, 0, 1), Vector3::Zero(), {"s.urdf", 7}},
        scene::InitialLink{"hand", Vector3::Zero(), Vector3(1, 0, 0), {"s.urdf", 7}},
        scene::InitialLink{"arm", Vector3(1, 0, 0), Vector3::Zero(), {"s.urdf", 7}}}) {
    try {
      build_model(planar_arm(field));
      ADD_FAILURE();
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find("s.urdf:7"), std::string::npos) << error.what();
    }
  }
}

// A mimicking joint has the rate that a field gives to the joint that it mimics.
TEST(InitialVelocity, MimicFollowsAField) {
  SceneBuilder builder;
  builder.body("arm", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.body("hand", 1, Vector3(0.5, 0, 0), Matrix3::Identity());
  builder.joint("shoulder", JointKind::Continuous, "world", "arm");
  builder.joint("elbow", JointKind::Continuous, "arm", "hand", Vector3(1, 0, 0)).mimic =
      scene::Mimic{"shoulder", 0.5, 0};
  builder.scene.initial_links = {{"arm", Vector3::Zero(), Vector3(0, 0, 2), {}}};
  const Model model = build_model(builder.scene);
  EXPECT_NEAR(model.initial_velocity[model.joints[1].slave][5], 2 + 0.5 * 2, 1e-13);
}

TEST(InitialVelocity, RigidFieldOnAFreeBeam) {
  SceneBuilder builder;
  builder.beam("beam", {Vector3(1, 0, 0)}, section(1, 1, 1, 1, 1, 1, 1), 2, 3);
  builder.joint("free", JointKind::Floating, "world", "beam", Vector3(1, 2, 3));
  const scene::InitialLink field{"beam", Vector3(1, -1, 2), Vector3(0.3, 0.5, -0.7), {}};
  builder.scene.initial_links = {field};
  const Model model = build_model(builder.scene);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const Vector3 expected = field.linear + field.angular.cross(model.nodes[i].position - Vector3(1, 2, 3));
    EXPECT_LE((model.initial_velocity[i].head<3>() - expected).norm(), 1e-13);
    EXPECT_LE((model.initial_velocity[i].tail<3>() - field.angular).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace flexarm
