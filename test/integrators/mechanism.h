#pragma once
/// A mechanism that contains joints, beams, loads and drives of every kind, and random states of any model.

#include "building/model_builder.h"
#include "elements/random_element.h"
#include "joints/joint_kinematics.h"
#include "simulation/observables.h"
#include "support/loops.h"

namespace flexarm::test {

/// Full stiffness and inertia matrices, with the centre of mass off the reference line.
inline scene::MatrixSection random_section(RandomSource& random) {
  scene::MatrixSection section;
  section.stiffness = 10 * random.positive_definite<6>();
  const double mass = 1.5;
  const Matrix3 offset = so3::hat(Vector3(0, 0.05, -0.08));
  section.inertia.topLeftCorner<3, 3>() = mass * Matrix3::Identity();
  section.inertia.topRightCorner<3, 3>() = -mass * offset;
  section.inertia.bottomLeftCorner<3, 3>() = mass * offset;
  section.inertia.bottomRightCorner<3, 3>() = 0.1 * random.positive_definite<3>() - mass * offset * offset;
  return section;
}

/// A scene with chains and trees of links, every kind of joint on rigid and flexible masters with offsets, mimicking
/// and prescribed coordinates, stops, friction, loads of every kind, gravity, damping, and elements of every order. If
/// `floating`, nothing is fixed to the world, loaded, driven or damped.
inline scene::SceneDescription every_joint_scene(bool floating) {
  using scene::JointKind;
  RandomSource random(11);
  SceneBuilder builder;
  const auto body = [&](const std::string& name) {
    builder.body(name, 0.8, 0.1 * random.vector(), 0.05 * random.positive_definite<3>());
  };
  const auto beam = [&](const std::string& name, const std::vector<Vector3>& points, int elements, int order,
                        bool offset) {
    scene::Section section = test::section(40, 20, 6, 8, 1.4, 0.2, 0.1);
    if (offset) section = random_section(random);
    scene::BeamDescription& description = builder.beam(name, points, section, elements, order);
    if (!floating) {
      description.stiffness_proportional_damping = 0.02;
      description.mass_proportional_damping = 0.1;
      description.prestrain = {std::nullopt,      TimeFunction(-0.03), TimeFunction::parse("0.1*t"),
                               TimeFunction(0.2), std::nullopt,        TimeFunction::parse("0.3*cos(t)")};
    }
  };
  const auto joint = [&](const std::string& name, JointKind kind, const std::string& parent, const std::string& child,
                         const Vector3& origin) -> scene::JointDescription& {
    scene::JointDescription& out = builder.joint(name, kind, parent, child, origin, random.unit());
    out.origin.orientation = random.rotation(3);
    if (!floating) out.damping = 0.3, out.friction = 0.2;
    return out;
  };

  body("base");
  beam("upper", {Vector3(1, 0, 0), Vector3(1, 0.8, 0)}, 2, 2, false);
  body("hand");
  beam("finger", {Vector3(0.6, 0.1, 0)}, 2, 1, true);
  body("nail");
  body("car");
  body("roller");
  beam("flag", {Vector3(0, 0.7, 0)}, 1, 3, true);
  body("plate");
  beam("follower", {Vector3(0.5, 0, 0.2)}, 1, 4, false);
  body("wheel");
  body("echo_body");
  body("second_car");
  body("rock");
  body("runner");
  beam("mast", {Vector3(0, 0.3, 0.5)}, 1, 2, false);

  joint("base", floating ? JointKind::Floating : JointKind::Fixed, "world", "base", Vector3(0.1, 0.2, 0.3));
  joint("shoulder", JointKind::Revolute, "base", "upper", Vector3(0.3, 0, 0));
  joint("wrist", JointKind::Universal, "upper", "hand", Vector3(1.05, 0, 0.1)).axis2 = random.unit();
  joint("ball", JointKind::Spherical, "hand", "finger", Vector3(0, 0.2, 0));
  joint("glue", JointKind::Fixed, "finger", "nail", Vector3(0.6, 0.1, 0.05));
  joint("slider", JointKind::Prismatic, "upper", "car", Vector3(0.5, 0, 0.1));
  joint("roll", JointKind::Cylindrical, "car", "roller", Vector3(0.1, 0, 0));
  joint("flight", JointKind::Floating, "nail", "flag", Vector3(0, 0, 0.4));
  joint("plane", JointKind::Planar, "flag", "plate", Vector3(0, 0.7, 0));
  joint("follow", JointKind::Revolute, "flag", "follower", Vector3(0, 0, 0)).mimic = scene::Mimic{"shoulder", 0.7, 0.1};
  joint("drive", JointKind::Revolute, "upper", "wheel", Vector3(1, 0.8, 0));
  joint("echo", JointKind::Continuous, "hand", "echo_body", Vector3(0, 0, 0.1)).mimic =
      scene::Mimic{"follow", -0.5, 0.2};  // a mimic of a mimic
  joint("second_slider", JointKind::Prismatic, "rock", "second_car", Vector3(0, 0.3, 0)).mimic =
      scene::Mimic{"slider", 1.3, 0};
  const auto slide = [&](const std::string& name, const std::string& parent, const std::string& child, double start,
                         JointKind rotation) {
    joint(name, JointKind::Slide, parent, child, Vector3::Zero()).slide = scene::SlideDescription{start, rotation};
  };
  slide("run", "upper", "runner", 0.4, JointKind::Spherical);
  slide("walk", "finger", "mast", 0.35, JointKind::Revolute);
  joint("throw", JointKind::Floating, "world", "rock", Vector3(0, 2, 0));
  builder.body("tappet", 0.8, {0.02, -0.05, 0.03}, 0.1 * Matrix3::Identity());
  scene::JointDescription& cam =
      builder.joint("cam", JointKind::Slide, "upper", "tappet", Vector3::Zero(), Vector3(2, 1, 2) / 3);
  cam.slide = scene::SlideDescription{0.3, JointKind::Cam};
  cam.slide->offset = {0.05, -0.1, 0.15};
  cam.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.2, -0.1));
  // Two loops: the follower's tip is connected to the hand; the mast turns and slides on the plate. The second loop
  // joint has the roles of parent and child swapped.
  close_loop(builder, "clasp", JointKind::Universal, "hand", "follower", Vector3(0.5, 0, 0.2), Vector3(0.6, 0, 0.8))
      .axis2 = Vector3(0, 0.8, 0.6);
  scene::JointDescription& ring =
      close_loop(builder, "ring", JointKind::Cylindrical, "plate", "mast", Vector3(0, 0.3, 0.5), Vector3(2, 1, 2) / 3);
  std::swap(ring.parent, ring.child);
  std::swap(ring.origin, ring.child_origin);
  if (!floating)
    for (scene::JointDescription& loop : builder.scene.loop_joints) loop.damping = 0.3, loop.friction = 0.2;
  if (floating) return builder.scene;

  builder.scene.gravity = Vector3(0.3, -0.2, -2);
  for (scene::JointDescription& j : builder.scene.joints)
    if (j.name == "slider") j.limits = scene::JointLimits{-3, 3};
  builder.scene.motions.push_back({"drive", TimeFunction::parse("0.4*sin(t)"), {}});
  builder.scene.efforts.push_back({"shoulder", TimeFunction::parse("1+t"), {}});
  builder.scene.efforts.push_back({"ball/ry", TimeFunction(0.4), {}});
  for (const scene::LoadFrame frame : {scene::LoadFrame::World, scene::LoadFrame::Follower}) {
    builder.load("finger", Vector3(0.6, 0.1, 0.1), random.vector(), random.vector(), "1+t", frame);
    builder.load("plate", Vector3(0, 0.1, 0.1), random.vector(), random.vector(), "cos(t)", frame);
    builder.scene.distributed_loads.push_back({"upper", random.vector(), frame, TimeFunction(1.0), {}});
  }
  return builder.scene;
}

/// A random state near the model's initial one. It satisfies the joints, and has random velocities of everything.
inline State random_state(const Model& model, RandomSource& random, double size) {
  State state = initial_state(model);
  std::vector<bool> slave(model.nodes.size(), false);
  for (const JointMap& joint : model.joints) slave[joint.slave] = true;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    ReleasedVector change(released_count(model.joints[j].kind));
    for (int k = 0; k < change.size(); ++k) change[k] = size * random.number();
    state.released[j] = updated(model.joints[j], state.released[j], change);
  }
  for (const Coordinate& coordinate : model.coordinates) {
    double& value = state.released[coordinate.joint].displacement[coordinate.component % 3];
    if (coordinate.motion >= 0) value = model.histories[coordinate.motion](0.0);
  }
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.mimicked >= 0) {
      const Coordinate& master = model.coordinates[coordinate.mimicked];
      state.released[coordinate.joint].displacement[coordinate.component] =
          coordinate.mimic.value(state.released[master.joint].displacement[master.component]);
    }
  std::vector<NodePose> poses(model.nodes.size());
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    NodeState& node = state.nodes[i];
    if (!slave[i]) {
      node.position += size * random.vector();
      node.orientation = (random.rotation(size) * node.orientation).normalized();
    }
    poses[i] = node_pose(node);
    node.velocity = random.vector();
    node.angular_velocity = random.vector();
    node.acceleration = random.vector();
    node.angular_acceleration = random.vector();
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) {  // root to leaf
    const int node = model.joints[j].slave;
    poses[node] = slave_pose(model, static_cast<int>(j), poses, state.released[j]);
    state.nodes[node].position = poses[node].position;
    state.nodes[node].orientation = poses[node].orientation;
  }
  for (MassPointState& point : state.study.mass_points) point = {random.vector(), random.vector()};
  for (Vector6& rate : state.study.strain_rates) rate = random.vector6();
  for (Vector6& strain : state.branch_strains) strain = size * random.vector6();
  return state;
}

}  // namespace flexarm::test
