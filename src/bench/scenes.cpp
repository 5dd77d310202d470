#include "bench/scenes.h"

namespace flexarm::bench {
namespace {

using scene::JointKind;

/// Soft enough for steps of 10 ms to resolve all its waves.
const scene::DirectSection kSoftSection{400, 200, 200, 16, 20, 24, 1, 0.2, 0.1, 0.1};

scene::SceneDescription empty_scene(const std::string& name) {
  scene::SceneDescription scene;
  scene.name = name;
  scene.file = name;
  scene.root_link = "world";
  scene.gravity.setZero();
  scene.links.push_back({"world", {}, {}, {}});
  return scene;
}

void add_beam(scene::SceneDescription& scene, const std::string& name, const Vector3& to, const scene::Section& section,
              int elements, int order) {
  scene::LinkDescription link;
  link.name = name;
  link.beam.emplace();
  scene::CentrelinePiece piece;
  piece.to = to;
  link.beam->centreline.push_back(piece);
  link.beam->section = section;
  link.beam->elements = elements;
  link.beam->order = order;
  scene.links.push_back(link);
}

void add_body(scene::SceneDescription& scene, const std::string& name, double mass, const Vector3& centre,
              const Vector3& principal_inertias) {
  scene.links.push_back({name, scene::RigidInertia{mass, centre, principal_inertias.asDiagonal()}, {}, {}});
}

scene::JointDescription& add_joint(scene::SceneDescription& scene, const std::string& name, JointKind kind,
                                   const std::string& parent, const std::string& child,
                                   const Vector3& origin = Vector3::Zero(), const Vector3& axis = Vector3::UnitZ()) {
  scene::JointDescription joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.origin.position = origin;
  joint.axis = axis.normalized();
  scene.joints.push_back(joint);
  return scene.joints.back();
}

void add_load(scene::SceneDescription& scene, const std::string& link, const Vector3& at, const Vector3& force,
              const Vector3& moment, const std::string& history) {
  scene::PointLoad load;
  load.link = link;
  load.at = at;
  load.force = force;
  load.moment = moment;
  load.history = TimeFunction::parse(history);
  scene.loads.push_back(load);
}

/// Joins the tree's parts; `root` connects it to the world.
scene::SceneDescription tree(JointKind root) {
  scene::SceneDescription scene = empty_scene("tree");
  add_beam(scene, "trunk", {2, 0, 0}, kSoftSection, 2, 2);
  add_beam(scene, "arm", {0.3, 1.2, 0.4}, kSoftSection, 1, 2);
  add_beam(scene, "branch", {0.2, -0.5, 1}, kSoftSection, 1, 3);
  add_body(scene, "hand", 0.8, {0.2, 0.1, -0.1}, {0.2, 0.25, 0.3});
  add_body(scene, "rider", 1.1, {-0.1, 0.3, 0.2}, {0.3, 0.2, 0.25});
  add_joint(scene, "root", root, "world", "trunk", Vector3::Zero(), {0, 1, 2});
  add_joint(scene, "elbow", JointKind::Revolute, "trunk", "arm", {2, 0, 0}, {1, 2, 2});
  add_joint(scene, "wrist", JointKind::Fixed, "arm", "hand", {0.3, 1.2, 0.4});
  add_joint(scene, "fork", JointKind::Fixed, "trunk", "branch", {1, 0, 0});
  add_joint(scene, "ball", JointKind::Spherical, "branch", "rider", {0.2, -0.5, 1});
  return scene;
}

}  // namespace

scene::SceneDescription free_tree() {
  scene::SceneDescription scene = tree(JointKind::Floating);
  // Slow enough for no node to turn by 2 pi in 20 s: the total interpolation ends there.
  scene.initial_links.push_back({"trunk", {0.02, -0.01, 0.03}, {0.1, 0.08, 0.16}, {}});
  scene.initial_joints.push_back({"elbow", 0, -0.15, {}});
  scene.initial_joints.push_back({"ball/rx", 0, 1.5, {}});
  return scene;
}

scene::SceneDescription loaded_tree() {
  scene::SceneDescription scene = tree(JointKind::Revolute);
  add_load(scene, "hand", {0, 0, 0}, {3, -4, 5}, {1, 0.5, -0.6}, "(1 - cos(4*t))^2");
  add_load(scene, "branch", {0.2, -0.5, 1}, {-3, 1, 2}, {0, 0, 0}, "sin(3*t)^4");
  for (const char* link : {"hand", "rider"}) scene.probes.push_back({link, link, Vector3(0.2, 0.1, 0.3), {}});
  scene.probes.push_back({"trunk", "trunk", Vector3(2, 0, 0), {}});
  return scene;
}

scene::SceneDescription cantilever(int elements, int order) {
  scene::SceneDescription scene = empty_scene("cantilever");
  add_beam(scene, "beam", {1, 0, 0}, scene::DirectSection{100, 100, 100, 1, 1, 2, 1, 0.02, 0.01, 0.01}, elements,
           order);
  add_joint(scene, "clamp", JointKind::Fixed, "world", "beam");
  return scene;
}

scene::SceneDescription loaded_cantilever() {
  scene::SceneDescription scene = cantilever(2, 2);
  add_load(scene, "beam", {1, 0, 0}, {-1, 2, 3}, {1, -0.5, 0.5}, "1");
  scene.probes.push_back({"tip", "beam", Vector3(1, 0, 0), {}});
  return scene;
}

scene::SceneDescription right_angle_cantilever(int elements, int order) {
  scene::SceneDescription scene = empty_scene("right_angle_cantilever");
  add_beam(scene, "arm", {10, 0, 0}, scene::DirectSection{1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1, 20, 10, 10}, elements,
           order);
  scene::CentrelinePiece up;
  up.to = Vector3(10, 10, 0);
  scene.links.back().beam->centreline.push_back(up);
  add_joint(scene, "clamp", JointKind::Fixed, "world", "arm");
  add_load(scene, "arm", {10, 0, 0}, {0, 0, 50}, Vector3::Zero(), "0:0 1:1 2:0");
  return scene;
}

scene::SceneDescription free_bar() {
  scene::SceneDescription scene = empty_scene("bar");
  add_beam(scene, "beam", {1, 0, 0}, scene::DirectSection{100, 100, 100, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  add_joint(scene, "free", JointKind::Floating, "world", "beam");
  return scene;
}

scene::SceneDescription axial_oscillator(double omega) {
  scene::SceneDescription scene = empty_scene("oscillator");
  const double stiffness = omega * omega / 3;  // the consistent mass at the free end is a third of the whole, 1 kg
  add_beam(scene, "beam", {1, 0, 0}, scene::DirectSection{stiffness, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  add_joint(scene, "clamp", JointKind::Fixed, "world", "beam");
  return scene;
}

scene::SceneDescription swinging_arm() {
  scene::SceneDescription scene = empty_scene("arm");
  scene.gravity = Vector3(0, 0, -9.81);
  const scene::DirectSection section{4e5, 2e5, 2e5, 800, 1000, 1000, 2, 0.01, 0.005, 0.005};
  std::string parent = "world";
  const Vector3 axes[] = {{0, 1, 0}, {0, 1, 0.2}, {0.2, 1, 0}};
  for (int i = 0; i < 3; ++i) {
    const std::string name = "link" + std::to_string(i);
    add_beam(scene, name, {1, 0, 0}, section, 8, 2);
    add_joint(scene, "joint" + std::to_string(i), JointKind::Revolute, parent, name, {i == 0 ? 0.0 : 1.0, 0, 0},
              axes[i]);
    parent = name;
  }
  return scene;
}

scene::SceneDescription stretched_whip(const std::string& pull) {
  scene::SceneDescription scene = empty_scene("whip");
  add_beam(scene, "beam", {1, 0, 0}, scene::DirectSection{1e5, 4e4, 4e4, 0.08, 0.1, 0.1, 0.1, 2e-7, 1e-7, 1e-7}, 8, 2);
  add_body(scene, "ball", 1, {0, 0, 0}, {1e-3, 1e-3, 1e-3});
  add_joint(scene, "root", JointKind::Spherical, "world", "beam");
  add_joint(scene, "tip", JointKind::Fixed, "beam", "ball", {1, 0, 0});
  add_load(scene, "ball", {0, 0, 0}, {500, 0, 0}, {0, 0, 0}, pull);
  add_load(scene, "beam", {0.5, 0, 0}, {0, 60, 40}, {0, 0, 0}, "0:0 0.1:0 0.15:1 0.25:0");
  return scene;
}

scene::SceneDescription damped_chain() {
  scene::SceneDescription scene = empty_scene("chain");
  scene.gravity = Vector3(0, 0, -9.81);
  const scene::DirectSection section{1e6, 4e5, 4e5, 80, 100, 100, 1, 2e-3, 1e-3, 1e-3};
  std::string parent = "world";
  for (int i = 0; i < 4; ++i) {
    const std::string name = "link" + std::to_string(i);
    add_beam(scene, name, {0.5, 0, 0}, section, 2, 2);
    scene::JointDescription& joint =
        add_joint(scene, "joint" + std::to_string(i), i % 2 == 0 ? JointKind::Universal : JointKind::Revolute, parent,
                  name, {i == 0 ? 0.0 : 0.5, 0, 0}, {0, 1, 0});
    joint.axis2 = Vector3::UnitZ();
    joint.damping = i == 1 ? 20 : 0.05;
    parent = name;
  }
  add_body(scene, "tool", 3, {0.1, 0.05, 0}, {0.02, 0.03, 0.04});
  add_joint(scene, "mount", JointKind::Fixed, parent, "tool", {0.5, 0, 0});
  return scene;
}

scene::SceneDescription sudden_release() {
  scene::SceneDescription scene = empty_scene("release");
  add_beam(scene, "beam", {1, 0, 0}, scene::DirectSection{2e5, 8e4, 8e4, 1.6, 2, 2, 0.5, 2e-5, 1e-5, 1e-5}, 6, 2);
  add_joint(scene, "clamp", JointKind::Fixed, "world", "beam");
  add_load(scene, "beam", {1, 0, 0}, {0, 6, 10}, {0, 0, 0}, "t < 0.5 ? sin(3.14159265*t)^2 : 0");
  return scene;
}

}  // namespace flexarm::bench
