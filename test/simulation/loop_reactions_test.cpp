// Tests the reactions of joints that close loops: with them, forces and moments on each body balance.
#include <gtest/gtest.h>

#include <array>

#include "simulation/inside.h"
#include "support/loops.h"

namespace flexarm::test {
namespace {

constexpr double kStep = 1e-3;
constexpr double kBalanced =
    1e-10;  // relative to the largest force: tolerance of Newton's method, and round-off of momenta over a step
const Vector3 kGravity(0, 0, -9.81);

enum Body { kCrank, kCoupler, kRocker, kBodies };
constexpr std::array<const char*, kBodies> kNames = {"crank", "coupler", "rocker"};
constexpr double kCrankMass = 0.4, kRockerMass = 0.6;

/// The method that closes the loop, and the end of the loop joint at which it acts.
enum class Closed { ByMultipliers, AtTheChildsEnd, AtTheParentsEnd };

SceneBuilder four_bar(Closed closed) {
  SceneBuilder b;
  b.scene.gravity = kGravity;
  b.body("crank", kCrankMass, {0, 0, 0.1}, 1e-3 * Matrix3::Identity());
  b.joint("crank", scene::JointKind::Revolute, "world", "crank", {0, 0, 0}, {0, 1, 0});
  if (closed == Closed::ByMultipliers)
    b.body("coupler", 0.5, {0.25, 0.02, 0.1}, 4e-3 * Matrix3::Identity());
  else
    b.beam("coupler", {{0.6, 0, 0.2}}, section(2e5, 1e5, 30, 40, 0.8, 2e-4, 1e-4), 2, 2);
  b.joint("knee", scene::JointKind::Revolute, "crank", "coupler", {0, 0, 0.2}, {0, 1, 0});
  b.body("rocker", kRockerMass, {0, 0.03, 0.2}, 5e-3 * Matrix3::Identity());
  b.joint("foot", scene::JointKind::Revolute, "world", "rocker", {0.6, 0, 0}, {0, 1, 0});
  const bool is_turned = closed == Closed::AtTheParentsEnd;
  scene::JointDescription& hip =
      close_loop(b, "hip", scene::JointKind::Revolute, "rocker", "coupler", {0.6, 0, 0.2}, {0, 1, 0});
  if (is_turned) {
    std::swap(hip.parent, hip.child);
    std::swap(hip.origin.position, hip.child_origin.position);
  }
  for (const char* name : kNames) b.sensor(name, scene::SensorKind::Reaction, name);
  for (const Body body : {kCoupler, kRocker}) {
    b.sensor(std::string("hip_on_") + kNames[body], scene::SensorKind::Reaction, kNames[body]);
    b.scene.sensors.back().joint = "hip";
  }
  b.scene.integrator.tolerance = 1e-12;
  b.scene.integrator.step = kStep;
  return b;
}

/// Kinematics and momenta of all bodies at an instant, about the world's origin.
struct Instant {
  std::array<Vector3, kBodies> origin, center, momentum, spin;
  std::array<double, kBodies> mass;
};

/// Sets the values of a rigid body, whose whole mass is at one node.
void set_rigid(const Simulation& simulation, Body body, double mass, Instant& instant) {
  const Model& model = model_of(simulation);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const NodalInertia& inertia = model.inertias[i];
    if (inertia.total_mass != mass) continue;
    const NodeState& node = state_of(simulation).nodes[i];
    instant.mass[body] = mass;
    instant.center[body] = node.position;
    instant.momentum[body] = mass * node.velocity;
    instant.spin[body] = node.position.cross(instant.momentum[body]) +
                         node.orientation * Vector3(inertia.rotary * node.angular_velocity);
  }
}

Instant instant_of(const Simulation& simulation) {
  Instant out;
  set_rigid(simulation, kCrank, kCrankMass, out);
  set_rigid(simulation, kRocker, kRockerMass, out);
  // All remaining mass belongs to the coupler, rigid or flexible.
  double mass = 0;
  Vector3 moment = Vector3::Zero();
  for (std::size_t i = 0; i < model_of(simulation).nodes.size(); ++i) {
    mass += model_of(simulation).inertias[i].total_mass;
    moment += model_of(simulation).inertias[i].total_mass * state_of(simulation).nodes[i].position;
  }
  out.mass[kCoupler] = mass - kCrankMass - kRockerMass;
  out.center[kCoupler] =
      (moment - kCrankMass * out.center[kCrank] - kRockerMass * out.center[kRocker]) / out.mass[kCoupler];
  out.momentum[kCoupler] = simulation.momentum() - out.momentum[kCrank] - out.momentum[kRocker];
  out.spin[kCoupler] = simulation.angular_momentum() - out.spin[kCrank] - out.spin[kRocker];
  for (int body = 0; body < kBodies; ++body) out.origin[body] = simulation.link_pose(body + 1).position;
  return out;
}

/// {force, moment about the world's origin} on `body` in the last step, from the sensor with index `sensor`.
Vector6 reaction(const Simulation& simulation, std::size_t sensor, Body body, const Instant& begin,
                 const Instant& end) {
  const auto first = 6 * static_cast<std::size_t>(model_of(simulation).sensors[sensor].reaction);
  Vector6 wrench = Eigen::Map<const Vector6>(state_of(simulation).transmitted.means[0].data() + first);
  wrench.tail<3>() += (0.5 * (begin.origin[body] + end.origin[body])).cross(wrench.head<3>());
  return wrench;
}

/// Largest imbalance on a body: sum of forces and moments less the rates of momenta, relative to the largest force and
/// moment.
double imbalance(const Simulation& simulation, const Instant& begin, const Instant& end) {
  const auto transmitted = [&](std::size_t sensor, Body body) {
    return reaction(simulation, sensor, body, begin, end);
  };
  const Vector6 crank = transmitted(0, kCrank), coupler = transmitted(1, kCoupler), rocker = transmitted(2, kRocker),
                hip_on_coupler = transmitted(3, kCoupler), hip_on_rocker = transmitted(4, kRocker);
  std::array<Vector6, kBodies> sum = {crank - coupler, coupler + hip_on_coupler, rocker + hip_on_rocker};
  double worst = (hip_on_coupler + hip_on_rocker).norm(), scale = 0;
  for (const Vector6& wrench : {crank, coupler, rocker, hip_on_coupler}) scale = std::max(scale, wrench.norm());
  for (int body = 0; body < kBodies; ++body) {
    const Vector3 weight = end.mass[body] * kGravity;
    sum[body].head<3>() += weight - (end.momentum[body] - begin.momentum[body]) / kStep;
    sum[body].tail<3>() +=
        (0.5 * (begin.center[body] + end.center[body])).cross(weight) - (end.spin[body] - begin.spin[body]) / kStep;
    worst = std::max(worst, sum[body].norm());
  }
  return worst / scale;
}

class LoopReactions : public ::testing::TestWithParam<std::tuple<Closed, const char*>> {};

TEST_P(LoopReactions, BalanceEachBodyAsItMoves) {
  SceneBuilder b = four_bar(std::get<0>(GetParam()));
  b.scene.integrator.scheme = std::get<1>(GetParam());
  b.scene.initial_joints.push_back({"crank", 0, 6, {}});
  Simulation simulation(b.scene);
  Instant begin = instant_of(simulation);
  for (int n = 0; n < 200; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const Instant end = instant_of(simulation);
    ASSERT_LE(imbalance(simulation, begin, end), kBalanced) << "step " << n;
    begin = end;
  }
}

TEST_P(LoopReactions, BalanceEachBodyAtRest) {
  SceneBuilder b = four_bar(std::get<0>(GetParam()));
  b.scene.motions.push_back({"crank", TimeFunction::parse("0"), {}});  // a motor holds the crank
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.solve_static(1).converged);
  const Instant rest = instant_of(simulation);
  EXPECT_LE(imbalance(simulation, rest, rest), kBalanced);
  // The sensor's samples are the same values, about the links' origins.
  const Vector6 hip = Eigen::Map<const Vector6>(state_of(simulation).transmitted.means[0].data() +
                                                6 * model_of(simulation).sensors[3].reaction);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(simulation.sample(3).values[i], hip[i]);
}

INSTANTIATE_TEST_SUITE_P(All, LoopReactions,
                         ::testing::Combine(::testing::Values(Closed::ByMultipliers, Closed::AtTheChildsEnd,
                                                              Closed::AtTheParentsEnd),
                                            ::testing::Values("em", "edmc2", "m1")));

TEST(LoopReactions, AreThereForLinksOfTheLoopJoint) {
  SceneBuilder b = four_bar(Closed::ByMultipliers);
  b.scene.sensors.back().joint = "knee";
  EXPECT_THROW(Simulation simulation(b.scene), ModelError);
}

}  // namespace
}  // namespace flexarm::test
