// Tests that steps, results and snapshots allocate no heap memory after the first step. The allocations are counted
// (support/allocations.h).
#include <algorithm>

#include "flexarm/simulation/sensitivities.h"
#include "simulation/allocation_scenes.h"
#include "simulation/everything_scene.h"
#include "support/allocations.h"
#include "support/closed_ring.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

class Allocation : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  void SetUp() override {
    if (!kCountsAllocations) GTEST_SKIP() << "this C library's allocator cannot be counted";
  }
};

TEST_F(Allocation, IsCounted) {
  // Called through volatile pointers, because the compiler may remove new-expressions and pairs of calls.
  void* (*volatile allocate)(std::size_t) = &std::malloc;
  void* (*volatile make)(std::size_t) = &::operator new;
  EXPECT_EQ(allocations_in([&] {
              std::free(allocate(10));
              ::operator delete(make(10));
            }),
            2);
}

/// Makes `steps` steps after the first one, calls `look(result)` after each, and expects no allocation.
template <class Look>
void expect_none_after_the_first_step(Simulation& simulation, int steps, const Look& look) {
  ASSERT_TRUE(simulation.step().converged) << simulation.scheme();
  EXPECT_EQ(allocations_in([&] {
              for (int n = 0; n < steps; ++n) look(simulation.step());
            }),
            0)
      << simulation.scheme();
}

/// The same, with steps that must converge.
void expect_none_where_all_converge(Simulation& simulation, int steps) {
  expect_none_after_the_first_step(simulation, steps, [](const StepResult& result) { EXPECT_TRUE(result.converged); });
}

/// The same for steps of a scene, and for its columns with such names. Returns what was dissipated [J].
double expect_none_in_columns(const std::string& scene, const std::string& scheme, const std::string& names) {
  Simulation simulation(scene_of(scene), options(scheme));
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {names});
  columns.row(simulation, {});
  expect_none_after_the_first_step(simulation, 300, [&](const StepResult& result) {
    EXPECT_TRUE(result.converged);
    columns.row(simulation, {});
  });
  return simulation.energies().dissipated;
}

// A pump, relief valves and voids that are filled.
TEST_F(Allocation, NoneWithHydraulics) {
  for (const char* scheme : {"em", "newmark"}) EXPECT_GT(expect_none_in_columns(kOilScene, scheme, "cylinder/*"), 0);
}

// In space and in a plane.
TEST_F(Allocation, NoneWithMaxwellElements) {
  for (const char* axis : {"0.3 1 0", "0 1 0"}) {
    Simulation simulation(scene_of(relaxing_scene(axis)));
    expect_none_where_all_converge(simulation, 100);
    EXPECT_GT(simulation.energies().dissipated, 0);
  }
}

// A line that slips over a point, runs over a pulley and onto a drum, paid out by a winch. em4 has no friction.
TEST_F(Allocation, NoneWithTendons) {
  for (const char* scheme : {"em", "em4", "newmark"})
    EXPECT_GT(expect_none_in_columns(rope_scene(scheme == std::string("em4") ? 0 : 0.1), scheme, "tendon/*"), 0);
}

// Lines over many nodes, whose tangents have pieces, one of them paid out by a winch.
TEST_F(Allocation, NoneWithLongLines) {
  for (const char* scheme : {"em", "newmark"}) {
    Simulation simulation(scene_of(kTendonScene), options(scheme));
    expect_none_where_all_converge(simulation, 300);
  }
}

TEST_P(Allocation, NoneInAThousandSteps) {
  const auto [scheme, reuse] = GetParam();
  SceneBuilder builder = everything_scene();
  using scene::SensorKind;
  for (const auto& [kind, link] : {std::pair(SensorKind::Wrench, "spherical_body"),
                                   {SensorKind::Reaction, "fixed_body"},
                                   {SensorKind::SectionForce, "beam2"},
                                   {SensorKind::Strain, "beam3"},
                                   {SensorKind::Imu, "beam4"},
                                   {SensorKind::Pose, "beam1"}}) {
    builder.sensor(std::string("on_") + link, kind, link, {0.05, 0.01, 0});
    builder.scene.sensors.back().noise = {0.01};
  }
  builder.body("held_body", 0.1, {0.02, 0, 0}, 1e-4 * Matrix3::Identity());
  builder.joint("held", scene::JointKind::Revolute, "fixed_body", "held_body", {0.05, 0, 0});
  builder.scene.motions.push_back({"held", TimeFunction(0.4), {}});
  scene::SceneDescription scene = builder.scene;
  // They fail while the axial strain does not change (beam.md 3.3)
  const bool may_fail = scheme == "beta1" || scheme == "beta2";
  // Limits the depth of halving; it may occur a hundred times
  if (may_fail) scene.integrator.max_halvings = 5;
  const int steps = may_fail ? 100 : 1000;
  Simulation simulation(scene, reuse ? options(scheme) : full_newton(options(scheme)));
  simulation.command_effort(*simulation.find_coordinate("elbow"), 0.1);
  ASSERT_TRUE(simulation.step().converged);
  int converged = 0;
  EXPECT_EQ(allocations_in([&] {
              for (int n = 0; n < steps; ++n) {
                converged += simulation.step().converged;
                if (n == steps / 2) simulation.release_command(*simulation.find_coordinate("elbow"));
                if (n % (steps / 10) == 0)
                  simulation.command_effort(*simulation.find_coordinate("prismatic"), n * 1e-3);
              }
            }),
            0);
  EXPECT_GE(converged, may_fail ? 1 : steps);
  if (!may_fail) {
    EXPECT_GT(std::abs(simulation.position(*simulation.find_coordinate("hinge"))), 0.015) << "the stop must be reached";
  }
}
INSTANTIATE_TEST_SUITE_P(Schemes, Allocation,
                         ::testing::Combine(::testing::Values("em", "em0", "em_symmetric", "em4", "edmc1", "edmc2",
                                                              "m1", "m2", "std", "beta1", "beta2", "beta1_repaired",
                                                              "beta2_repaired", "newmark", "hht1", "hht2", "hht3"),
                                            ::testing::Bool()),
                         [](const auto& info) {
                           return std::get<0>(info.param) + (std::get<1>(info.param) ? "_reuse" : "_full");
                         });

// The scene begins in a plane, leaves it for three dimensions, and returns to the plane.
TEST_F(Allocation, NoneWhereAPlaneIsLeft) {
  for (const std::string scheme : {"em", "em0", "em_symmetric", "em4", "edmc2"}) {
    SceneBuilder b;
    b.beam("upper", {{1, 0, 0}}, section(2e4, 1e4, 20, 25, 0.5, 2e-3, 1e-3), 4, 2);
    b.beam("lower", {{0, 1, 0}}, section(2e4, 1e4, 20, 25, 0.5, 2e-3, 1e-3), 2, 3);
    b.joint("shoulder", scene::JointKind::Continuous, "world", "upper");
    b.joint("ball", scene::JointKind::Spherical, "upper", "lower", {1, 0, 0});
    b.scene.gravity = {0, -9.81, 0};
    Simulation simulation(b.scene, options(scheme));
    const Snapshot start = simulation.snapshot();
    const std::vector<AppliedWrench> none, out = {{2, Vector3::Zero(), {Vector3::UnitZ(), Vector3::Zero()}}};
    ASSERT_EQ(simulation.link_names().at(2), "lower");
    ASSERT_TRUE(simulation.step().converged);
    EXPECT_EQ(allocations_in([&] {
                for (int n = 0; n < 60; ++n) {
                  if (n == 20) simulation.apply_wrenches(out);
                  if (n == 40) simulation.apply_wrenches(none);
                  if (n == 50) simulation.restore(start);
                  simulation.step();
                }
              }),
              0)
        << scheme;
  }
}

TEST_F(Allocation, NoneWhereFrictionSticks) {
  for (const std::string scheme : {"em", "edmc2", "m1", "std", "newmark"})
    for (const bool reuse : {true, false}) {
      Simulation simulation(rubbing_scene().scene, reuse ? options(scheme) : full_newton(options(scheme)));
      double held = 0;
      expect_none_after_the_first_step(simulation, 300, [&](const StepResult& result) {
        EXPECT_TRUE(result.converged);
        for (const double rest : state_of(simulation).rests) held += rest;
      });
      EXPECT_GT(held, 0) << scheme;
    }
}

TEST_F(Allocation, NoneInDrivesAndServos) {
  for (const char* scheme : {"em", "edmc2", "m1", "std", "newmark", "hht1"}) {
    Simulation simulation(driven_scene().scene, options(scheme));
    expect_none_where_all_converge(simulation, 300);
  }
}

TEST_F(Allocation, NoneInExplicitSteps) {
  for (const auto& [scheme, depends] : {std::pair("rk4", false), {"dop853", false}, {"rk4", true}, {"dop853", true}}) {
    SceneBuilder b;
    const Matrix3 inertia = Vector3(0.02, 0.03, 0.04).asDiagonal();
    b.body("upper", 1, {0.5, 0, 0}, inertia);
    b.body("fore", 0.7, {0, 0.4, 0}, inertia);
    b.joint("shoulder", scene::JointKind::Continuous, "world", "upper");
    b.joint("ball", scene::JointKind::Spherical, "upper", "fore", {1, 0, 0});
    b.body("tool", 0.2, Vector3::Zero(), inertia);
    b.joint("wrist", scene::JointKind::Continuous, "fore", "tool");
    b.scene.motions.push_back({"wrist", TimeFunction(0.3), {}});  // it is held
    b.drive("shoulder", 1, 0.01).stiffness = 20;
    b.sensor("base", scene::SensorKind::Reaction, "upper");
    if (depends) {
      b.body("wheel", 0.3, Vector3::Zero(), inertia);
      b.body("follower", 0.3, Vector3::Zero(), inertia);
      b.joint("axle", scene::JointKind::Continuous, "fore", "wheel");
      b.joint("gear", scene::JointKind::Continuous, "upper", "follower").mimic = scene::Mimic{"shoulder", 2, 0};
      b.scene.motions.push_back({"axle", TimeFunction::parse("sin(3*t)"), {}});
    }
    b.scene.gravity = {0, -9.81, 0};
    Simulation simulation(b.scene, options(scheme));
    expect_none_where_all_converge(simulation, 100);
  }
}

TEST_F(Allocation, NoneInLoopsOfRigidLinks) {
  for (const char* scheme : {"em", "edmc2", "m1", "std", "newmark", "hht1", "hht2", "hht3", "rk4", "dop853"}) {
    SceneBuilder ring = free_ring(scene::JointKind::Universal);
    ring.sensor("closed", scene::SensorKind::Reaction, ring.scene.loop_joints.front().child);
    ring.scene.sensors.back().joint = ring.scene.loop_joints.front().name;
    Simulation simulation(ring.scene, options(scheme, 0.002));
    expect_none_after_the_first_step(simulation, 200, [](const StepResult&) {});
  }
}

// When a slider enters another element, other nodes are coupled.
TEST_F(Allocation, NoneWhereSlidersEnterElements) {
  SceneBuilder b;
  b.beam("line", {{4, 0, 0}}, section(2e3, 1e3, 80, 100, 1, 0.2, 0.1), 8, 2);
  b.body("bead", 1, Vector3::Zero(), 0.1 * Matrix3::Identity());
  b.joint("clamp", scene::JointKind::Fixed, "world", "line");
  b.joint("run", scene::JointKind::Slide, "line", "bead").slide = scene::SlideDescription{0.2, scene::JointKind::Fixed};
  b.scene.initial_joints.push_back({"run", 0.2, 2.0, {}});
  b.scene.integrator.step = 0.005;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.step().converged);
  const SlideLine& line = model_of(simulation).slide_lines[0];
  int borders = 0;
  while (simulation.position(0) < 3.6 && simulation.time() < 3) {
    const int before = line.piece_at(simulation.position(0));
    EXPECT_EQ(allocations_in([&] { ASSERT_TRUE(simulation.step().converged); }), 0) << simulation.time();
    borders += std::abs(line.piece_at(simulation.position(0)) - before);
  }
  EXPECT_EQ(borders, 7);
}

// Only steps in which elements are halved or joined allocate memory.
TEST_F(Allocation, NoneWhereElementsMayBeHalved) {
  SceneBuilder b;
  b.beam("arm", {{1, 0, 0}}, section(1e5, 4e4, 0.8, 1, 1, 2e-5, 1e-5), 4, 2).refine = true;
  b.joint("clamp", scene::JointKind::Fixed, "world", "arm");
  b.load("arm", {1, 0, 0}, {0, 0, 0.5});
  b.scene.integrator.step = 0.005;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.step().converged);
  expect_none_where_all_converge(simulation, 200);
}

/// A block that moves between stops.
Simulation carriage(const char* scheme, double speed) {
  SceneBuilder b;
  b.body("block", 1, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "block").limits = scene::JointLimits{-0.5, 0.5};
  b.scene.initial_joints.push_back({"rail", 0, speed, {}});
  return Simulation(b.scene, options(scheme));
}

// Hits that need halved steps evaluate the rates at the beginning of the step.
TEST_F(Allocation, NoneWhereStopsAreHitFast) {
  for (const char* scheme : {"em", "newmark"}) {
    Simulation simulation = carriage(scheme, 100);
    int halvings = 0;
    expect_none_after_the_first_step(simulation, 20, [&](const StepResult& result) { halvings += result.halvings; });
    EXPECT_GT(halvings, 0) << scheme;
  }
}

// Steps of explicit schemes are cut where stops are touched and left.
TEST_F(Allocation, NoneInExplicitHits) {
  for (const char* scheme : {"rk4", "dop853"}) {
    Simulation simulation = carriage(scheme, 5);
    bool comes_back = false;
    expect_none_after_the_first_step(
        simulation, 200, [&](const StepResult&) { comes_back = comes_back || simulation.velocity(0) < -1; });
    EXPECT_TRUE(comes_back) << scheme;
  }
}

// Halved steps use other code than full ones.
TEST_F(Allocation, NoneWhereBodiesTouchAndLetGo) {
  scene::SceneDescription scene = scene_at("config/examples/gripper.urdf");
  scene::Sensor sensor;
  sensor.name = "felt";
  sensor.kind = scene::SensorKind::Contact;
  sensor.link = "block";
  scene.sensors.push_back(sensor);
  Simulation simulation(scene);
  int halved = 0;
  expect_none_after_the_first_step(simulation, 900, [&](const StepResult& step) {
    EXPECT_TRUE(step.converged);
    halved += step.halvings;
  });
  EXPECT_GT(halved, 0) << "the fingers have hit the block";
}

TEST_F(Allocation, NoneInHalvedOrFailedSteps) {
  SceneBuilder b;
  b.body("rotor", 1, {0.1, 0, 0}, Matrix3::Identity());
  b.joint("shaft", scene::JointKind::Continuous, "world", "rotor", {0, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"shaft", 0, 10, {}});
  b.scene.integrator.step = 0.1;
  b.scene.integrator.max_halvings = 5;
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.step().converged);
  simulation.command_effort(0, 2000);
  int halvings = 0;
  bool failed = false;
  EXPECT_EQ(allocations_in([&] {
              for (int n = 0; n < 30; ++n) {
                const StepResult result = simulation.step();
                halvings += result.halvings;
                failed = failed || !result.converged;
              }
            }),
            0);
  EXPECT_GT(halvings, 0);
  EXPECT_TRUE(failed);
}

// A thread takes a snapshot after each step, to hand it to another thread.
TEST_F(Allocation, NoneInSnapshotsThatAreTakenAgain) {
  Simulation simulation(driven_scene().scene);
  Snapshot first, second;
  ASSERT_TRUE(simulation.step().converged);
  simulation.snapshot(first);
  simulation.snapshot(second);
  EXPECT_EQ(allocations_in([&] {
              for (int n = 0; n < 100; ++n) {
                simulation.step();
                simulation.snapshot(n % 2 == 0 ? first : second);
              }
            }),
            0);
}

// Services may apply wrenches from other threads. Their begin and end are handled between steps.
TEST_F(Allocation, NoneWhereWrenchesBeginAndEnd) {
  Simulation simulation(everything_scene().scene);
  const std::size_t link = link_of(simulation, "beam2");
  std::vector<AppliedWrench> none, one(1), many(16);
  for (std::vector<AppliedWrench>* wrenches : {&one, &many})
    for (AppliedWrench& wrench : *wrenches) wrench = {link, {0.01, 0, 0}, {{0, 0, 1e-3}, {0, 0, 0}}, false};
  Snapshot snapshot;
  ASSERT_TRUE(simulation.step().converged);
  simulation.snapshot(snapshot);
  EXPECT_EQ(allocations_in([&] {
              for (int n = 0; n < 60; ++n) {
                simulation.apply_wrenches(n % 3 == 0 ? one : n % 3 == 1 ? many : none);
                simulation.step();
                simulation.snapshot(snapshot);
              }
            }),
            0);
}

// What a motion carries is struck where its rate jumps.
TEST_F(Allocation, NoneAtKinksOfMotions) {
  SceneBuilder b;
  b.body("cart", 1, {0, 0, 0}, Matrix3::Identity());
  b.body("block", 1, {0, 0, 0}, Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "cart");
  b.joint("bed", scene::JointKind::Prismatic, "cart", "block");
  b.scene.motions.push_back({"rail", TimeFunction::parse("0:0 0.1:0 0.2:0.06 0.3:0 0.4:0.1"), {}});
  Simulation simulation(b.scene);
  expect_none_where_all_converge(simulation, 350);
  EXPECT_GT(simulation.energies().work, 0.4);
}

TEST_F(Allocation, NoneInSensitivitiesOfTheStart) {
  SceneBuilder b;
  b.beam("upper", {{1, 0, 0}}, section(2e4, 1e4, 20, 25, 0.5, 2e-3, 1e-3), 2, 2);
  b.body("lower", 0.3, {0.1, 0, 0}, 1e-3 * Matrix3::Identity());
  b.joint("shoulder", scene::JointKind::Continuous, "world", "upper").damping = 0.1;
  b.joint("ball", scene::JointKind::Spherical, "upper", "lower", {1, 0, 0});
  b.sensor("gauge", scene::SensorKind::Strain, "upper", {0.1, 0.01, 0});
  for (const std::string scheme : {"em", "em4", "newmark"}) {
    Simulation simulation(b.scene, options(scheme));
    SensitivityRequest request;
    request.initial_state = true;
    Sensitivities sensitivities(simulation, request);
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(sensitivities.step().converged);
    EXPECT_EQ(allocations_in([&] {
                for (int n = 0; n < 20; ++n) sensitivities.step();
              }),
              0)
        << scheme;
    EXPECT_EQ(sensitivities.lost(), "");
  }
}

// Reads all that the node reads in every cycle.
TEST_F(Allocation, NoneInObservables) {
  Simulation simulation(everything_scene().scene);
  ASSERT_TRUE(simulation.step().converged);
  double sum = 0;
  EXPECT_EQ(allocations_in([&] {
              for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i)
                sum += simulation.position(i) + simulation.velocity(i) + simulation.effort(i);
              for (std::size_t i = 0; i < simulation.link_names().size(); ++i)
                sum += simulation.link_pose(i).position.norm() + simulation.tip_pose(i).position.norm();
              sum +=
                  simulation.energies().total() + simulation.momentum().norm() + simulation.angular_momentum().norm();
              sum += simulation.probe(0).velocity.norm();
            }),
            0);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace flexarm::test
