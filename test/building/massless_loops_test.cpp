// Tests massless links in loops of rigid links: they are allowed if the loops determine how they move. Stops in loops
// know the inertia that moves with them.
#include <gtest/gtest.h>

#include "building/expect_model_error.h"
#include "building/model_builder.h"
#include "support/loops.h"
#include "support/scene_builder.h"

namespace flexarm {
namespace {

using namespace test;
using scene::JointKind;

const Vector3 kNormal = Vector3::UnitY();

void add_link(SceneBuilder& b, const std::string& name, double mass) {
  b.body(name, mass, {0.25, 0, 0}, 0.1 * mass * Matrix3::Identity());
}

/// Takes a link's inertia away. (Loops are closed before, since massless links would be refused then.)
void make_massless(SceneBuilder& b, const std::string& name) {
  for (scene::LinkDescription& link : b.scene.links)
    if (link.name == name) link.inertial.reset();
}

scene::JointDescription& hinge(SceneBuilder& b, const std::string& name, const std::string& parent,
                               const std::string& child, const Vector3& origin, double start) {
  if (start != 0) b.scene.initial_joints.push_back({name, start, 0, {}});
  return b.joint(name, JointKind::Continuous, parent, child, origin, kNormal);
}

/// A parallelogram of links of 0.5 m: crank and rocker at 1 rad, and a coupler of that mass, on a spherical pin.
SceneBuilder pinned_parallelogram(double mass) {
  SceneBuilder b;
  add_link(b, "crank", 2);
  add_link(b, "coupler", mass > 0 ? mass : 1);
  add_link(b, "rocker", 3);
  hinge(b, "foot", "world", "crank", {0, 0, 0}, 1).limits = scene::JointLimits{-2, 2};
  hinge(b, "knee", "crank", "coupler", {0.5, 0, 0}, -1);
  hinge(b, "toe", "world", "rocker", {0.5, 0, 0}, 1);
  close_loop(b, "pin", JointKind::Spherical, "coupler", "rocker", {0.5, 0, 0});
  if (mass == 0) make_massless(b, "coupler");
  return b;
}

const Coordinate& coordinate_of(const Model& model, const std::string& name) {
  for (const Coordinate& coordinate : model.coordinates)
    if (coordinate.name == name) return coordinate;
  throw std::out_of_range(name);
}

// All links of the parallelogram move with the crank: two turn, one is shifted.
TEST(MasslessLoops, StopsKnowTheInertiaOfTheLoop) {
  const auto inertia = [](double mass) { return 0.1 * mass + mass * 0.25 * 0.25; };
  for (const double mass : {0.0, 1.5}) {
    const Model model = build_model(pinned_parallelogram(mass).scene);
    EXPECT_NEAR(coordinate_of(model, "foot").limit->inertia, inertia(2) + inertia(3) + mass * 0.25, 1e-12) << mass;
  }
}

TEST(MasslessLoops, MoveLikeLightOnes) {
  SceneBuilder massless = pinned_parallelogram(0), light = pinned_parallelogram(1e-9);
  std::vector<double> ends;
  for (SceneBuilder* b : {&massless, &light}) {
    b->scene.gravity = {0, 0, -9.81};
    for (scene::JointDescription& joint : b->scene.joints) joint.limits.reset();
    Simulation simulation(b->scene);
    const double energy = simulation.energies().total();
    for (int n = 0; n < 10000; ++n) ASSERT_TRUE(simulation.step().converged);
    EXPECT_NEAR(simulation.energies().total(), energy, 1e-11 * 50);
    ends.push_back(simulation.position(0));
  }
  EXPECT_NEAR(ends[0], ends[1], 1e-6);
}

/// A chain of `count` massless links between a crank and a rocker.
SceneBuilder slack_chain(int count) {
  SceneBuilder b;
  add_link(b, "crank", 2);
  add_link(b, "rocker", 3);
  hinge(b, "foot", "world", "crank", {0, 0, 0}, -1.2);
  hinge(b, "toe", "world", "rocker", {1, 0, 0}, -1.4);
  std::vector<std::string> links;
  for (int i = 0; i < count; ++i) {
    const std::string link = "link" + std::to_string(i);
    add_link(b, link, 1);
    hinge(b, "knee" + std::to_string(i), i == 0 ? "crank" : links.back(), link, {i == 0 ? 0.5 : 0.3, 0, 0},
          i == 0 ? 0.7 : 0.4);
    links.push_back(link);
  }
  close_loop(b, "pin", JointKind::Spherical, "rocker", links.back(), {0.3, 0, 0});
  for (const std::string& link : links) make_massless(b, link);
  return b;
}

// Two massless links are determined by their ends; a third one leaves a motion without inertia.
TEST(MasslessLoops, AreRefusedIfTheLoopDoesNotDetermineThem) {
  EXPECT_NO_THROW(build_model(slack_chain(1).scene));
  EXPECT_NO_THROW(build_model(slack_chain(2).scene));
  expect_error(slack_chain(3).scene, "moves nothing that has inertia");
}

// A rod between two ball joints turns about its own line.
TEST(MasslessLoops, AreRefusedIfTheyCanSpin) {
  SceneBuilder b = pinned_parallelogram(1);
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.name == "knee") joint.kind = JointKind::Spherical;
  b.scene.initial_joints.erase(b.scene.initial_joints.begin() + 1);
  b.scene.initial_joints.push_back({"knee/ry", -1, 0, {}});
  EXPECT_NO_THROW(build_model(b.scene));
  make_massless(b, "coupler");
  expect_error(b.scene, "moves nothing that has inertia");
}

}  // namespace
}  // namespace flexarm
