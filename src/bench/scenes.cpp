#include "bench/scenes.h"

#include "scene/scene_builder.h"

namespace flexarm::bench {
namespace {

using scene::JointKind;
using scene::SceneBuilder;

/// Soft enough that steps of 10 ms resolve all waves.
const scene::DirectSection kSoftSection{400, 200, 200, 16, 20, 24, 1, 0.2, 0.1, 0.1};

/// Builds the tree; `root`: the joint that connects it to the world.
SceneBuilder tree(JointKind root) {
  SceneBuilder b("tree");
  b.beam("trunk", {{2, 0, 0}}, kSoftSection, 2, 2);
  b.beam("arm", {{0.3, 1.2, 0.4}}, kSoftSection, 1, 2);
  b.beam("branch", {{0.2, -0.5, 1}}, kSoftSection, 1, 3);
  b.body("hand", 0.8, {0.2, 0.1, -0.1}, Vector3(0.2, 0.25, 0.3).asDiagonal());
  b.body("rider", 1.1, {-0.1, 0.3, 0.2}, Vector3(0.3, 0.2, 0.25).asDiagonal());
  b.joint("root", root, "world", "trunk", Vector3::Zero(), {0, 1, 2});
  b.joint("elbow", JointKind::Revolute, "trunk", "arm", {2, 0, 0}, {1, 2, 2});
  b.joint("wrist", JointKind::Fixed, "arm", "hand", {0.3, 1.2, 0.4});
  b.joint("fork", JointKind::Fixed, "trunk", "branch", {1, 0, 0});
  b.joint("ball", JointKind::Spherical, "branch", "rider", {0.2, -0.5, 1});
  return b;
}

SceneBuilder clamped_beam(int elements, int order) {
  SceneBuilder b("cantilever");
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{100, 100, 100, 1, 1, 2, 1, 0.02, 0.01, 0.01}, elements, order);
  b.joint("clamp", JointKind::Fixed, "world", "beam");
  return b;
}

}  // namespace

scene::SceneDescription free_tree() {
  SceneBuilder b = tree(JointKind::Floating);
  // Slow enough that no node turns by 2 pi in 20 s, where the total interpolation is singular.
  b.scene.initial_links.push_back({"trunk", {0.02, -0.01, 0.03}, {0.1, 0.08, 0.16}, {}});
  b.scene.initial_joints.push_back({"elbow", 0, -0.15, {}});
  b.scene.initial_joints.push_back({"ball/rx", 0, 1.5, {}});
  return b.scene;
}

scene::SceneDescription loaded_tree() {
  SceneBuilder b = tree(JointKind::Revolute);
  b.load("hand", {0, 0, 0}, {3, -4, 5}, {1, 0.5, -0.6}, "(1 - cos(4*t))^2");
  b.load("branch", {0.2, -0.5, 1}, {-3, 1, 2}, {0, 0, 0}, "sin(3*t)^4");
  for (const char* link : {"hand", "rider"}) b.probe(link, link, {0.2, 0.1, 0.3});
  b.probe("trunk", "trunk", {2, 0, 0});
  return b.scene;
}

scene::SceneDescription cantilever(int elements, int order) {
  return clamped_beam(elements, order).scene;
}

scene::SceneDescription loaded_cantilever() {
  SceneBuilder b = clamped_beam(2, 2);
  b.load("beam", {1, 0, 0}, {-1, 2, 3}, {1, -0.5, 0.5}, "1");
  b.probe("tip", "beam", {1, 0, 0});
  return b.scene;
}

scene::SceneDescription right_angle_cantilever(int elements, int order) {
  SceneBuilder b("right_angle_cantilever");
  b.beam("arm", {{10, 0, 0}, {10, 10, 0}}, scene::DirectSection{1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1, 20, 10, 10}, elements,
         order);
  b.joint("clamp", JointKind::Fixed, "world", "arm");
  b.load("arm", {10, 0, 0}, {0, 0, 50}, Vector3::Zero(), "0:0 1:1 2:0");
  return b.scene;
}

scene::SceneDescription free_bar() {
  SceneBuilder b("bar");
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{100, 100, 100, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  b.joint("free", JointKind::Floating, "world", "beam");
  return b.scene;
}

scene::SceneDescription axial_oscillator(double omega) {
  SceneBuilder b("oscillator");
  const double stiffness =
      omega * omega / 3;  // the consistent mass at the free end is a third of the total mass of 1 kg
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{stiffness, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 1, 1);
  b.joint("clamp", JointKind::Fixed, "world", "beam");
  return b.scene;
}

scene::SceneDescription swinging_arm() {
  SceneBuilder b("arm");
  b.scene.gravity = Vector3(0, 0, -9.81);
  const scene::DirectSection section{4e5, 2e5, 2e5, 800, 1000, 1000, 2, 0.01, 0.005, 0.005};
  std::string parent = "world";
  const Vector3 axes[] = {{0, 1, 0}, {0, 1, 0.2}, {0.2, 1, 0}};
  for (int i = 0; i < 3; ++i) {
    const std::string name = "link" + std::to_string(i);
    b.beam(name, {{1, 0, 0}}, section, 8, 2);
    b.joint("joint" + std::to_string(i), JointKind::Revolute, parent, name, {i == 0 ? 0.0 : 1.0, 0, 0}, axes[i]);
    parent = name;
  }
  return b.scene;
}

scene::SceneDescription stretched_whip(const std::string& pull) {
  SceneBuilder b("whip");
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{1e5, 4e4, 4e4, 0.08, 0.1, 0.1, 0.1, 2e-7, 1e-7, 1e-7}, 8, 2);
  b.body("ball", 1, {0, 0, 0}, Vector3(1e-3, 1e-3, 1e-3).asDiagonal());
  b.joint("root", JointKind::Spherical, "world", "beam");
  b.joint("tip", JointKind::Fixed, "beam", "ball", {1, 0, 0});
  b.load("ball", {0, 0, 0}, {500, 0, 0}, {0, 0, 0}, pull);
  b.load("beam", {0.5, 0, 0}, {0, 60, 40}, {0, 0, 0}, "0:0 0.1:0 0.15:1 0.25:0");
  return b.scene;
}

scene::SceneDescription damped_chain() {
  SceneBuilder b("chain");
  b.scene.gravity = Vector3(0, 0, -9.81);
  const scene::DirectSection section{1e6, 4e5, 4e5, 80, 100, 100, 1, 2e-3, 1e-3, 1e-3};
  std::string parent = "world";
  for (int i = 0; i < 4; ++i) {
    const std::string name = "link" + std::to_string(i);
    b.beam(name, {{0.5, 0, 0}}, section, 2, 2);
    scene::JointDescription& joint =
        b.joint("joint" + std::to_string(i), i % 2 == 0 ? JointKind::Universal : JointKind::Revolute, parent, name,
                {i == 0 ? 0.0 : 0.5, 0, 0}, {0, 1, 0});
    joint.axis2 = Vector3::UnitZ();
    joint.damping = i == 1 ? 20 : 0.05;
    parent = name;
  }
  b.body("tool", 3, {0.1, 0.05, 0}, Vector3(0.02, 0.03, 0.04).asDiagonal());
  b.joint("mount", JointKind::Fixed, parent, "tool", {0.5, 0, 0});
  return b.scene;
}

scene::SceneDescription sudden_release() {
  SceneBuilder b("release");
  b.beam("beam", {{1, 0, 0}}, scene::DirectSection{2e5, 8e4, 8e4, 1.6, 2, 2, 0.5, 2e-5, 1e-5, 1e-5}, 6, 2);
  b.joint("clamp", JointKind::Fixed, "world", "beam");
  b.load("beam", {1, 0, 0}, {0, 6, 10}, {0, 0, 0}, "t < 0.5 ? sin(3.14159265*t)^2 : 0");
  return b.scene;
}

}  // namespace flexarm::bench
