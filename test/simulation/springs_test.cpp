// Tests springs between points of two links.

#include "building/expect_model_error.h"
#include "flexarm/scene/point_spring.h"
#include "math/pi.h"
#include "support/runs.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

constexpr double kStiffness = 300;

void add_spring(SceneBuilder& b, const std::string& from, const Vector3& from_at, const std::string& to,
                const Vector3& to_at, std::optional<double> rest_length = {}, double damping = 0,
                const std::string& name = "") {
  auto spring = std::make_shared<scene::PointSpring>();
  spring->name = name;
  spring->from = from;
  spring->from_at = from_at;
  spring->to = to;
  spring->to_at = to_at;
  spring->stiffness = kStiffness;
  spring->rest_length = rest_length;
  spring->damping = damping;
  b.scene.force_elements.push_back(spring);
}

/// Two carts on rails, connected by a spring.
SceneBuilder carts(double damping) {
  SceneBuilder b;
  for (const auto& [name, mass, place] : {std::tuple("left", 2.0, 0.0), std::tuple("right", 3.0, 1.0)}) {
    b.body(name, mass, Vector3::Zero(), Matrix3::Identity());
    b.joint(std::string(name) + "_rail", scene::JointKind::Prismatic, "world", name, {place, 0, 0}, {1, 0, 0});
  }
  add_spring(b, "left", Vector3::Zero(), "right", Vector3::Zero(), {}, damping);
  return b;
}

// Two masses: omega^2 = k / m, 2 zeta omega = c / m, with the reduced mass m.
TEST(PointSprings, SwingAtTheirFrequency) {
  const double reduced = 2.0 * 3.0 / 5.0, damping = 4;
  const Simulation simulation(carts(damping).scene);
  const double omega = std::sqrt(kStiffness / reduced), ratio = damping / (2 * reduced * omega);
  bool found = false;
  for (const Mode& mode : simulation.natural_modes(4)) {
    if (mode.is_free()) continue;
    found = true;
    EXPECT_NEAR(mode.frequency, omega * std::sqrt(1 - ratio * ratio) / (2 * kPi), 1e-8 * omega);
    EXPECT_NEAR(mode.damping_ratio(), ratio, 1e-8);
  }
  EXPECT_TRUE(found);
}

// A mass hangs on a spring in equilibrium, which stretches the spring by m g / k.
TEST(PointSprings, CarryAWeight) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -10};
  b.body("mass", 1.5, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "mass", Vector3::Zero(), {0, 0, 1});
  add_spring(b, "world", {0, 0, 2}, "mass", {0, 0, 0.5}, 1.0);
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  // 1.5 - z = 1 + m g / k
  EXPECT_NEAR(simulation.position(0), 0.5 - 15 / kStiffness, 1e-9);
  EXPECT_NEAR(simulation.energies().strain, 0.5 * 15 * 15 / kStiffness, 1e-9);
}

// A spring with a name has columns for its length and its tension, here the weight. A spring without a name has none.
TEST(PointSprings, PutOutLengthAndTension) {
  SceneBuilder b;
  b.scene.gravity = {0, 0, -10};
  b.body("mass", 1.5, Vector3::Zero(), Matrix3::Identity());
  b.joint("rail", scene::JointKind::Prismatic, "world", "mass", Vector3::Zero(), {0, 0, 1});
  add_spring(b, "world", {0, 0, 2}, "mass", {0, 0, 0.5}, 1.0);
  const std::vector<std::string> patterns = {"spring/*"};
  EXPECT_THROW(ResultColumns(Simulation(b.scene), ResultColumns::Solver::Without, patterns), std::invalid_argument);
  add_spring(b, "world", {0, 0, 2}, "mass", {0, 0, 0.5}, 1.0, 0, "hanger");
  b.scene.force_elements.erase(b.scene.force_elements.begin());
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  ResultColumns columns(simulation, ResultColumns::Solver::Without, patterns);
  ASSERT_EQ(columns.columns().size(), 3u);
  EXPECT_EQ(columns.columns()[1].name, "spring/hanger/length");
  EXPECT_EQ(columns.columns()[2].name, "spring/hanger/tension");
  EXPECT_NEAR(columns.row(simulation, {})[1], 1 + 15 / kStiffness, 1e-9);
  EXPECT_NEAR(columns.row(simulation, {})[2], 15, 1e-9 * kStiffness);
}

/// A flexible arm and a flying body, tied to each other and to the world by springs.
SceneBuilder tied() {
  SceneBuilder b;
  b.beam("arm", {{0.6, 0, 0}, {0.9, 0.2, 0.1}}, section(2e4, 1e4, 200, 250, 0.5, 0.02, 0.01), 3, 2);
  b.joint("hinge", scene::JointKind::Spherical, "world", "arm", {0.3, -0.2, 0.5});
  b.body("ball", 0.7, {0.05, 0.02, 0}, Vector3(0.01, 0.02, 0.015).asDiagonal());
  b.joint("flight", scene::JointKind::Floating, "world", "ball", {1.5, 0.5, 0.5});
  b.scene.initial_joints = {
      {"hinge/rx", 0, 2, {}}, {"hinge/rz", 0, -3, {}}, {"flight/x", 0, 1.5, {}}, {"flight/ry", 0, 4, {}}};
  add_spring(b, "arm", {0.9, 0.2, 0.1}, "ball", {0.1, 0, 0.05}, 0.4, 0.3);
  b.scene.integrator.step = 2e-3;
  b.scene.integrator.tolerance = 1e-11;
  return b;
}

TEST(PointSprings, KeepTheEnergyAccount) {
  for (const char* scheme : {"em", "em_symmetric", "edmc2", "std"}) {
    SceneBuilder b = tied();
    b.scene.integrator.scheme = scheme;
    add_spring(b, "ball", {0, -0.1, 0}, "world", {1, 1, 1}, {}, 0.2);
    Simulation simulation(b.scene);
    const double begin = energy_account(simulation);
    run(simulation, 500, [&] { ASSERT_NEAR(energy_account(simulation), begin, 1e-9 * begin) << scheme; });
    EXPECT_GT(simulation.energies().dissipated, 1e-3);
  }
}

// Arm and body fly freely: internal forces do not change the momenta.
TEST(PointSprings, KeepMomenta) {
  SceneBuilder b = tied();
  b.scene.joints[0].kind = scene::JointKind::Floating;
  b.scene.joints[0].origin.position = {0.3, -0.2, 0.5};
  Simulation simulation(b.scene);
  const Vector3 momentum = simulation.momentum(), spin = simulation.angular_momentum();
  run(simulation, 300);
  EXPECT_LE((simulation.momentum() - momentum).norm(), 1e-9 * momentum.norm());
  EXPECT_LE((simulation.angular_momentum() - spin).norm(), 1e-9 * spin.norm());
}

// The tangent is exact with the tree and with the matrix, so Newton's method converges quadratically.
TEST(PointSprings, AreSolvedInFewIterations) {
  for (const char* scheme : {"em0", "newmark", "m1"}) {
    SceneBuilder b = tied();
    b.scene.integrator.scheme = scheme;
    Simulation simulation(b.scene, full_newton());
    int iterations = 0;
    for (int n = 0; n < 100; ++n) {
      const StepResult result = simulation.step();
      ASSERT_TRUE(result.converged) << scheme;
      iterations += result.iterations;
    }
    EXPECT_LE(iterations, 500) << scheme;
  }
}

TEST(PointSprings, AreRefusedWhereTheyDoNothing) {
  SceneBuilder b = carts(0);
  add_spring(b, "left", Vector3::Zero(), "left", Vector3::UnitX());
  expect_error(b.scene, "both ends belong to the same rigid body");
  b = carts(0);
  b.scene.integrator.scheme = "hht1";
  EXPECT_THROW(Simulation(b.scene), ModelError);
}

}  // namespace
}  // namespace flexarm::test
