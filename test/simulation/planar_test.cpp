// Tests that scenes with motion in a plane are detected and solved in the plane, with the same results as in three
// dimensions.
#include <cmath>
#include <cstdio>
#include <functional>

#include "flexarm/simulation/checkpoint.h"
#include "integrators/step_plane.h"
#include "math/so3.h"
#include "schemes/scheme.h"
#include "simulation/same_bits.h"
#include "support/runs.h"
#include "support/scene_builder.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// Tolerance: round-off of some hundred steps, amplified by the mechanism, relative to its size.
constexpr double kSame = 1e-11;

const std::vector<std::string> kPlanarSchemes = {"em", "em0", "em_symmetric", "em4", "edmc1", "edmc2"};

PlaneSearch plane_of(const scene::SceneDescription& scene, const std::string& scheme = "em") {
  const Simulation simulation(scene, options(scheme));
  return find_step_plane(model_of(simulation), make_scheme(simulation.scene().integrator));
}

/// A cart on a rail carries a flexible arm with a rigid body at its end, and another arm. They move in a tilted plane
/// with the normal turn * z, with damping, dry and smooth friction, a spring, and loads of both kinds.
SceneBuilder tilted_arm(const Quaternion& turn) {
  SceneBuilder b;
  b.scene.integrator.step = 0.005;
  const Vector3 x = turn * Vector3::UnitX(), y = turn * Vector3::UnitY(), z = turn * Vector3::UnitZ();
  const Matrix3 axes = turn.toRotationMatrix();
  b.scene.gravity = -9.81 * y;
  const scene::DirectSection section{2e4, 1e4, 1e4, 20, 25, 25, 0.5, 2e-3, 1e-3, 1e-3};
  b.body("cart", 2, Vector3(0.1 * x), axes * Vector3(0.02, 0.03, 0.04).asDiagonal() * axes.transpose());
  b.beam("upper", {Vector3(0.6 * x), Vector3(0.6 * x + 0.4 * y)}, section, 4, 2);
  b.body("weight", 0.3, Vector3(0.05 * y), axes * Vector3(2e-3, 3e-3, 4e-3).asDiagonal() * axes.transpose());
  scene::BeamDescription& lower = b.beam("lower", {Vector3(0.7 * x)}, section, 2, 3);
  lower.stiffness_proportional_damping = 1e-3;
  lower.mass_proportional_damping = 0.8;
  b.joint("rail", JointKind::Prismatic, "world", "cart", Vector3::Zero(), x).damping = 0.5;
  b.joint("shoulder", JointKind::Continuous, "cart", "upper", Vector3(0.2 * x), z).friction = 0.05;
  b.joint("weld", JointKind::Fixed, "upper", "weight", Vector3(0.6 * x + 0.4 * y));
  b.joint("elbow", JointKind::Continuous, "weight", "lower", Vector3(0.05 * y), z);
  b.load("lower", Vector3(0.7 * x), Vector3(0.4 * x + 0.2 * y), Vector3(0.05 * z), "1 + sin(3*t)");
  b.load("upper", Vector3(0.6 * x), Vector3(0.3 * y), Vector3::Zero(), "1", scene::LoadFrame::Follower);
  b.probe("tip", "lower", Vector3(0.7 * x));
  return b;
}

const Quaternion kTilt = so3::exp_quaternion(Vector3(0.4, -0.7, 0.3));

/// The same scene, solved in three dimensions.
scene::SceneDescription in_space(scene::SceneDescription scene) {
  scene.integrator.may_be_planar = false;
  return scene;
}

/// Largest difference of positions, and of velocities times the step, of all nodes, relative to the mechanism's size.
double distance(const Simulation& a, const Simulation& b) {
  double largest = 0;
  const double length = model_of(a).length_scale, h = a.step_size();
  for (std::size_t i = 0; i < state_of(a).nodes.size(); ++i) {
    const NodeState &x = state_of(a).nodes[i], &y = state_of(b).nodes[i];
    largest = std::max(
        {largest, (x.position - y.position).norm() / length, h * (x.velocity - y.velocity).norm() / length,
         h * (x.angular_velocity - y.angular_velocity).norm(), 1 - std::abs(x.orientation.dot(y.orientation))});
  }
  return largest;
}

/// Compares a run in the plane with a run in three dimensions. `act(simulation, step)` is called before each step.
void expect_same_motion(const scene::SceneDescription& scene, const std::string& scheme, int steps,
                        const std::function<void(Simulation&, int)>& act = {}) {
  const SimulationOptions options = test::options(scheme);
  ASSERT_TRUE(plane_of(scene, scheme).plane) << scheme << ": " << plane_of(scene, scheme).reason;
  Simulation plane(scene, options), space(in_space(scene), options);
  for (int n = 0; n < steps; ++n) {
    if (act) act(plane, n), act(space, n);
    const StepResult result = plane.step(), expected = space.step();
    ASSERT_EQ(result.converged, expected.converged) << scheme << " step " << n;
    if (!expected.converged) return;
  }
  EXPECT_LE(distance(plane, space), kSame) << scheme;
  const Energies e = plane.energies(), f = space.energies();
  const double size = std::abs(f.kinetic) + std::abs(f.strain) + std::abs(f.potential) + std::abs(f.work) + 1e-6;
  EXPECT_NEAR(e.kinetic + e.strain + e.potential, f.kinetic + f.strain + f.potential, 1e-9 * size) << scheme;
  EXPECT_NEAR(e.dissipated, f.dissipated, 1e-9 * size) << scheme;
  EXPECT_NEAR(e.work, f.work, 1e-9 * size) << scheme;
}

TEST(Planar, IsFoundInAnyPlane) {
  for (const Quaternion& turn : {Quaternion::Identity(), kTilt}) {
    const PlaneSearch search = plane_of(tilted_arm(turn).scene);
    ASSERT_TRUE(search.plane) << search.reason;
    EXPECT_NEAR(std::abs(search.plane->normal.dot(turn * Vector3::UnitZ())), 1, 1e-12);
  }
  scene::SceneDescription scene = in_space(tilted_arm(kTilt).scene);
  EXPECT_EQ(plane_of(scene).reason, "three dimensions are requested");
  for (const char* scheme : {"m1", "std", "beta2", "newmark", "hht2"})
    EXPECT_EQ(plane_of(tilted_arm(kTilt).scene, scheme).reason,
              std::string("scheme '") + scheme + "' computes in three dimensions only");
}

TEST(Planar, IsTheSameMotionAsInThreeDimensions) {
  for (const std::string& scheme : kPlanarSchemes)
    for (const Quaternion& turn : {Quaternion::Identity(), kTilt})
      expect_same_motion(tilted_arm(turn).scene, scheme, 50);
}

TEST(Planar, TakesMaxwellElements) {
  SceneBuilder b = tilted_arm(kTilt);
  for (const std::size_t link : {2, 4})
    b.scene.links[link].beam->maxwell = {{0.4, 0.02}, {0.1 * static_cast<double>(link), 0.5}};
  b.scene.links[4].beam->maxwell.push_back({0.2, 1e-4});  // one more than the other beam
  for (const char* scheme : {"em", "em0", "em_symmetric", "edmc1", "edmc2"}) expect_same_motion(b.scene, scheme, 50);
}

TEST(Planar, IsTheSameMotionInScenesOfTheExamples) {
  for (const char* file : {"config/speed/double_pendulum.urdf", "config/speed/spin_up.urdf",
                           "config/examples/rigid_double_pendulum.urdf"}) {
    const scene::SceneDescription scene = scene_at(file);
    const PlaneSearch search = plane_of(scene);
    EXPECT_TRUE(search.plane) << file << ": " << search.reason;
    for (const std::string& scheme : kPlanarSchemes) expect_same_motion(scene, scheme, 60);
  }
}

// A free body has coordinates out of the plane, which keep their values.
TEST(Planar, TakesFreeAndBallJoints) {
  SceneBuilder b;
  b.scene.integrator.step = 0.01;
  b.beam("spaghetti", {{2, 0, 0}}, section(1e4, 5e3, 50, 40, 1, 1e-2, 5e-3), 4, 2);
  b.joint("free", JointKind::Floating, "world", "spaghetti");
  b.body("ball", 0.2, {0.1, 0, 0}, 1e-3 * Matrix3::Identity());
  b.joint("socket", JointKind::Spherical, "spaghetti", "ball", {2, 0, 0});
  b.load("spaghetti", {0, 0, 0}, {3, 1, 0}, {0, 0, 2}, "t < 0.3 ? 1 : 0");
  ASSERT_TRUE(plane_of(b.scene).plane) << plane_of(b.scene).reason;
  for (const std::string& scheme : kPlanarSchemes) expect_same_motion(b.scene, scheme, 80);
}

// Components of the strain memory that the scheme does not use stay exactly zero: they are part of the state and of
// checkpoints.
TEST(Planar, WhatNoDamperKeepsStaysZero) {
  for (const bool is_damped : {false, true}) {
    SceneBuilder b;
    scene::BeamDescription& beam = b.beam("rod", {{1, 0, 0}}, section(1e4, 5e3, 50, 40, 1, 1e-2, 5e-3), 5, 2);
    if (is_damped) beam.stiffness_proportional_damping = 1e-3;
    b.joint("clamp", JointKind::Fixed, "world", "rod");
    b.load("rod", {1, 0, 0}, {0, 1, 0});
    const SimulationOptions options = test::options(is_damped ? "em" : "edmc1");
    ASSERT_TRUE(plane_of(b.scene, *options.scheme).plane);
    Simulation simulation(b.scene, options);
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
    ASSERT_FALSE(state_of(simulation).strain_memory.empty());
    for (const StrainMemory& memory : state_of(simulation).strain_memory) {
      EXPECT_TRUE((is_damped ? memory.average : memory.delayed_rate).isZero(0));
      EXPECT_FALSE(memory.rate.isZero(0));
    }
  }
}

TEST(Planar, IsNotFoundWhereSomethingIsNearlyInThePlane) {
  const SceneBuilder planar = tilted_arm(Quaternion::Identity());
  ASSERT_TRUE(plane_of(planar.scene).plane);
  const auto reason = [&](const std::function<void(SceneBuilder&)>& change) {
    SceneBuilder b = planar;
    change(b);
    const PlaneSearch search = plane_of(b.scene);
    EXPECT_FALSE(search.plane);
    return search.reason;
  };
  EXPECT_NE(reason([](SceneBuilder& b) { b.scene.joints.back().origin.position.z() += 1e-6; }), "");
  EXPECT_EQ(reason([](SceneBuilder& b) { b.scene.gravity.z() = 1e-6; }), "gravity is not in the plane");
  EXPECT_EQ(reason([](SceneBuilder& b) {
              b.load("lower", {0.7, 0, 0}, {0, 0, 1e-6}, Vector3::Zero(), "sin(t)");
            }),
            "a load acts out of the plane");
  EXPECT_EQ(reason([](SceneBuilder& b) {
              b.load("lower", {0.7, 0, 1e-6}, {1, 0, 0});
            }),
            "a load acts out of the plane");
  EXPECT_NE(reason([](SceneBuilder& b) { b.scene.joints.back().axis = Vector3(1e-6, 0, 1).normalized(); }), "");
  EXPECT_EQ(reason([](SceneBuilder& b) {
              Matrix3 inertia = Vector3(2e-3, 3e-3, 4e-3).asDiagonal();
              inertia(0, 2) = inertia(2, 0) = 1e-9;
              b.body("tilted", 0.1, {0, 0, 0}, inertia);
              b.joint("fixed", JointKind::Fixed, "weight", "tilted");
            }),
            "no principal axis of a link's inertia is normal to the plane");
}

// A section that couples bending in the plane with deformation out of it prevents planar steps. Coupling within the
// plane does not.
TEST(Planar, IsNotFoundWhereSectionsCoupleOutOfIt) {
  const auto search = [](int row, int column) {
    SceneBuilder b;
    scene::MatrixSection section;
    section.stiffness = (Vector6() << 2e4, 1e4, 1e4, 20, 25, 25).finished().asDiagonal();
    section.stiffness(row, column) = section.stiffness(column, row) = 1e-6;
    section.inertia = (Vector6() << 0.5, 0.5, 0.5, 2e-3, 1e-3, 1e-3).finished().asDiagonal();
    b.beam("arm", {{1, 0, 0}}, section, 2, 2);
    b.joint("hinge", JointKind::Continuous, "world", "arm", Vector3::Zero(), Vector3::UnitZ());
    b.scene.gravity = {0, -9.81, 0};
    return plane_of(b.scene);
  };
  EXPECT_TRUE(search(0, 5).plane) << "stretch with bending in the plane: " << search(0, 5).reason;
  EXPECT_FALSE(search(0, 4).plane) << "stretch with bending out of the plane";
  EXPECT_FALSE(search(3, 5).plane) << "torsion with bending";
  EXPECT_FALSE(search(1, 2).plane) << "both shears";
}

// The initial motion leaves the plane, so the run is solved in three dimensions throughout.
TEST(Planar, IsNotTakenWhereTheStartMovesOutOfIt) {
  SceneBuilder b;
  b.scene.integrator.step = 0.01;
  b.beam("spaghetti", {{2, 0, 0}}, section(1e4, 5e3, 50, 40, 1, 1e-2, 5e-3), 4, 2);
  b.joint("free", JointKind::Floating, "world", "spaghetti");
  b.scene.initial_links.push_back({"spaghetti", {1, 0.5, 1e-6}, {0, 0, 2}, {}});
  Simulation plane(b.scene), space(in_space(b.scene));
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(plane.step().converged);
    ASSERT_TRUE(space.step().converged);
  }
  EXPECT_LE(distance(plane, space), kSame);
  EXPECT_NEAR(plane.tip_pose(1).position.z(), 1e-6, 1e-11) << "a second at 1e-6 m/s";
}

// A force out of the plane switches to three dimensions. The motion is the same as if it had been solved there from the
// start.
TEST(Planar, IsLiftedByWrenches) {
  const scene::SceneDescription scene = tilted_arm(kTilt).scene;
  for (const char* scheme : {"em", "edmc2"})
    expect_same_motion(scene, scheme, 60, [](Simulation& simulation, int n) {
      const std::size_t tip = simulation.link_names().size() - 1;
      if (n == 20) simulation.apply_wrenches({{tip, Vector3::Zero(), {kTilt * Vector3(0, 0, 1), Vector3::Zero()}}});
      if (n == 40) simulation.apply_wrenches({});
    });
}

TEST(Planar, StaysInThePlaneUnderWrenchesThere) {
  const scene::SceneDescription scene = tilted_arm(kTilt).scene;
  for (const char* scheme : {"em", "edmc2"}) {
    Simulation simulation(scene, options(scheme));
    const Vector3 normal = kTilt * Vector3::UnitZ();
    const std::size_t tip = simulation.link_names().size() - 1;
    const PlaneSearch search = plane_of(scene, scheme);
    EXPECT_TRUE(lies_in_plane(model_of(simulation), *search.plane, state_of(simulation))) << scheme << ", at the start";
    simulation.apply_wrenches({{tip, Vector3::Zero(), {kTilt * Vector3(1, 2, 0), 0.1 * normal}}});
    for (int n = 0; n < 2000; ++n) ASSERT_TRUE(simulation.step().converged) << scheme << " step " << n;
    EXPECT_TRUE(lies_in_plane(model_of(simulation), *search.plane, state_of(simulation))) << scheme;
  }
}

// Only the state decides whether a step is solved in the plane or in three dimensions.
class PlanarSnapshots : public ::testing::TestWithParam<const char*> {};

TEST_P(PlanarSnapshots, GoOnFromAny) {
  const SimulationOptions options = full_newton(test::options(GetParam()));
  Simulation simulation(tilted_arm(kTilt).scene, options);
  const std::size_t tip = simulation.link_names().size() - 1;
  run(simulation, 10);
  const Snapshot in_plane = simulation.snapshot();
  simulation.apply_wrenches({{tip, Vector3::Zero(), {kTilt * Vector3(0, 0, 1), Vector3::Zero()}}});
  run(simulation, 10);
  simulation.apply_wrenches({});
  const Snapshot lifted = simulation.snapshot();
  run(simulation, 10);
  Simulation copy = simulation.copy();
  const State end = state_of(simulation);
  simulation.restore(lifted);
  run(simulation, 10);
  EXPECT_TRUE(same_bits(state_of(simulation), end));
  run(simulation, 5), run(copy, 5);
  EXPECT_TRUE(same_bits(state_of(simulation), state_of(copy)));
  simulation.restore(in_plane);
  run(simulation, 10);
  copy.restore(in_plane);
  run(copy, 10);
  EXPECT_TRUE(same_bits(state_of(simulation), state_of(copy)));
  const PlaneSearch search = plane_of(tilted_arm(kTilt).scene, GetParam());
  EXPECT_TRUE(lies_in_plane(model_of(simulation), *search.plane, state_of(simulation)));
  simulation.reset();
  run(simulation, 10);
  Simulation fresh(tilted_arm(kTilt).scene, options);
  run(fresh, 10);
  EXPECT_TRUE(same_bits(state_of(simulation), state_of(fresh)));
}

TEST_P(PlanarSnapshots, GoOnFromFilesAndOtherSimulations) {
  const scene::SceneDescription scene = tilted_arm(kTilt).scene;
  const SimulationOptions options = full_newton(test::options(GetParam()));
  const std::string path = testing::TempDir() + "flexarm_planar_" + GetParam() + ".state";
  for (const bool is_lifted : {false, true}) {
    Simulation simulation(scene, options), other(scene, options), taken(scene, options);
    const std::size_t tip = simulation.link_names().size() - 1;
    if (is_lifted) simulation.apply_wrenches({{tip, Vector3::Zero(), {kTilt * Vector3(0, 0, 1), Vector3::Zero()}}});
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(simulation.step().converged);
    simulation.apply_wrenches({});
    write_checkpoint(simulation, path);
    read_checkpoint(other, path);
    taken.take_over(simulation);
    for (int n = 0; n < 10; ++n)
      for (Simulation* one : {&simulation, &other, &taken}) ASSERT_TRUE(one->step().converged);
    EXPECT_TRUE(same_bits(state_of(simulation), state_of(other))) << is_lifted;
    EXPECT_LE(distance(simulation, taken), kSame) << is_lifted;
    EXPECT_EQ(lies_in_plane(model_of(other), *plane_of(scene, GetParam()).plane, state_of(other)), !is_lifted);
  }
  std::remove(path.c_str());
}

INSTANTIATE_TEST_SUITE_P(Schemes, PlanarSnapshots, ::testing::Values("em", "edmc2"));

TEST(Planar, GoesOnFromOtherJointStates) {
  for (const char* scheme : {"em", "edmc2"})
    expect_same_motion(tilted_arm(kTilt).scene, scheme, 40, [](Simulation& simulation, int n) {
      if (n == 20)
        simulation.set_joint_state(
            {{*simulation.find_coordinate("elbow"), 0.5, 1.0}, {*simulation.find_coordinate("rail"), 0.1, 0.0}});
    });
}

// A joint state may turn a ball joint out of the plane.
TEST(Planar, IsLiftedByJointStates) {
  SceneBuilder b = tilted_arm(Quaternion::Identity());
  b.body("ball", 0.2, {0.1, 0, 0}, 1e-3 * Matrix3::Identity());
  b.joint("socket", JointKind::Spherical, "lower", "ball", {0.7, 0, 0});
  ASSERT_TRUE(plane_of(b.scene).plane);
  const auto act = [](Simulation& simulation, int n) {
    if (n == 20) simulation.set_joint_state({{*simulation.find_coordinate("socket/ry"), 0.2, 0.5}});
  };
  expect_same_motion(b.scene, "em", 40, act);
  const auto command = [](Simulation& simulation, int n) {
    if (n == 20) simulation.command_effort(*simulation.find_coordinate("socket/rx"), 0.01);
  };
  expect_same_motion(b.scene, "em", 40, command);
}

}  // namespace
}  // namespace flexarm::test
